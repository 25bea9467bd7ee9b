// SPDX-License-Identifier: MIT
#include "haptics/chain/baseline.h"

#include "haptics/chain/begin_link.h"

namespace catena::haptics {

namespace {

/// Updates the side of a released surface that the probe is on. Returns whether the probe has crossed the surface since the last call.
bool note_side(SingleProxyTick& tick, std::size_t i) noexcept {
  SingleProxyState::ReleaseState& watch = tick.state.release_states[i];
  Primitive primitive;
  if (!tick.primitive(i, tick.probe, primitive) || primitive.kind != Primitive::Kind::plane) {
    watch.has_height = false;
    return false;
  }
  const double height = dot(primitive.axis, tick.probe - primitive.origin);
  const bool crossed = watch.has_height && (height < 0) != (watch.height < 0);
  watch.height = height;
  watch.has_height = true;
  return crossed;
}

bool takes_hold_again(SingleProxyTick& tick, std::size_t i) noexcept {
  const Link& spec = tick.program.links[i];
  const bool near = tick.apply(i, tick.probe);
  if (spec.one_sided) return tick.links[i].status == LinkStatus::free;
  const bool crossed = note_side(tick, i);
  return near && (crossed || norm(tick.probe - tick.links[i].proxy) <= kRearmFraction * spec.release);
}

/// Starts the links that have been switched on since the last tick. Returns false if there is none.
bool begin_links(SingleProxyTick& tick) noexcept {
  SingleProxyState& single = tick.state;
  const CouplingMethod method = tick.program.coupling.method;
  const bool any_tick = method == CouplingMethod::linear, at_proxy = any_tick || method == CouplingMethod::balance;
  const bool first = !single.has_proxy;
  bool begun = false;
  if (first) single.proxy = tick.probe;
  for (int k = 0; k < tick.order.count; ++k) {
    const auto i = static_cast<std::size_t>(tick.order.links[static_cast<std::size_t>(k)]);
    LinkState& link = tick.links[i];
    tick.domain_length = std::max(tick.domain_length, tick.program.links[i].constraint->domain_length());
    link.dt_s = tick.dt_s;
    link.max_probe_step = kMaxProbeSpeed * tick.dt_s / tick.program.meters_per_unit;
    link.begin_tick();
    if (link.started) continue;
    begun = true;
    single.release_states[i] = {};
    begin_link(tick.program.links[i], at_proxy ? single.proxy : tick.probe, tick.first_tick, link, tick.scratch[i]);
    // methods that do not correct the proxy later must start with it on the constraint
    if ((any_tick || (at_proxy && first)) && is_finite(link.proxy)) single.proxy = link.proxy;
  }
  single.has_proxy = true;
  return begun;
}

Vec3 proxy_of(SingleProxyTick& tick) noexcept {
  switch (tick.program.coupling.method) {
    case CouplingMethod::balance:
      return solve_balance(tick);
    case CouplingMethod::closest:
      return solve_closest(tick);
    case CouplingMethod::linear:
      return solve_linear(tick);
    default:
      return solve_pipe(tick);
  }
}

/// Releases the links whose release distance the proxy has reached. Returns false if none was released.
bool let_go(SingleProxyTick& tick, const Vec3& p) noexcept {
  const double stretch = norm(tick.probe - p);
  bool any = false;
  tick.for_each_held_link([&](std::size_t i) {
    const double release = tick.program.links[i].release;
    if (!tick.holding[i] || !(release > 0) || !(stretch >= release)) return;
    any = true;
    tick.state.release_states[i].released = true;
    note_side(tick, i);
  });
  return any;
}

}  // namespace

bool SingleProxyTick::apply(std::size_t i, const Vec3& incoming) noexcept {
  LinkState& link = links[i];
  link.released = false;
  program.links[i].constraint->advance(incoming, link, scratch[i]);
  if (!is_finite(link.proxy)) {
    link.proxy = incoming;
    set_link_status(link, LinkStatus::critical, SampleStatus::not_finite);
    return false;
  }
  return link.status != LinkStatus::free && link.status != LinkStatus::no_surface;
}

bool SingleProxyTick::primitive(std::size_t i, const Vec3& at, Primitive& out) noexcept {
  LinkState& link = links[i];
  const LinkStatus before = link.status;
  if (link.evaluations < kMaxEvaluations && program.links[i].constraint->primitive(at, link, scratch[i], out) && is_finite(out.origin) &&
      is_finite(out.axis))
    return true;
  if (link.status != before) return false;
  if (link.evaluations < kMaxEvaluations)
    set_link_status(link, LinkStatus::critical, SampleStatus::zero);
  else
    link.status = LinkStatus::budget;
  return false;
}

void advance_single_proxy(SingleProxyTick& tick, bool same_order) noexcept {
  SingleProxyState& single = tick.state;
  const bool begun = begin_links(tick);
  if (single.settled && same_order && !begun && bitwise_equal(single.probe, tick.probe)) return;

  // re-engages released links
  const bool is_linear = tick.program.coupling.method == CouplingMethod::linear;
  for (int k = 0; k < tick.order.count; ++k) {
    const auto i = static_cast<std::size_t>(tick.order.links[static_cast<std::size_t>(k)]);
    SingleProxyState::ReleaseState& watch = single.release_states[i];
    if (!watch.released || !takes_hold_again(tick, i)) continue;
    watch = {};
    if (is_linear) single.proxy = tick.links[i].proxy;
  }

  // computes the proxy, and computes it once more without the links that were released
  const Vec3 before = single.proxy;
  Vec3 p = tick.probe;
  for (int round = 0; round <= kMaxLinks; ++round) {
    single.proxy = before;
    tick.holding.fill(false);
    p = proxy_of(tick);
    if (!let_go(tick, p)) break;
  }
  int count = 0;
  for (const bool holds : tick.holding) count += holds ? 1 : 0;
  if (count == 0) p = tick.probe;
  if (!is_finite(p)) p = before;

  // fills the reports of the links
  bool spent = false;
  for (int k = 0; k < tick.order.count; ++k) {
    const auto i = static_cast<std::size_t>(tick.order.links[static_cast<std::size_t>(k)]);
    LinkState& link = tick.links[i];
    SingleProxyState::ReleaseState& watch = single.release_states[i];
    watch.was_holding = tick.holding[i];
    link.released = watch.released;
    link.limit = tick.program.links[i].release;
    link.weight = tick.holding[i] ? 1.0 / count : 0;
    link.stiffness_n_per_m = tick.program.coupling.stiffness_n_per_m;
    if (watch.released) link.status = LinkStatus::released;
    if (!tick.holding[i]) link.residual = 0;
    spent = spent || link.status == LinkStatus::budget;
  }
  single.proxy = p;
  single.probe = tick.probe;
  const CouplingMethod method = tick.program.coupling.method;
  single.settled = !spent && (method == CouplingMethod::pipe || method == CouplingMethod::closest);
}

/// Force balance: p minimizes 1/2 K |x - p|^2 + sum 1/2 k_i dist(p, primitive_i)^2, with the primitives of the last proxy.

namespace {

/// Solves a symmetric positive semidefinite 3 x 3 system by L D L'. A direction without stiffness gets 0.
Vec3 solve(const Mat3& a, const Vec3& b) noexcept {
  const double minimum = 1e-14 * std::max(std::max(a[0][0], a[1][1]), a[2][2]);
  const auto part = [&](double value, double pivot) { return pivot > minimum ? value / pivot : 0; };
  const double l10 = part(a[0][1], a[0][0]), l20 = part(a[0][2], a[0][0]);
  const double d1 = a[1][1] - l10 * a[0][1];
  const double m = a[1][2] - l10 * a[0][2];
  const double l21 = part(m, d1), d2 = a[2][2] - l20 * a[0][2] - l21 * m;
  const double y1 = b.y - l10 * b.x, y2 = b.z - l20 * b.x - l21 * y1;
  Vec3 x;
  x.z = part(y2, d2);
  x.y = part(y1, d1) - l21 * x.z;
  x.x = part(b.x, a[0][0]) - l10 * x.y - l20 * x.z;
  return x;
}

}  // namespace

Vec3 solve_balance(SingleProxyTick& tick) noexcept {
  const Vec3 last = tick.state.proxy;
  std::array<Primitive, kMaxLinks> primitives;
  std::array<double, kMaxLinks> stiffness{};
  double largest = tick.program.coupling.stiffness_n_per_m;
  tick.for_each_held_link([&](std::size_t i) {
    if (!tick.apply(i, tick.probe) || !tick.primitive(i, last, primitives[i])) return;
    tick.holding[i] = true;
    stiffness[i] = tick.program.links[i].stiffness_n_per_m.at(last, tick.scratch[i].stiffness_cursor, tick.links[i].evaluations);
    largest = std::max(largest, stiffness[i]);
  });
  if (!(largest > 0)) return tick.probe;

  // the balance of forces, in units of the maximum stiffness
  Mat3 a(tick.program.coupling.stiffness_n_per_m / largest);
  Vec3 b(0.0);
  tick.for_each_held_link([&](std::size_t i) {
    if (!tick.holding[i]) return;
    const Primitive& primitive = primitives[i];
    const double k = stiffness[i] / largest;
    const Vec3 n = primitive.axis, e = primitive.origin - tick.probe;
    Mat3 p(1.0);
    if (primitive.kind != Primitive::Kind::point) {
      const double sign = primitive.kind == Primitive::Kind::line ? -1 : 1;
      for (int c = 0; c < 3; ++c)
        for (int r = 0; r < 3; ++r) p[c][r] = sign * n[c] * n[r] + (sign < 0 && c == r ? 1 : 0);
    }
    a += k * p;
    b += k * (p * e);
  });
  const Vec3 p = tick.probe + solve(a, b);
  tick.for_each_held_link([&](std::size_t i) {
    if (tick.holding[i]) tick.links[i].residual = distance_to(primitives[i], p);
  });
  return p;
}

}  // namespace catena::haptics
