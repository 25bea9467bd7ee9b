// SPDX-License-Identifier: MIT
/// Global closest-point search over many small elements (segments, points): a static bounding volume hierarchy with a few elements per
/// leaf. A search may take several ticks: each call visits a bounded number of nodes, keeps its stack in SearchState, and the next call
/// resumes with its own probe. The search compares |x - q|^2, or, for a probe x further than 16 half extents R from the center c of the
/// root box, |x - q|^2 - |x - c|^2; both divided by R^2, so that nothing overflows and a far probe finds the point furthest in its
/// direction.
/// Built off the tick; `search` runs on the haptic thread: no allocation, lock, or throw. Same state and probe give the same bits.
#pragma once
#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <limits>
#include <vector>

#include "haptics/chain/constraint.h"

namespace catena::haptics {

/// Progress of a search, kept between ticks. Plain data; zero bytes are the state before the first search.
struct SearchState {
  std::array<std::uint32_t, 40> stack;  ///< nodes still to be visited
  Vec3 probe;                           ///< probe of the last call
  std::int32_t depth;                   ///< number of nodes on the stack
  std::int32_t visits;                  ///< nodes visited by the last call, its work
  std::uint32_t best_item;              ///< index of the closest element found so far, if has_best
  bool has_best;                        ///< best_item is valid
  bool in_progress;                     ///< the search has not finished
  bool for_one_probe;                   ///< the whole search ran with one and the same probe
};

/// Search key of a point q: increases with the distance from the probe to q.
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

/// The hierarchy. V: type of the box corners, Vec3 or glm::vec3.
template <class V>
class ClosestPointBvh {
 public:
  /// Axis-aligned box; empty by default.
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
  /// Builds the tree over the leaf boxes: at least one leaf, none empty, all finite, with an extent whose reciprocal is finite.
  explicit ClosestPointBvh(const std::vector<Box>& leaves) {
    // padded to a power of two, then filled bottom-up
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

  /// Resumes the search in progress or begins one, starting from the best element known. For a probe at rest one complete search is made,
  /// then none. Visits at most `max_visits` nodes; the first search sees at least one leaf. Afterwards state.best_item is the closest
  /// element seen, and state.in_progress tells whether nodes are left.
  ///   closest_point(k)            returns the closest point of element k to the probe
  ///   for_each_in(leaf, visit)    calls visit(k) for every element k of a leaf
  template <class ClosestPointOf, class ForEachIn>
  void search(const Vec3& probe, int max_visits, SearchState& state, ClosestPointOf&& closest_point,
              ForEachIn&& for_each_in) const noexcept {
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
    double best_key = state.has_best ? key(closest_point(state.best_item)) : std::numeric_limits<double>::infinity();
    while (state.depth > 0 && state.visits < max_visits) {
      ++state.visits;
      const std::uint32_t node = state.stack[static_cast<std::size_t>(--state.depth)];
      if (!(of_box(node) < best_key)) continue;
      if (node >= first_leaf_) {
        for_each_in(node - first_leaf_, [&](std::uint32_t k) {
          const double candidate_key = key(closest_point(k));
          if (!(candidate_key < best_key)) return;
          best_key = candidate_key;
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

  /// Validates a state from a file (see Constraint::is_sane), except best_item: the k-th node on a search's stack is at depth k of the tree
  /// or deeper, so that the stack never exceeds the tree's height.
  bool is_sane(const SearchState& state) const noexcept {
    if (!are_valid_bools(state.has_best, state.in_progress, state.for_one_probe)) return false;
    if (state.depth < 0 || state.depth > static_cast<std::int32_t>(state.stack.size())) return false;
    for (std::uint32_t k = 0; k < static_cast<std::uint32_t>(state.depth); ++k) {
      const std::uint32_t node = state.stack[k];
      if (node >= nodes_.size() || static_cast<std::uint32_t>(std::bit_width(node + 1)) < k + 1) return false;
    }
    return true;
  }

  double extent() const noexcept { return 2 * radius_; }  ///< longest edge of the root box
  std::size_t bytes() const noexcept { return nodes_.size() * sizeof(Box); }

 private:
  std::vector<Box> nodes_;      // a heap: the children of i are 2 i + 1 and 2 i + 2
  std::size_t first_leaf_ = 0;  // index of the first leaf in nodes_
  Vec3 center_{0.0};
  double radius_ = 0;  // half the longest edge
};

}  // namespace catena::haptics
