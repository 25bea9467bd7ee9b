// SPDX-License-Identifier: MIT
/// The proxy on connected line segments, at the local minimum of the distance to the probe that lies downhill from the proxy (shapes.h,
/// polyline_constraint). Start, `seek` and re-engagement: the globally closest point (common/closest_point_bvh.h); the probe passes,
/// BUDGET, until that search has ended.
///   Pieces   has(k): whether segment k exists, true for k = 0; piece(k): the LineSegment; neighbour(k, step_sign): the segment after
///   (step_sign 1) or
///            before (step_sign -1) it, or k itself at an open end;
///            search, is_sane, extent as those of ClosestPointBvh; kFirstVisits, kVisits: nodes of the first tick's search and of a later
///            one's; line_of(k), if it has lines: index of the line of segment k; kVisitWork, walk_work(n), kMaxPieces: work units of a
///            visited node and of the n-th segment walked, and the maximum number of segments walked per tick
/// Haptic thread: no allocation, lock, or throw. Lengths in world units.
#pragma once
#include "haptics/constraints/common/closest_point_bvh.h"
#include "haptics/constraints/shapes/closed_form.h"

namespace catena::haptics {

/// Surface without sides for the contact rules, over a set of segments `Pieces`.
template <class Pieces>
class PolylineTracker final : public ContactSurface {
 public:
  using Shape = Pieces;
  /// State between ticks.
  struct Memory {
    /// Progress of the global search.
    SearchState search;
    /// Index of the segment that the proxy is on.
    std::uint32_t piece;
    std::int32_t end;  // end of that segment that the proxy is at: -1 a, 1 b, 0 between
  };
  PolylineTracker(const Shape& shape, Memory& memory, const SideMemory&) : shape_(shape), memory_(memory) {}

  static bool is_sane(const Shape& shape, const Memory& m) noexcept {
    return shape.is_sane(m.search) && shape.has(m.search.best_item) && shape.has(m.piece) && m.end >= -1 && m.end <= 1;
  }
  SideValue evaluate_side(const Vec3&) noexcept override { return {}; }

  SurfaceHold project_probe(const Vec3& probe) noexcept override {
    search(probe);
    return memory_.search.in_progress ? SurfaceHold{false, probe, 0, LinkStatus::budget}
                                      : hold(memory_.search.best_item, probe, LinkStatus::ok);
  }

  SurfaceHold slide(const Vec3& probe) noexcept override {
    std::uint32_t k = memory_.piece;
    int walk_direction = memory_.end == 0 ? 0 : leave_corner(k, probe);
    for (int visited = 0; visited < Shape::kMaxPieces; ++visited, work_ += Shape::walk_work(visited)) {
      const int end = shape_.piece(k).end_of(shape_.piece(k).along(probe));
      if (walk_direction == 0) walk_direction = end;
      if (end == 0 || end != walk_direction) return hold(k, probe, LinkStatus::ok);
      const std::uint32_t next = shape_.neighbour(k, walk_direction);
      if (next == k) return hold(k, probe, LinkStatus::ok);
      k = next;
    }
    return hold_end(k, -walk_direction);
  }

  SurfaceHold find_crossing(const Vec3&, const Vec3&) noexcept override { return {}; }

  SurfaceHold project_probe_within(const Vec3& probe, double limit) noexcept override {
    search(probe);
    const SurfaceHold found = hold(memory_.search.best_item, probe, LinkStatus::ok);
    if (!(norm(probe - found.proxy) <= limit)) return {};
    memory_.search.in_progress = false;
    return found;
  }

  /// Work units of this tick.
  int work() const noexcept { return work_; }
  /// Returns the index of the line that the proxy is on.
  int curve() const noexcept requires requires(const Shape& shape) { shape.line_of(0u); }
  { return shape_.line_of(memory_.piece); }
  Vec3 normal() const noexcept override { return Vec3(0.0); }
  double domain_length() const noexcept override { return std::max(kDefaultDomainLength, shape_.extent()); }

  bool primitive(const Vec3& at, Primitive& out) noexcept {
    const SurfaceHold held = slide(at);
    if (memory_.end != 0)
      out = {Primitive::Kind::point, held.proxy, Vec3(0.0)};
    else
      out = {Primitive::Kind::line, held.proxy, shape_.piece(memory_.piece).d};
    return true;
  }

 private:
  void search(const Vec3& probe) noexcept {
    SearchState& search = memory_.search;
    shape_.search(probe, search.has_best ? Shape::kVisits : Shape::kFirstVisits, search);
    work_ += Shape::kVisitWork * search.visits;
  }
  /// Leaves a corner for the segment on which the distance decreases faster (at a tie the following one) and sets k to it. Returns the
  /// direction sign: 1 following, -1 preceding, 0 at an open end.
  int leave_corner(std::uint32_t& k, const Vec3& probe) const {
    const std::uint32_t other = shape_.neighbour(k, memory_.end);
    if (other == k) return 0;
    const std::uint32_t before = memory_.end > 0 ? k : other, after = memory_.end > 0 ? other : k;
    const LineSegment &down = shape_.piece(before), &up = shape_.piece(after);
    const Vec3 e = probe - up.a;
    k = dot(e, up.d) >= -dot(e, down.d) ? after : before;
    return k == after ? 1 : -1;
  }

  SurfaceHold hold(std::uint32_t k, const Vec3& probe, LinkStatus status) noexcept {
    const LineSegment& piece = shape_.piece(k);
    const double s = piece.along(probe);
    memory_.piece = k;
    memory_.end = piece.end_of(s);
    const Vec3 proxy = piece.at(s);
    return {true, proxy, memory_.end != 0 ? 0 : piece.distance_from_line(proxy), status};
  }
  SurfaceHold hold_end(std::uint32_t k, int end) noexcept {
    memory_.piece = k;
    memory_.end = end;
    return {true, end < 0 ? shape_.piece(k).a : shape_.piece(k).b, 0, LinkStatus::budget};
  }

  const Shape& shape_;
  Memory& memory_;
  int work_ = 0;
};

}  // namespace catena::haptics
