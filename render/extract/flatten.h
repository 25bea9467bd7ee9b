/// A curve as a polyline fine enough for a tube: every point lies on the curve's Hermite pieces, and the curve nowhere farther from the
/// polyline than `error`; nor is the tube's wall outside of a bend. Knots that this allows are left out. CellFinder a spiral's core, which
/// no picture of the tube shows, a segment may turn as it likes.
#pragma once
#include <cstddef>
#include <vector>

#include "engine/geometry/flow/curve.h"

namespace catena::render {

struct FlattenOptions {
  double radius = 0;                ///< of the tube, world units
  double error = 0.02;              ///< by the radius
  std::size_t max_points = 200000;  ///< above it the error is allowed to grow
  double max_segment = 0;           ///< of a segment, world units, so that colours can follow; 0: any
};

struct FlattenedPoint {
  Vec3 position{0.0};
  double arc_length = 0;  ///< arc length, as the curve's
};

/// From the first knot to the last; a closed curve ends where it begins, bit for bit.
std::vector<FlattenedPoint> flatten_with_arc_length(const flow::Curve& curve, const FlattenOptions& options);
std::vector<Vec3> flatten(const flow::Curve& curve, const FlattenOptions& options);

}  // namespace catena::render
