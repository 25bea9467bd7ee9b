#include "haptics/constraints/shapes/polyline_search.h"

namespace catena::haptics {
namespace {

constexpr std::size_t kLeaf = 8;  // pieces

std::vector<ClosestSearch<Vec3>::Box> boxes_of(const std::vector<Straight>& pieces) {
  std::vector<ClosestSearch<Vec3>::Box> leaves((pieces.size() + kLeaf - 1) / kLeaf);
  for (std::size_t k = 0; k < pieces.size(); ++k)
    for (const Vec3& p : {pieces[k].a, pieces[k].b}) leaves[k / kLeaf].add(p, p);
  return leaves;
}

}  // namespace

PolylineSearch::PolylineSearch(const std::vector<Straight>& pieces) : ClosestSearch(boxes_of(pieces)) {}

void PolylineSearch::search(const std::vector<Straight>& pieces, const Vec3& probe, int most_visits, SearchState& state) const noexcept {
  ClosestSearch::search(
      probe, most_visits, state, [&](std::uint32_t k) { return pieces[k].at(pieces[k].along(probe)); },
      [&](std::size_t leaf, const auto& see) {
        const std::size_t last = std::min((leaf + 1) * kLeaf, pieces.size());
        for (std::size_t k = leaf * kLeaf; k < last; ++k) see(static_cast<std::uint32_t>(k));
      });
}

}  // namespace catena::haptics
