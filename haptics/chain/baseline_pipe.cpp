/// Constraint pipe: p = x; then p = advance_i(p), link after link, until a pass moves p by at most 1e-11 L.
/// Projecting in turn contracts by cos^2 of the angle between two constraints. So after two passes the links that still move p
/// are met at once, by Newton's method on their primitives (the shortest way onto all of them, as the passes would find where
/// the constraints are flat), and the links that took no part, one-sided ones that were free, are asked again there.
/// At most kPasses passes a tick (kPassesAgain at least after a link has let go), then BUDGET: constraints that do not intersect end so.
#include "haptics/chain/baseline.h"

namespace catena::haptics {

namespace {

constexpr int kPasses = 32, kPassesAgain = 4, kNewton = 12;
constexpr double kSatisfied = 1e-11, kLongest = 0.25;  // of L

/// One pass. Returns how far any link was left behind by those after it.
double pass(SingleTick& tick, Vec3& p, std::array<bool, kMaxLinks>& holds) noexcept {
  std::array<Vec3, kMaxLinks> left{};
  tick.each([&](std::size_t i) {
    // on the edge of its free side is still held, where the last pass held it
    Primitive edge;
    const bool held = holds[i];
    holds[i] = tick.apply(i, p);
    if (held && !holds[i]) holds[i] = tick.primitive(i, p, edge) && distance_to(edge, p) <= kSatisfied * tick.length;
    p = tick.links[i].proxy;
    left[i] = p;
  });
  double worst = 0;
  tick.each([&](std::size_t i) {
    const double off = norm(p - left[i]);
    tick.links[i].residual = std::max(tick.links[i].residual, off);
    worst = std::max(worst, off);
  });
  return worst;
}

/// From p to a place on all that hold. False: not found; p is where it was.
bool meet(SingleTick& tick, const std::array<bool, kMaxLinks>& holds, Vec3& p) noexcept {
  Vec3 q = p;
  for (int k = 0; k < kNewton; ++k) {
    Span span;
    double worst = 0;
    bool all = true;
    tick.each([&](std::size_t i) {
      Primitive primitive;
      if (!holds[i] || !all) return;
      all = tick.primitive(i, q, primitive);
      if (!all) return;
      tick.links[i].residual = distance_to(primitive, q);
      worst = std::max(worst, tick.links[i].residual);
      span.add(primitive, q);
    });
    if (!all) return false;
    if (worst <= 0.1 * kSatisfied * tick.length) {
      p = q;
      return true;
    }
    const Vec3 move = span.move();
    const double step = norm(move), longest = kLongest * tick.length;
    if (!std::isfinite(step)) return false;
    q += step <= longest ? move : move * (longest / step);
  }
  return false;
}

/// The links that took no part: none of them holds where p is now, but for round-off.
bool others_agree(SingleTick& tick, const std::array<bool, kMaxLinks>& holds, const Vec3& p) noexcept {
  bool agree = true;
  tick.each([&](std::size_t i) {
    if (!holds[i] && tick.apply(i, p) && !(norm(tick.links[i].proxy - p) <= kSatisfied * tick.length)) agree = false;
  });
  return agree;
}

}  // namespace

Vec3 pipe(SingleTick& tick) noexcept {
  Vec3 p = tick.probe;
  std::array<bool, kMaxLinks> holds{};
  bool satisfied = false;
  const int most = std::max(kPasses - tick.passes, kPassesAgain);
  for (int k = 0; k < most && !satisfied; ++k, ++tick.passes) {
    satisfied = pass(tick, p, holds) <= kSatisfied * tick.length;
    if (!satisfied && k > 0) satisfied = meet(tick, holds, p) && others_agree(tick, holds, p);
  }
  tick.holds = holds;
  tick.each([&](std::size_t i) {
    LinkState& link = tick.links[i];
    if (!holds[i]) return;
    if (!satisfied)
      link.status = Status::budget;
    else if (link.status == Status::free)
      link.status = Status::ok;
  });
  return p;
}

}  // namespace catena::haptics
