#include "render/extract/plane_outline.h"

#include <algorithm>
#include <cmath>

namespace catena::render {

Across across(const Vec3& normal) {
  const Vec3 axis = std::fabs(normal.x) < 0.6 ? Vec3(1.0, 0.0, 0.0) : Vec3(0.0, 1.0, 0.0);
  const Vec3 u = direction(cross(axis, normal));
  return {u, cross(normal, u)};
}

std::vector<Vec3> plane_outline(const Vec3& point, const Vec3& normal, const Bounds& box) {
  const Vec3 n = direction(normal);
  if (box.empty() || max_abs(n) == 0) return {};
  const double flat = 1e-9 * box.diagonal();  // a corner this near lies in the plane
  std::array<double, 8> height;
  std::vector<Vec3> corners;
  for (int i = 0; i < 8; ++i) {
    height[std::size_t(i)] = dot(box.corner(i) - point, n);
    if (std::fabs(height[std::size_t(i)]) <= flat) corners.push_back(box.corner(i));
  }
  for (int i = 0; i < 8; ++i)
    for (int axis = 1; axis < 8; axis *= 2) {
      if ((i & axis) != 0) continue;
      const double a = height[std::size_t(i)], b = height[std::size_t(i | axis)];
      if (std::fabs(a) <= flat || std::fabs(b) <= flat || (a > 0) == (b > 0)) continue;
      corners.push_back(box.corner(i) + (a / (a - b)) * (box.corner(i | axis) - box.corner(i)));
    }
  if (corners.size() < 3) return {};

  // in order around their middle
  Vec3 middle(0.0);
  for (const Vec3& p : corners) middle += p / double(corners.size());
  const auto [u, v] = across(n);
  const auto angle = [&](const Vec3& p) { return std::atan2(dot(p - middle, v), dot(p - middle, u)); };
  std::sort(corners.begin(), corners.end(), [&](const Vec3& a, const Vec3& b) { return angle(a) < angle(b); });
  return corners;
}

}  // namespace catena::render
