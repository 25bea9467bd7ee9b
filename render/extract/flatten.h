/// A curve as a polyline fine enough for a tube: every point lies exactly on the curve's Hermite pieces.
///   chord error of each segment <= 2 % of the tube's radius, turn of a segment <= 0.2 rad
#pragma once
#include <cstddef>
#include <vector>

#include "engine/flow/curve.h"

namespace catena::render {

struct FlattenOptions {
  double radius = 0;                 ///< of the tube, world units
  std::size_t most_points = 200000;  ///< above it the chord error is allowed to grow
  double longest = 0;                ///< of a segment, world units, so that colours can follow; 0: any
};

struct FlatPoint {
  Vec3 p{0.0};
  double s = 0;  ///< arc length, as the curve's
};

/// From the first knot to the last; a closed curve ends where it begins, bit for bit.
std::vector<FlatPoint> flatten_places(const flow::Curve& curve, const FlattenOptions& options);
std::vector<Vec3> flatten(const flow::Curve& curve, const FlattenOptions& options);

}  // namespace catena::render
