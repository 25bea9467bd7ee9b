// SPDX-License-Identifier: MIT
#include "engine/field/measure/profile.h"

#include <cmath>
#include <numbers>

#include "engine/base/result.h"

namespace catena::field {

PointValue sample_point(const AnyField& field, const Vec3& world, Cursor& cursor) {
  PointValue point{0, world, {}};
  if (field.scalar) {
    const ScalarSample sample = field.scalar->sample(world, cursor);
    if (sample.inside && std::isfinite(sample.value)) point.value = Vec3(sample.value, 0, 0);
  } else if (field.vector) {
    const VectorSample sample = field.vector->sample(world, cursor);
    if (sample.inside && is_finite(sample.value)) point.value = sample.value;
  }
  return point;
}

std::vector<PointValue> sample_line(const AnyField& field, const Vec3& a, const Vec3& b, std::size_t samples) {
  CATENA_ASSERT(samples >= 2);
  std::vector<PointValue> points;
  points.reserve(samples);
  Cursor cursor;
  const double length = norm(b - a);
  for (std::size_t n = 0; n < samples; ++n) {
    const double t = static_cast<double>(n) / static_cast<double>(samples - 1);
    points.push_back(sample_point(field, n + 1 == samples ? b : a + (b - a) * t, cursor));
    points.back().length = length * t;
  }
  return points;
}

std::optional<double> angle_deg(const Vec3& a, const Vec3& b, const Vec3& c) {
  const Vec3 u = direction(a - b), v = direction(c - b);
  if (u == Vec3(0.0) || v == Vec3(0.0)) return std::nullopt;
  return std::atan2(norm(cross(u, v)), dot(u, v)) * (180 / std::numbers::pi);
}

}  // namespace catena::field
