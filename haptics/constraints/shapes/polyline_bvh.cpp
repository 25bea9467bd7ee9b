// SPDX-License-Identifier: MIT
#include "haptics/constraints/shapes/polyline_bvh.h"

namespace catena::haptics {
namespace {

constexpr std::size_t kLeaf = 8;  // segments per leaf

std::vector<ClosestPointBvh<Vec3>::Box> boxes_of(const std::vector<LineSegment>& pieces) {
  std::vector<ClosestPointBvh<Vec3>::Box> leaves((pieces.size() + kLeaf - 1) / kLeaf);
  for (std::size_t k = 0; k < pieces.size(); ++k)
    for (const Vec3& p : {pieces[k].a, pieces[k].b}) leaves[k / kLeaf].add(p, p);
  return leaves;
}

}  // namespace

PolylineBvh::PolylineBvh(const std::vector<LineSegment>& pieces) : ClosestPointBvh(boxes_of(pieces)) {}

void PolylineBvh::search(const std::vector<LineSegment>& pieces, const Vec3& probe, int max_visits, SearchState& state) const noexcept {
  ClosestPointBvh::search(
      probe, max_visits, state, [&](std::uint32_t k) { return pieces[k].at(pieces[k].along(probe)); },
      [&](std::size_t leaf, const auto& see) {
        const std::size_t last = std::min((leaf + 1) * kLeaf, pieces.size());
        for (std::size_t k = leaf * kLeaf; k < last; ++k) see(static_cast<std::uint32_t>(k));
      });
}

}  // namespace catena::haptics
