/// The closest place of a long polyline, anywhere on it: closest_search.h over runs of eight consecutive pieces.
#pragma once
#include <vector>

#include "haptics/constraints/rules/closest_search.h"
#include "haptics/constraints/shapes/closed_form.h"

namespace catena::haptics {

class PolylineSearch : public ClosestSearch<Vec3> {
 public:
  PolylineSearch() = default;
  /// Of at least one piece, all finite, with an extent whose inverse is finite.
  explicit PolylineSearch(const std::vector<Straight>& pieces);
  void search(const std::vector<Straight>& pieces, const Vec3& probe, int most_visits, SearchState& state) const noexcept;
};

}  // namespace catena::haptics
