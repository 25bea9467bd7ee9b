#include "haptics/chain/tick.h"

namespace catena::haptics {

namespace {

bool switched_on(const Switch& on, std::uint32_t buttons, double last_force_n) noexcept {
  if (on.button > 0) return ((buttons >> (on.button - 1)) & 1u) != 0;
  if (on.force_above_n > 0) return last_force_n > on.force_above_n;
  return true;
}

void pass_through(const Vec3& incoming, LinkState& link) noexcept {
  link.proxy = incoming;
  link.residual = 0;
  link.status = Status::free;
  link.released = false;
  link.weight = 0;
}

// One link: its switch, its start, its advance, its weight (the ramp after a switch).
void advance_link(const Link& spec, const Vec3& incoming, bool on, bool first_tick, double ramp_step, LinkState& link,
                  LinkScratch& scratch) noexcept {
  link.evaluations = 0;
  if (!on) {
    link.on = false;
    link.started = false;
    pass_through(incoming, link);
    return;
  }
  if (!link.started) {
    link.on = true;
    link.started = true;
    link.released = false;
    link.status = Status::ok;
    link.weight = first_tick ? 1 : 0;
    link.memory.fill(std::byte{0});
    spec.constraint->start(incoming, link, scratch);
  }
  spec.constraint->advance(incoming, link, scratch);
  link.weight = link.weight + ramp_step < 1 ? link.weight + ramp_step : 1;
}

// The force's direction where it is too large for a double: every term scaled down before it is formed.
Vec3 huge_force(const Program& program, const Vec3& probe, double dt, const ChainState& state) noexcept {
  constexpr double small = 1e-160;
  Vec3 incoming = probe, force(0.0);
  for (std::size_t i = 0; i < program.links.size(); ++i) {
    const LinkState& link = state.links[i];
    force += (link.proxy * small - incoming * small) * (link.weight * program.links[i].stiffness_n_per_m * program.metres_per_unit * small);
    incoming = link.proxy;
  }
  if (state.has_probe && dt > 0)
    force -= (probe * small - state.last_probe * small) * (program.coupling.damping_ns_per_m * program.metres_per_unit / dt * small);
  return force;
}

void report(const Program& program, const ChainState& state, const Vec3* link_forces, exchange::HapticState& out) noexcept {
  out.tick = state.ticks;
  out.t_s = state.last_t_s;
  out.force_n = state.force_n;
  out.link_count = static_cast<std::int32_t>(program.links.size());
  for (std::size_t i = 0; i < program.links.size(); ++i) {
    const LinkState& link = state.links[i];
    out.links[i] = {link.proxy, link_forces[i], link.residual, link.weight, link.evaluations, link.status, link.active()};
  }
}

}  // namespace

void tick(const Program& program, const ProbeSample& probe, ChainState& state, ChainScratch& scratch, exchange::HapticState& out) noexcept {
  std::array<Vec3, kMaxLinks> link_forces{};
  out.probe = probe.position;
  out.buttons = probe.buttons;
  out.program_epoch = program.epoch;

  // a bad probe holds everything
  if (!is_finite(probe.position) || !std::isfinite(probe.t_s)) {
    for (std::size_t i = 0; i < program.links.size(); ++i) {
      state.links[i].status = Status::bad_probe;
      state.links[i].evaluations = 0;
    }
    state.force_n = Vec3(0.0);
    ++state.ticks;
    report(program, state, link_forces.data(), out);
    return;
  }

  const double dt = state.has_probe ? probe.t_s - state.last_t_s : 0;
  const double ramp_step = program.coupling.ramp_s > 0 ? dt / program.coupling.ramp_s : 1;
  const double last_force_n = norm(state.force_n);
  const double s = program.metres_per_unit;

  // the chain: each proxy is the next link's probe
  Vec3 incoming = probe.position;
  Vec3 force(0.0);
  for (std::size_t i = 0; i < program.links.size(); ++i) {
    const Link& spec = program.links[i];
    LinkState& link = state.links[i];
    advance_link(spec, incoming, switched_on(spec.on, probe.buttons, last_force_n), !state.has_probe, ramp_step, link, scratch.links[i]);
    link_forces[i] = (link.proxy - incoming) * (link.weight * spec.stiffness_n_per_m * s);
    force += link_forces[i];
    incoming = link.proxy;
  }

  // the coupling's damping, then the limit with the direction kept
  if (state.has_probe && dt > 0) force -= (probe.position - state.last_probe) * (program.coupling.damping_ns_per_m * s / dt);
  const double magnitude = norm(force);
  if (!std::isfinite(magnitude)) {
    force = direction(huge_force(program, probe.position, dt, state)) * program.coupling.max_force_n;
  } else if (magnitude > program.coupling.max_force_n) {
    force *= program.coupling.max_force_n / magnitude;
  }

  state.force_n = force;
  state.last_probe = probe.position;
  state.last_t_s = probe.t_s;
  state.has_probe = true;
  ++state.ticks;
  report(program, state, link_forces.data(), out);
}

}  // namespace catena::haptics
