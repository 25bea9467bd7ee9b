#include "haptics/constraints/shapes/polyline_search.h"

#include <bit>
#include <limits>

#include "haptics/chain/constraint.h"

namespace catena::haptics {
namespace {

constexpr std::size_t kLeaf = 8;  // pieces
constexpr double kFar = 16;       // half extents
constexpr double kInfinite = std::numeric_limits<double>::infinity();

/// What is compared: rises with the distance from the probe to q.
class HeapKey {
 public:
  HeapKey(const Vec3& probe, const Vec3& center, double radius) : probe_(probe), center_(center), scale_(1 / radius) {
    const Vec3 away = probe - center;
    const double m = max_abs(away);
    far_ = m > kFar * radius;
    if (!far_) return;
    part_ = radius / m;
    way_ = Vec3(away.x / m, away.y / m, away.z / m);
  }
  double operator()(const Vec3& q) const noexcept {
    if (far_) {
      const Vec3 u = (q - center_) * scale_;
      return part_ * dot(u, u) - 2 * dot(u, way_);
    }
    const Vec3 e = (probe_ - q) * scale_;
    return dot(e, e);
  }

 private:
  Vec3 probe_, center_, way_{0.0};
  double scale_, part_ = 0;
  bool far_ = false;
};

}  // namespace

PolylineSearch::PolylineSearch(const std::vector<Straight>& pieces) {
  const Box nothing{Vec3(kInfinite), Vec3(-kInfinite)};
  const auto grow = [](Box& box, const Vec3& lo, const Vec3& hi) {
    for (int i = 0; i < 3; ++i) {
      box.lo[i] = std::min(box.lo[i], lo[i]);
      box.hi[i] = std::max(box.hi[i], hi[i]);
    }
  };

  // leaves, padded to a power of two; then upwards
  std::size_t leaves = 1;
  while (leaves * kLeaf < pieces.size()) leaves *= 2;
  first_leaf_ = leaves - 1;
  nodes_.assign(2 * leaves - 1, nothing);
  for (std::size_t k = 0; k < pieces.size(); ++k)
    for (const Vec3& p : {pieces[k].a, pieces[k].b}) grow(nodes_[first_leaf_ + k / kLeaf], p, p);
  for (std::size_t i = first_leaf_; i-- > 0;)
    for (std::size_t child : {2 * i + 1, 2 * i + 2}) grow(nodes_[i], nodes_[child].lo, nodes_[child].hi);

  const Vec3 half = nodes_[0].hi * 0.5 - nodes_[0].lo * 0.5;
  center_ = nodes_[0].lo + half;
  radius_ = max_abs(half);
}

bool PolylineSearch::is_sane(const SearchState& state) const noexcept {
  if (!are_bools(state.any, state.open, state.whole)) return false;
  if (state.depth < 0 || state.depth > static_cast<std::int32_t>(state.stack.size())) return false;
  for (std::uint32_t k = 0; k < static_cast<std::uint32_t>(state.depth); ++k) {
    const std::uint32_t node = state.stack[k];
    if (node >= nodes_.size() || static_cast<std::uint32_t>(std::bit_width(node + 1)) < k + 1) return false;
  }
  return true;
}

void PolylineSearch::search(const std::vector<Straight>& pieces, const Vec3& probe, int most_visits, SearchState& state) const noexcept {
  const HeapKey key(probe, center_, radius_);
  const auto of_box = [&](std::uint32_t node) {
    const Box& box = nodes_[node];
    if (box.empty()) return kInfinite;
    return key(
        Vec3(std::clamp(probe.x, box.lo.x, box.hi.x), std::clamp(probe.y, box.lo.y, box.hi.y), std::clamp(probe.z, box.lo.z, box.hi.z)));
  };
  const auto of_piece = [&](std::size_t k) { return key(pieces[k].at(pieces[k].along(probe))); };

  const bool rests = state.any && same_bits(state.probe, probe);
  state.visits = 0;
  if (!state.open) {
    if (rests && state.whole && state.depth == 0) return;
    state.stack[0] = 0;
    state.depth = 1;
    state.whole = true;
  } else if (!rests) {
    state.whole = false;
  }
  state.probe = probe;
  double least = state.any ? of_piece(state.best) : kInfinite;
  while (state.depth > 0 && state.visits < most_visits) {
    ++state.visits;
    const std::uint32_t node = state.stack[static_cast<std::size_t>(--state.depth)];
    if (!(of_box(node) < least)) continue;
    if (node >= first_leaf_) {
      const std::size_t first = (node - first_leaf_) * kLeaf, last = std::min(first + kLeaf, pieces.size());
      for (std::size_t k = first; k < last; ++k) {
        const double here = of_piece(k);
        if (!(here < least)) continue;
        least = here;
        state.best = static_cast<std::uint32_t>(k);
        state.any = true;
      }
      continue;
    }
    // the nearer child on top
    const std::uint32_t left = 2 * node + 1, right = left + 1;
    const bool left_first = !(of_box(right) < of_box(left));
    state.stack[static_cast<std::size_t>(state.depth++)] = left_first ? right : left;
    state.stack[static_cast<std::size_t>(state.depth++)] = left_first ? left : right;
  }
  if (state.depth == 0 && rests && !state.whole) {
    state.stack[0] = 0;
    state.depth = 1;
    state.whole = true;
  }
  state.open = state.depth > 0;
}

}  // namespace catena::haptics
