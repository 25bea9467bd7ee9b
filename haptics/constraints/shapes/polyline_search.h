/// The closest place of a long polyline, anywhere on it: a static tree of boxes over runs of eight consecutive pieces.
/// A search may take several ticks: it visits at most so many nodes, keeps its stack in SearchState, and goes on with the
/// probe of then. Compared is  |x - q|^2,  or where the probe is far (16 half extents R from the centre c)  |x - q|^2 - |x - c|^2,
/// both over R^2, so that nothing overflows and far probes find the point most in their direction.
/// Built off the tick; `search` runs on the haptic thread: no allocation, lock, or throw. Same bits for the same state and probe.
#pragma once
#include <array>
#include <cstdint>
#include <vector>

#include "haptics/constraints/shapes/closed_form.h"

namespace catena::haptics {

/// Plain data; zero is the state before the first search.
struct SearchState {
  std::array<std::uint32_t, 40> stack;  ///< nodes still to visit
  Vec3 probe;                           ///< of the last call
  std::int32_t depth;
  std::int32_t visits;  ///< of the last call: its work
  std::uint32_t best;   ///< the piece of the closest place so far
  bool any;             ///< `best` means something
  bool open;            ///< not through yet
  bool whole;           ///< all of it for one probe
};

class PolylineSearch {
 public:
  PolylineSearch() = default;
  /// Of at least one piece, all finite, with an extent whose inverse is finite.
  explicit PolylineSearch(const std::vector<Straight>& pieces);

  /// Goes on with an open search or begins one, from the best piece known. A probe that rests is searched for once, whole. Visits at most
  /// `most_visits` nodes; at least one leaf is seen by the first. Afterwards state.best is the closest piece seen, state.open tells whether
  /// any is left.
  void search(const std::vector<Straight>& pieces, const Vec3& probe, int most_visits, SearchState& state) const noexcept;

  /// Of a state from a file (Constraint::is_sane), but for `best`: a search leaves its k-th node at depth k of the tree or below, so
  /// that its stack never outgrows the tree's height.
  bool is_sane(const SearchState& state) const noexcept;

  double extent() const noexcept { return 2 * radius_; }  ///< the longest edge of the box around all

 private:
  struct Box {
    Vec3 lo, hi;
    bool empty() const { return !(lo.x <= hi.x); }
  };
  std::vector<Box> nodes_;      // a heap: the children of i are 2 i + 1 and 2 i + 2
  std::size_t first_leaf_ = 0;  // index of the first leaf in nodes_
  Vec3 center_{0.0};
  double radius_ = 0;  // half the longest edge
};

}  // namespace catena::haptics
