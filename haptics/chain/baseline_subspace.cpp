// SPDX-License-Identifier: MIT
/// Single proxy with linear constraints: moves the proxy by the part of x - p that the primitives at p leave free (Eqs 1-2 for a
/// line, Eq. 6 for a plane), without correcting drift. A one-sided surface takes part while the probe is behind it; when contact begins,
/// the proxy is put on the surface. A move to a point at which a primitive does not exist is not made.
#include "haptics/chain/baseline.h"

namespace catena::haptics {

Vec3 solve_linear(SingleProxyTick& tick) noexcept {
  Vec3 p = tick.state.proxy;

  // links that take part in this tick
  tick.for_each_held_link([&](std::size_t i) {
    LinkState& link = tick.links[i];
    if (!tick.program.links[i].one_sided) {
      tick.holding[i] = true;
      link.status = LinkStatus::ok;
      return;
    }
    tick.holding[i] = tick.apply(i, tick.probe);
    if (tick.holding[i] && !tick.state.release_states[i].was_holding) p = link.proxy;
  });

  // primitives of these links at p
  ConstrainedSubspace span;
  bool any = false;
  tick.for_each_held_link([&](std::size_t i) {
    if (!tick.holding[i]) return;
    LinkState& link = tick.links[i];
    any = true;
    if (!tick.program.links[i].one_sided) link.proxy = p;
    Primitive primitive;
    if (tick.primitive(i, p, primitive)) {
      link.residual = distance_to(primitive, p);
    } else if (link.status == LinkStatus::no_surface) {
      tick.holding[i] = false;
      return;
    } else {
      primitive = {Primitive::Kind::point, p, Vec3(0.0)};
    }
    span.add(primitive, p);
  });
  if (!any) return tick.probe;

  // moves only to a point where all primitives exist
  const Vec3 next = p + span.project_free(tick.probe - p);
  if (!is_finite(next)) return p;
  bool stays = false;
  tick.for_each_held_link([&](std::size_t i) {
    if (!tick.holding[i] || stays) return;
    LinkState& link = tick.links[i];
    const LinkState before = link;
    Primitive primitive;
    if (!tick.program.links[i].one_sided) link.proxy = next;
    stays = !tick.primitive(i, next, primitive);
    const LinkStatus status = link.status;
    const std::int32_t evaluations = link.evaluations;
    link = before;
    link.evaluations = evaluations;
    if (stays) link.status = status;
  });
  return stays ? p : next;
}

/// Constraint pipe: p = x; then p = advance_i(p), link after link, until a pass moves p by at most 1e-11 L. Successive projection contracts
/// by only cos^2 of the angle between two constraints. So after two passes Newton's method on the primitives solves for all links that
/// still move p together (the shortest step onto all of them: the point that the passes would find if the constraints were flat), and the
/// links that did not constrain (one-sided, probe on the free side) are checked at the result. At most kPasses passes a tick (at least
/// kPassesAgain after a link was released), then status BUDGET; constraints that do not intersect end so.

namespace {

constexpr int kPasses = 32, kPassesAgain = 4, kNewton = 12;
constexpr double kSatisfied = 1e-11, kLongest = 0.25;  // fractions of L

/// Runs one pass. Returns the largest distance from a link's proxy to the final proxy of the pass.
double pass(SingleProxyTick& tick, Vec3& p, std::array<bool, kMaxLinks>& holds) noexcept {
  std::array<Vec3, kMaxLinks> left{};
  tick.for_each_held_link([&](std::size_t i) {
    // a link that held in the last pass still holds at the boundary of its free side
    Primitive edge;
    const bool held = holds[i];
    holds[i] = tick.apply(i, p);
    if (held && !holds[i]) holds[i] = tick.primitive(i, p, edge) && distance_to(edge, p) <= kSatisfied * tick.domain_length;
    p = tick.links[i].proxy;
    left[i] = p;
  });
  double worst = 0;
  tick.for_each_held_link([&](std::size_t i) {
    const double off = norm(p - left[i]);
    tick.links[i].residual = std::max(tick.links[i].residual, off);
    worst = std::max(worst, off);
  });
  return worst;
}

/// Moves p to a point on all links that hold. Returns false, with p unchanged, if none is found.
bool meet(SingleProxyTick& tick, const std::array<bool, kMaxLinks>& holds, Vec3& p) noexcept {
  Vec3 q = p;
  for (int k = 0; k < kNewton; ++k) {
    ConstrainedSubspace span;
    double worst = 0;
    bool all = true;
    tick.for_each_held_link([&](std::size_t i) {
      Primitive primitive;
      if (!holds[i] || !all) return;
      all = tick.primitive(i, q, primitive);
      if (!all) return;
      tick.links[i].residual = distance_to(primitive, q);
      worst = std::max(worst, tick.links[i].residual);
      span.add(primitive, q);
    });
    if (!all) return false;
    if (worst <= 0.1 * kSatisfied * tick.domain_length) {
      p = q;
      return true;
    }
    const Vec3 move = span.shortest_step();
    const double step = norm(move), longest = kLongest * tick.domain_length;
    if (!std::isfinite(step)) return false;
    q += step <= longest ? move : move * (longest / step);
  }
  return false;
}

/// Returns whether no other link constrains p, within round-off.
bool others_agree(SingleProxyTick& tick, const std::array<bool, kMaxLinks>& holds, const Vec3& p) noexcept {
  bool agree = true;
  tick.for_each_held_link([&](std::size_t i) {
    if (!holds[i] && tick.apply(i, p) && !(norm(tick.links[i].proxy - p) <= kSatisfied * tick.domain_length)) agree = false;
  });
  return agree;
}

}  // namespace

Vec3 solve_pipe(SingleProxyTick& tick) noexcept {
  Vec3 p = tick.probe;
  std::array<bool, kMaxLinks> holds{};
  bool satisfied = false;
  const int maximum = std::max(kPasses - tick.iterations, kPassesAgain);
  for (int k = 0; k < maximum && !satisfied; ++k, ++tick.iterations) {
    satisfied = pass(tick, p, holds) <= kSatisfied * tick.domain_length;
    if (!satisfied && k > 0) satisfied = meet(tick, holds, p) && others_agree(tick, holds, p);
  }
  tick.holding = holds;
  tick.for_each_held_link([&](std::size_t i) {
    LinkState& link = tick.links[i];
    if (!holds[i]) return;
    if (!satisfied)
      link.status = LinkStatus::budget;
    else if (link.status == LinkStatus::free)
      link.status = LinkStatus::ok;
  });
  return p;
}

namespace {

constexpr double kParallel = 1e-7;  // sine of the smallest angle at which two equations count as independent

/// Computes an orthonormal pair perpendicular to the unit vector n.
void across_pair(const Vec3& n, Vec3& a, Vec3& b) noexcept {
  const Vec3 pick = std::fabs(n.x) < 0.6 ? Vec3(1, 0, 0) : Vec3(0, 1, 0);
  a = direction(cross(n, pick));
  b = cross(n, a);
}

}  // namespace

void ConstrainedSubspace::add(const Vec3& normal, double distance) noexcept {
  // the component of the equation that is independent of the previous ones; two passes for orthogonality
  Vec3 n = normal;
  double d = distance;
  for (int turn = 0; turn < 2; ++turn)
    for (int k = 0; k < count_; ++k) {
      const auto i = static_cast<std::size_t>(k);
      const double part = dot(n, rows_[i]);
      n -= part * rows_[i];
      d -= part * distances_[i];
    }
  const double r = norm(n);
  if (count_ == 3 || !(r > kParallel) || !std::isfinite(d)) return;
  rows_[static_cast<std::size_t>(count_)] = n / r;
  distances_[static_cast<std::size_t>(count_++)] = d / r;
}

void ConstrainedSubspace::add(const Primitive& primitive, const Vec3& from) noexcept {
  const Vec3 e = primitive.origin - from;
  if (primitive.kind == Primitive::Kind::plane) return add(primitive.axis, dot(primitive.axis, e));
  Vec3 a(1, 0, 0), b(0, 1, 0);
  if (primitive.kind == Primitive::Kind::line) {
    across_pair(primitive.axis, a, b);
  } else {
    add(Vec3(0, 0, 1), e.z);
  }
  add(a, dot(a, e));
  add(b, dot(b, e));
}

Vec3 ConstrainedSubspace::shortest_step() const noexcept {
  Vec3 sum(0.0);
  for (int k = 0; k < count_; ++k) sum += distances_[static_cast<std::size_t>(k)] * rows_[static_cast<std::size_t>(k)];
  return sum;
}

Vec3 ConstrainedSubspace::project_free(Vec3 v) const noexcept {
  if (count_ == 3) return Vec3(0.0);
  for (int turn = 0; turn < 2; ++turn)
    for (int k = 0; k < count_; ++k) v -= dot(v, rows_[static_cast<std::size_t>(k)]) * rows_[static_cast<std::size_t>(k)];
  return v;
}

double distance_to(const Primitive& primitive, const Vec3& point) noexcept {
  const Vec3 e = point - primitive.origin;
  switch (primitive.kind) {
    case Primitive::Kind::plane:
      return std::fabs(dot(primitive.axis, e));
    case Primitive::Kind::line:
      return norm(e - dot(primitive.axis, e) * primitive.axis);
    default:
      return norm(e);
  }
}

/// Closest constraint: each constraint projects the probe; the nearest projection is the proxy, the first one among equally near ones.
Vec3 solve_closest(SingleProxyTick& tick) noexcept {
  Vec3 p = tick.probe;
  double best = -1;
  std::size_t nearest = kMaxLinks;
  tick.for_each_held_link([&](std::size_t i) {
    if (!tick.apply(i, tick.probe)) return;
    const double d = norm(tick.links[i].proxy - tick.probe);
    if (best >= 0 && !(d < best)) return;
    best = d;
    nearest = i;
    p = tick.links[i].proxy;
  });
  if (nearest < kMaxLinks) tick.holding[nearest] = true;
  return p;
}

}  // namespace catena::haptics
