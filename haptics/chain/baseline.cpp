#include "haptics/chain/baseline.h"

#include "haptics/chain/begin_link.h"

namespace catena::haptics {

namespace {

/// Where the probe is, seen from a surface that has let go. True: it has crossed it since the last time.
bool note_side(SingleTick& tick, std::size_t i) noexcept {
  SingleProxy::Watch& watch = tick.single.watches[i];
  Primitive primitive;
  if (!tick.primitive(i, tick.probe, primitive) || primitive.kind != Primitive::Kind::plane) {
    watch.known = false;
    return false;
  }
  const double height = dot(primitive.axis, tick.probe - primitive.origin);
  const bool crossed = watch.known && (height < 0) != (watch.height < 0);
  watch.height = height;
  watch.known = true;
  return crossed;
}

bool takes_hold_again(SingleTick& tick, std::size_t i) noexcept {
  const Link& spec = tick.program.links[i];
  const bool near = tick.apply(i, tick.probe);
  if (spec.one_sided) return tick.links[i].status == Status::free;
  const bool crossed = note_side(tick, i);
  return near && (crossed || norm(tick.probe - tick.links[i].proxy) <= kRearmPart * spec.release);
}

/// Starts the links that have just been switched on. False: none has.
bool begin_links(SingleTick& tick) noexcept {
  SingleProxy& single = tick.single;
  const CouplingMethod method = tick.program.coupling.method;
  const bool any_tick = method == CouplingMethod::linear, at_proxy = any_tick || method == CouplingMethod::balance;
  const bool first = !single.started;
  bool begun = false;
  if (first) single.proxy = tick.probe;
  for (int k = 0; k < tick.order.count; ++k) {
    const auto i = static_cast<std::size_t>(tick.order.links[static_cast<std::size_t>(k)]);
    LinkState& link = tick.links[i];
    tick.length = std::max(tick.length, tick.program.links[i].constraint->domain_length());
    link.dt_s = tick.dt_s;
    link.hand_step = kFastestHand * tick.dt_s / tick.program.metres_per_unit;
    link.begin_tick();
    if (link.started) continue;
    begun = true;
    single.watches[i] = {};
    begin_link(tick.program.links[i], at_proxy ? single.proxy : tick.probe, tick.first_tick, link, tick.scratch[i]);
    // what is not corrected later must begin on the constraint
    if ((any_tick || (at_proxy && first)) && is_finite(link.proxy)) single.proxy = link.proxy;
  }
  single.started = true;
  return begun;
}

Vec3 proxy_of(SingleTick& tick) noexcept {
  switch (tick.program.coupling.method) {
    case CouplingMethod::balance:
      return balance(tick);
    case CouplingMethod::closest:
      return closest(tick);
    case CouplingMethod::linear:
      return linear(tick);
    default:
      return pipe(tick);
  }
}

/// Lets go of the links whose release the proxy has reached. False: of none.
bool let_go(SingleTick& tick, const Vec3& p) noexcept {
  const double stretch = norm(tick.probe - p);
  bool any = false;
  tick.each([&](std::size_t i) {
    const double release = tick.program.links[i].release;
    if (!tick.holds[i] || !(release > 0) || !(stretch >= release)) return;
    any = true;
    tick.single.watches[i].released = true;
    note_side(tick, i);
  });
  return any;
}

}  // namespace

bool SingleTick::apply(std::size_t i, const Vec3& incoming) noexcept {
  LinkState& link = links[i];
  link.released = false;
  program.links[i].constraint->advance(incoming, link, scratch[i]);
  if (!is_finite(link.proxy)) {
    link.proxy = incoming;
    stop_link(link, Status::critical, Reason::not_finite);
    return false;
  }
  return link.status != Status::free && link.status != Status::no_surface;
}

bool SingleTick::primitive(std::size_t i, const Vec3& at, Primitive& out) noexcept {
  LinkState& link = links[i];
  const Status before = link.status;
  if (link.evaluations < kEvaluationCap && program.links[i].constraint->primitive(at, link, scratch[i], out) && is_finite(out.origin) &&
      is_finite(out.axis))
    return true;
  if (link.status != before) return false;
  if (link.evaluations < kEvaluationCap)
    stop_link(link, Status::critical, Reason::zero);
  else
    link.status = Status::budget;
  return false;
}

void advance_single_proxy(SingleTick& tick, bool same_order) noexcept {
  SingleProxy& single = tick.single;
  const bool begun = begin_links(tick);
  if (single.settled && same_order && !begun && same_bits(single.probe, tick.probe)) return;

  // links that have let go
  const bool is_linear = tick.program.coupling.method == CouplingMethod::linear;
  for (int k = 0; k < tick.order.count; ++k) {
    const auto i = static_cast<std::size_t>(tick.order.links[static_cast<std::size_t>(k)]);
    SingleProxy::Watch& watch = single.watches[i];
    if (!watch.released || !takes_hold_again(tick, i)) continue;
    watch = {};
    if (is_linear) single.proxy = tick.links[i].proxy;
  }

  // the proxy; again without those that let go
  const Vec3 before = single.proxy;
  Vec3 p = tick.probe;
  for (int round = 0; round <= kMaxLinks; ++round) {
    single.proxy = before;
    tick.holds.fill(false);
    p = proxy_of(tick);
    if (!let_go(tick, p)) break;
  }
  int count = 0;
  for (const bool holds : tick.holds) count += holds ? 1 : 0;
  if (count == 0) p = tick.probe;
  if (!is_finite(p)) p = before;

  // what the links report
  bool spent = false;
  for (int k = 0; k < tick.order.count; ++k) {
    const auto i = static_cast<std::size_t>(tick.order.links[static_cast<std::size_t>(k)]);
    LinkState& link = tick.links[i];
    SingleProxy::Watch& watch = single.watches[i];
    watch.holds = tick.holds[i];
    link.released = watch.released;
    link.limit = tick.program.links[i].release;
    link.weight = tick.holds[i] ? 1.0 / count : 0;
    link.stiffness_n_per_m = tick.program.coupling.stiffness_n_per_m;
    if (watch.released) link.status = Status::released;
    if (!tick.holds[i]) link.residual = 0;
    spent = spent || link.status == Status::budget;
  }
  single.proxy = p;
  single.probe = tick.probe;
  const CouplingMethod method = tick.program.coupling.method;
  single.settled = !spent && (method == CouplingMethod::pipe || method == CouplingMethod::closest);
}

/// Force balance: p minimises 1/2 K |x - p|^2 + sum 1/2 k_i dist(p, primitive_i)^2, the primitives taken at the last proxy.
///   (K I + sum k_i P_i) (p - x) = sum k_i P_i (o_i - x),   P = I for a point, I - t t' for a line, n n' for a plane

namespace {

/// Symmetric positive semidefinite 3 x 3, by L D L'; a direction without stiffness stays where it is.
Vec3 solve(const Mat3& a, const Vec3& b) noexcept {
  const double least = 1e-14 * std::max(std::max(a[0][0], a[1][1]), a[2][2]);
  const auto part = [&](double value, double pivot) { return pivot > least ? value / pivot : 0; };
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

Vec3 balance(SingleTick& tick) noexcept {
  const Vec3 last = tick.single.proxy;
  std::array<Primitive, kMaxLinks> primitives;
  std::array<double, kMaxLinks> stiffness{};
  double largest = tick.program.coupling.stiffness_n_per_m;
  tick.each([&](std::size_t i) {
    if (!tick.apply(i, tick.probe) || !tick.primitive(i, last, primitives[i])) return;
    tick.holds[i] = true;
    stiffness[i] = tick.program.links[i].stiffness_n_per_m.at(last, tick.scratch[i].stiffness, tick.links[i].evaluations);
    largest = std::max(largest, stiffness[i]);
  });
  if (!(largest > 0)) return tick.probe;

  // the balance, in units of the largest stiffness
  Mat3 a(tick.program.coupling.stiffness_n_per_m / largest);
  Vec3 b(0.0);
  tick.each([&](std::size_t i) {
    if (!tick.holds[i]) return;
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
  tick.each([&](std::size_t i) {
    if (tick.holds[i]) tick.links[i].residual = distance_to(primitives[i], p);
  });
  return p;
}

}  // namespace catena::haptics
