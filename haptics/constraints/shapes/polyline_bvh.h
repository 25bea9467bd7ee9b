// SPDX-License-Identifier: MIT
/// Global closest point of a long polyline: a closest_point_bvh.h over runs of eight consecutive segments.
#pragma once
#include <vector>

#include "haptics/constraints/common/closest_point_bvh.h"
#include "haptics/constraints/shapes/closed_form.h"

namespace catena::haptics {

/// The BVH of one polyline; it does not keep the segments.
class PolylineBvh : public ClosestPointBvh<Vec3> {
 public:
  PolylineBvh() = default;
  /// Builds it over at least one segment, all finite, with an extent whose reciprocal is finite. Off the tick.
  explicit PolylineBvh(const std::vector<LineSegment>& pieces);
  /// Runs ClosestPointBvh::search with the same `pieces`; visits at most `max_visits` nodes. Haptic thread.
  void search(const std::vector<LineSegment>& pieces, const Vec3& probe, int max_visits, SearchState& state) const noexcept;
};

}  // namespace catena::haptics
