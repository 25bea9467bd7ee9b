/// Where a plane cuts a box: a convex polygon of 3 to 6 corners, in order around the normal. World units. Any thread.
#pragma once
#include <vector>

#include "render/frame/camera.h"

namespace catena::render {

/// Two unit vectors across `normal` (unit), right-handed with it.
struct Across {
  Vec3 u, v;
};
Across across(const Vec3& normal);

/// Empty where they do not meet in an area. A face of the box that lies in the plane is its outline.
std::vector<Vec3> plane_outline(const Vec3& point, const Vec3& normal, const Bounds& box);

}  // namespace catena::render
