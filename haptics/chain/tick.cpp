#include "haptics/chain/tick.h"

#include "haptics/chain/begin_link.h"

namespace catena::haptics {

namespace {

bool is_single(const Program& program) noexcept { return program.coupling.combination != Combination::chain; }

void switch_off(LinkState& link) noexcept {
  link.on = link.started = link.released = false;
  link.residual = link.limit = link.weight = 0;
  link.evaluations = 0;
  link.status = Status::free;
}

// One link that is on: its start, its advance, its weight (the ramp after a switch).
void advance_link(const Link& spec, const Vec3& incoming, bool first_tick, double dt, double ramp_step, LinkState& link,
                  LinkScratch& scratch) noexcept {
  link.evaluations = 0;
  link.dt_s = dt;
  if (!link.started) {
    begin_link(spec, incoming, first_tick, link, scratch);
  } else {
    link.stiffness_n_per_m = spec.stiffness_n_per_m.at(link.proxy, scratch.stiffness, link.evaluations);
  }
  spec.constraint->advance(incoming, link, scratch);
  link.weight = link.weight + ramp_step < 1 ? link.weight + ramp_step : 1;
}

// Links that are off pass their probe through: the proxy before them in the scene's order, where no mode orders the chain.
void pass_through(const Program& program, const Order& order, const Vec3& probe, ChainState& state) noexcept {
  Vec3 before = probe;
  for (std::size_t i = 0; i < program.links.size(); ++i) {
    if (!state.links[i].on) state.links[i].proxy = before;
    if (order.mode < 0) before = state.links[i].proxy;
  }
}

// A baseline's tick: one proxy for all links. Returns K S (p - x).
Vec3 one_proxy(const Program& program, const Order& order, const Vec3& probe, double dt, ChainState& state, ChainScratch& scratch,
               std::array<Vec3, kMaxLinks>& gaps, std::array<Vec3, kMaxLinks>& shares) noexcept {
  SingleTick single{program, order, probe, dt, !state.has_probe, state.single, state.links, scratch.links};
  const bool same_order = order == state.fade.order;
  advance_single_proxy(single, same_order);
  const Vec3 gap = state.single.proxy - probe;
  for (std::size_t i = 0; i < kMaxLinks; ++i) {
    const LinkState& link = state.links[i];
    if (!state.links[i].on || !state.single.watches[i].holds) continue;
    gaps[i] = gap;
    shares[i] = gap * (link.weight * link.stiffness_n_per_m * program.metres_per_unit);
  }
  // a switch moves the one proxy, so that all of the force's step fades
  if (!same_order) state.fade.replaced = true;
  return gap * (program.coupling.stiffness_n_per_m * program.metres_per_unit);
}

// The force's direction where it is too large for a double: every term scaled down before it is formed.
Vec3 huge_force(const Program& program, const Order& order, const Vec3& probe, double dt, const ChainState& state) noexcept {
  constexpr double small = 1e-160;
  Vec3 incoming = probe, force(0.0);
  const bool single = is_single(program);
  if (single && order.count > 0)
    force = (state.single.proxy * small - probe * small) * (program.coupling.stiffness_n_per_m * program.metres_per_unit * small);
  for (int k = 0; k < order.count && !single; ++k) {
    const LinkState& link = state.links[static_cast<std::size_t>(order.links[static_cast<std::size_t>(k)])];
    force += (link.proxy * small - incoming * small) * (link.weight * link.stiffness_n_per_m * program.metres_per_unit * small);
    incoming = link.proxy;
  }
  if (state.has_probe && dt > 0)
    force -= (probe * small - state.last_probe * small) * (program.coupling.damping_ns_per_m * program.metres_per_unit / dt * small);
  return force;
}

void report(const Program& program, const ChainState& state, exchange::HapticState& out) noexcept {
  out.tick = state.ticks;
  out.t_s = state.last_t_s;
  out.force_n = state.force_n;
  out.link_count = static_cast<std::int32_t>(program.links.size());
  out.mode = state.fade.order.mode;
  for (std::size_t i = 0; i < program.links.size(); ++i) {
    const LinkState& link = state.links[i];
    exchange::LinkReport& to = out.links[i];
    to.proxy = is_single(program) ? state.single.proxy : link.proxy;
    to.residual = link.residual;
    to.weight = link.weight;
    to.stiffness_n_per_m = link.stiffness_n_per_m;
    to.evaluations = link.evaluations;
    to.status = link.status;
    to.active = link.active();
  }
}

void hold_all(const Program& program, ChainState& state, exchange::HapticState& out) noexcept {
  for (std::size_t i = 0; i < program.links.size(); ++i) {
    state.links[i].status = Status::bad_probe;
    state.links[i].evaluations = 0;
    out.links[i].force_n = Vec3(0.0);
  }
  state.force_n = Vec3(0.0);
  ++state.ticks;
  report(program, state, out);
}

}  // namespace

void tick(const Program& program, const ProbeSample& probe, ChainState& state, ChainScratch& scratch, exchange::HapticState& out) noexcept {
  out.probe = probe.position;
  out.buttons = probe.buttons;
  out.program_epoch = program.epoch;
  if (!is_finite(probe.position) || !std::isfinite(probe.t_s)) return hold_all(program, state, out);

  const double dt = state.has_probe ? probe.t_s - state.last_t_s : 0;
  const double ramp_step = program.coupling.ramp_s > 0 ? dt / program.coupling.ramp_s : 1;
  const double s = program.metres_per_unit;
  const Order order = step_switches(program, probe.buttons, norm(state.force_n), state.switches);

  for (std::size_t i = 0; i < program.links.size(); ++i)
    if (!order.contains(i)) switch_off(state.links[i]);

  // the chain: each proxy is the next link's probe
  std::array<Vec3, kMaxLinks> gaps{}, shares{};
  Vec3 incoming = probe.position, force(0.0), cues(0.0);
  const auto couple = [&](std::size_t i) {
    LinkState& link = state.links[i];
    gaps[i] = link.proxy - incoming;
    shares[i] = gaps[i] * (link.weight * link.stiffness_n_per_m * s);
    force += shares[i];
    incoming = link.proxy;
  };
  if (is_single(program)) {
    force = one_proxy(program, order, probe.position, dt, state, scratch, gaps, shares);
  } else
    for (int k = 0; k < order.count; ++k) {
      const auto i = static_cast<std::size_t>(order.links[static_cast<std::size_t>(k)]);
      advance_link(program.links[i], incoming, !state.has_probe, dt, ramp_step, state.links[i], scratch.links[i]);
      couple(i);
    }
  if (!is_single(program)) pass_through(program, order, probe.position, state);
  if (state.has_probe) {
    force += step_fade(state.fade, order, shares, ramp_step);
  } else {
    state.fade.order = order;
    state.fade.shares = shares;
  }

  // what the links tell of the hand
  for (std::size_t i = 0; i < program.links.size(); ++i) {
    out.links[i].force_n = shares[i];
    out.links[i].gap = norm(gaps[i]);
    cues += indicate(program.links[i].indication, state.links[i], gaps[i], probe.t_s, dt, state.indications[i], out.links[i]);
  }
  force += cues;

  // the coupling's damping, then the limit with the direction kept
  if (state.has_probe && dt > 0) force -= (probe.position - state.last_probe) * (program.coupling.damping_ns_per_m * s / dt);
  const double magnitude = norm(force);
  if (!std::isfinite(magnitude)) {
    force = direction(huge_force(program, order, probe.position, dt, state)) * program.coupling.max_force_n;
  } else if (magnitude > program.coupling.max_force_n) {
    force *= program.coupling.max_force_n / magnitude;
  }

  state.force_n = force;
  state.last_probe = probe.position;
  state.last_t_s = probe.t_s;
  state.has_probe = true;
  ++state.ticks;
  report(program, state, out);
}

}  // namespace catena::haptics
