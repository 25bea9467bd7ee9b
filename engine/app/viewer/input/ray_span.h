// SPDX-License-Identifier: MIT
/// The part of a ray that lies within half spaces and a field's domain. Lengths along a unit direction, world units. Pure, any thread.
#pragma once
#include <algorithm>
#include <limits>

#include "engine/base/plane.h"
#include "engine/field/field.h"
#include "render/frame/camera.h"

namespace catena::app {

inline constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// An interval of ray lengths.
struct RaySpan {
  double enter = 0, exit = kInfinity;
  bool is_empty() const { return !(enter < exit); }
};

/// Restricts the span to the half space that the clip plane keeps.
inline void clip_to_plane(RaySpan& span, const render::Ray& ray, const Plane& plane) {
  const double rate = dot(plane.normal, ray.direction), start = dot(plane.normal, ray.origin - plane.point);
  if (rate == 0) {
    if (start < 0) span.exit = -kInfinity;
  } else if (rate > 0) {
    span.enter = std::max(span.enter, -start / rate);
  } else {
    span.exit = std::min(span.exit, -start / rate);
  }
}

/// Returns the span within the index box of the field; empty if the ray misses it.
inline RaySpan domain_span(const field::Field& field, const render::Ray& ray) {
  const Vec3 o = field.mapping().index_from_world(ray.origin), d = field.mapping().index_from_world_linear * ray.direction;
  const field::Box& box = field.index_box();
  RaySpan span;
  for (int a = 0; a < 3; ++a) {
    if (d[a] == 0) {
      if (o[a] < box.lo[a] || o[a] > box.hi[a]) span.exit = -kInfinity;
      continue;
    }
    const double s = (box.lo[a] - o[a]) / d[a], t = (box.hi[a] - o[a]) / d[a];
    span.enter = std::max(span.enter, std::min(s, t));
    span.exit = std::min(span.exit, std::max(s, t));
  }
  return span;
}

}  // namespace catena::app
