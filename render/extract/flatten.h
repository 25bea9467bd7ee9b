// SPDX-License-Identifier: MIT
/// Flattening of a curve to a polyline fine enough for a tube: every point lies on the curve's Hermite segments; nowhere is the curve
/// farther from the polyline than `error`, nor the tube's wall on the outside of a bend. Knots that are not needed for this are left out.
/// Within the core of a spiral, which is invisible inside the tube, segments may turn by any angle.
#pragma once
#include <cstddef>
#include <vector>

#include "engine/geometry/flow/curve.h"

namespace catena::render {

/// Tolerances of the polyline.
struct FlattenOptions {
  double radius = 0;                ///< radius of the tube, world units
  double error = 0.02;              ///< tolerance, as a fraction of the radius
  std::size_t max_points = 200000;  ///< above this number of points the tolerance is increased
  double max_segment = 0;           ///< maximum segment length, world units, for interpolated colors; 0: unlimited
};

/// Vertex of the polyline.
struct FlattenedPoint {
  Vec3 position{0.0};
  double arc_length = 0;  ///< arc length on the curve
};

/// Returns the polyline from the first knot to the last; for a closed curve the last point equals the first exactly.
std::vector<FlattenedPoint> flatten_with_arc_length(const flow::Curve& curve, const FlattenOptions& options);
/// Returns the same polyline without arc lengths.
std::vector<Vec3> flatten(const flow::Curve& curve, const FlattenOptions& options);

}  // namespace catena::render
