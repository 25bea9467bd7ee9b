// SPDX-License-Identifier: MIT
/// Values of a field at points and along a line, distances and angles. Positions in world units. Not for the haptic tick; any thread.
#pragma once
#include <cstddef>
#include <optional>
#include <vector>

#include "engine/base/export.h"
#include "engine/field/field.h"

namespace catena::field {

/// Value of a field at a point, interpolated as the field prescribes.
struct PointValue {
  double length = 0;          ///< distance from the start of the line; 0 for a single point
  Vec3 position{0.0};         ///< world
  std::optional<Vec3> value;  ///< x: the value of a scalar field; empty outside of the field, or where it is masked or not finite
};

/// Samples a field at a point.
CATENA_EXPORT PointValue sample_point(const AnyField& field, const Vec3& world, Cursor& cursor);

/// Samples a field at `samples` >= 2 equidistant points from a to b, both included.
CATENA_EXPORT std::vector<PointValue> sample_line(const AnyField& field, const Vec3& a, const Vec3& b, std::size_t samples);

/// Angle at b between the directions to a and to c, degrees, 0 to 180; nullopt when a or c is at b.
CATENA_EXPORT std::optional<double> angle_deg(const Vec3& a, const Vec3& b, const Vec3& c);

}  // namespace catena::field
