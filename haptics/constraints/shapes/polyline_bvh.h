/// The closest place of a long polyline, anywhere on it: closest_search.h over runs of eight consecutive pieces.
#pragma once
#include <vector>

#include "haptics/constraints/common/closest_point_bvh.h"
#include "haptics/constraints/shapes/closed_form.h"

namespace catena::haptics {

class PolylineBvh : public ClosestPointBvh<Vec3> {
 public:
  PolylineBvh() = default;
  /// Of at least one piece, all finite, with an extent whose inverse is finite.
  explicit PolylineBvh(const std::vector<LineSegment>& pieces);
  void search(const std::vector<LineSegment>& pieces, const Vec3& probe, int most_visits, SearchState& state) const noexcept;
};

}  // namespace catena::haptics
