/// The closest place of very many small things, anywhere: a static tree of boxes over leaves of a few things each.
/// A search may take several ticks: it visits at most so many nodes, keeps its stack in SearchState, and goes on with the
/// probe of then. Compared is  |x - q|^2,  or where the probe is far (16 half extents R from the centre c)  |x - q|^2 - |x - c|^2,
/// both over R^2, so that nothing overflows and far probes find the place most in their direction.
/// Built off the tick; `search` runs on the haptic thread: no allocation, lock, or throw. Same bits for the same state and probe.
#pragma once
#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <limits>
#include <vector>

#include "haptics/chain/constraint.h"

namespace catena::haptics {

/// Plain data; zero is the state before the first search.
struct SearchState {
  std::array<std::uint32_t, 40> stack;  ///< nodes still to visit
  Vec3 probe;                           ///< of the last call
  std::int32_t depth;
  std::int32_t visits;      ///< of the last call: its work
  std::uint32_t best_item;  ///< the thing of the closest place so far
  bool has_best;            ///< `best` means something
  bool in_progress;         ///< not through yet
  bool for_one_probe;       ///< all of it for one probe
};

/// What is compared: rises with the distance from the probe to q.
class DistanceKey {
 public:
  DistanceKey(const Vec3& probe, const Vec3& center, double radius) : probe_(probe), center_(center), scale_(1 / radius) {
    constexpr double far = 16;  // half extents
    const Vec3 away = probe - center;
    const double m = max_abs(away);
    far_ = m > far * radius;
    if (!far_) return;
    far_scale_ = radius / m;
    direction_ = Vec3(away.x / m, away.y / m, away.z / m);
  }
  double operator()(const Vec3& q) const noexcept {
    if (far_) {
      const Vec3 u = (q - center_) * scale_;
      return far_scale_ * dot(u, u) - 2 * dot(u, direction_);
    }
    const Vec3 e = (probe_ - q) * scale_;
    return dot(e, e);
  }

 private:
  Vec3 probe_, center_, direction_{0.0};
  double scale_, far_scale_ = 0;
  bool far_ = false;
};

/// V: what the corners of boxes are kept as, Vec3 or glm::vec3.
template <class V>
class ClosestPointBvh {
 public:
  struct Box {
    V lo{std::numeric_limits<typename V::value_type>::infinity()}, hi{-std::numeric_limits<typename V::value_type>::infinity()};
    bool empty() const { return !(lo.x <= hi.x); }
    void add(const V& low, const V& high) {
      for (int i = 0; i < 3; ++i) {
        lo[i] = std::min(lo[i], low[i]);
        hi[i] = std::max(hi[i], high[i]);
      }
    }
  };

  ClosestPointBvh() = default;
  /// At least one leaf, none of them empty, all finite, with an extent whose inverse is finite.
  explicit ClosestPointBvh(const std::vector<Box>& leaves) {
    // padded to a power of two; then upwards
    std::size_t count = 1;
    while (count < leaves.size()) count *= 2;
    first_leaf_ = count - 1;
    nodes_.resize(2 * count - 1);
    std::copy(leaves.begin(), leaves.end(), nodes_.begin() + static_cast<std::ptrdiff_t>(first_leaf_));
    for (std::size_t i = first_leaf_; i-- > 0;)
      for (std::size_t child : {2 * i + 1, 2 * i + 2}) nodes_[i].add(nodes_[child].lo, nodes_[child].hi);

    const Vec3 half = Vec3(nodes_[0].hi) * 0.5 - Vec3(nodes_[0].lo) * 0.5;
    center_ = Vec3(nodes_[0].lo) + half;
    radius_ = max_abs(half);
  }

  /// Goes on with an open search or begins one, from the best thing known. A probe that rests is searched for once, whole. Visits at most
  /// `most_visits` nodes; at least one leaf is seen by the first. Afterwards state.best is the closest thing seen, state.open tells whether
  /// any is left.
  ///   place(k)             the closest place of thing k
  ///   each(leaf, see)      calls see(k) for the things of a leaf
  template <class Place, class Each>
  void search(const Vec3& probe, int most_visits, SearchState& state, Place&& place, Each&& each) const noexcept {
    const DistanceKey key(probe, center_, radius_);
    const auto of_box = [&](std::uint32_t node) {
      const Box& box = nodes_[node];
      if (box.empty()) return std::numeric_limits<double>::infinity();
      const Vec3 lo(box.lo), hi(box.hi);
      return key(Vec3(std::clamp(probe.x, lo.x, hi.x), std::clamp(probe.y, lo.y, hi.y), std::clamp(probe.z, lo.z, hi.z)));
    };

    const bool rests = state.has_best && bitwise_equal(state.probe, probe);
    state.visits = 0;
    if (!state.in_progress) {
      if (rests && state.for_one_probe && state.depth == 0) return;
      state.stack[0] = 0;
      state.depth = 1;
      state.for_one_probe = true;
    } else if (!rests) {
      state.for_one_probe = false;
    }
    state.probe = probe;
    double least = state.has_best ? key(place(state.best_item)) : std::numeric_limits<double>::infinity();
    while (state.depth > 0 && state.visits < most_visits) {
      ++state.visits;
      const std::uint32_t node = state.stack[static_cast<std::size_t>(--state.depth)];
      if (!(of_box(node) < least)) continue;
      if (node >= first_leaf_) {
        each(node - first_leaf_, [&](std::uint32_t k) {
          const double here = key(place(k));
          if (!(here < least)) return;
          least = here;
          state.best_item = k;
          state.has_best = true;
        });
        continue;
      }
      // the nearer child on top
      const std::uint32_t left = 2 * node + 1, right = left + 1;
      const bool left_first = !(of_box(right) < of_box(left));
      state.stack[static_cast<std::size_t>(state.depth++)] = left_first ? right : left;
      state.stack[static_cast<std::size_t>(state.depth++)] = left_first ? left : right;
    }
    if (state.depth == 0 && rests && !state.for_one_probe) {
      state.stack[0] = 0;
      state.depth = 1;
      state.for_one_probe = true;
    }
    state.in_progress = state.depth > 0;
  }

  /// Of a state from a file (Constraint::is_valid_state), but for `best`: a search leaves its k-th node at depth k of the tree or below, so
  /// that its stack never outgrows the tree's height.
  bool is_sane(const SearchState& state) const noexcept {
    if (!are_valid_bools(state.has_best, state.in_progress, state.for_one_probe)) return false;
    if (state.depth < 0 || state.depth > static_cast<std::int32_t>(state.stack.size())) return false;
    for (std::uint32_t k = 0; k < static_cast<std::uint32_t>(state.depth); ++k) {
      const std::uint32_t node = state.stack[k];
      if (node >= nodes_.size() || static_cast<std::uint32_t>(std::bit_width(node + 1)) < k + 1) return false;
    }
    return true;
  }

  double extent() const noexcept { return 2 * radius_; }  ///< the longest edge of the box around all
  std::size_t bytes() const noexcept { return nodes_.size() * sizeof(Box); }

 private:
  std::vector<Box> nodes_;      // a heap: the children of i are 2 i + 1 and 2 i + 2
  std::size_t first_leaf_ = 0;  // index of the first leaf in nodes_
  Vec3 center_{0.0};
  double radius_ = 0;  // half the longest edge
};

}  // namespace catena::haptics
