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
};

/// From the first knot to the last; a closed curve ends where it begins, bit for bit.
std::vector<Vec3> flatten(const flow::Curve& curve, const FlattenOptions& options);

}  // namespace catena::render
