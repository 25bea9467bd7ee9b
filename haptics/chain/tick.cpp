// SPDX-License-Identifier: MIT
#include "haptics/chain/tick.h"

#include <limits>

#include "haptics/chain/begin_link.h"
#include "haptics/chain/bricks.h"
#include "haptics/chain/state_hash.h"

namespace catena::haptics {

namespace {

/// Forces of the links, per link and in total.
struct Coupled {
  std::array<Vec3, kMaxLinks> gaps{};      ///< p_i - p_(i-1), world units
  std::array<Vec3, kMaxLinks> shares_n{};  ///< contribution of each link to the force
  Vec3 force_n{0.0};
  Vec3 left_out_n{0.0};                  ///< conservative force: the part truncated by the bound of the pull-back
  double energy_j = 0;                   ///< conservative force: total spring energy
  std::array<Vec3, kMaxLinks> probes{};  ///< p_(i-1), world units
  Vec3 reach{0.0};                       ///< from the probe to the last proxy, world units
  double newtons_per_unit = 0;           ///< K S: total stiffness of the active links, N per world unit
};

bool is_single(const HapticProgram& program) noexcept { return program.coupling.method != CouplingMethod::chain; }

void switch_off(LinkState& link) noexcept {
  link.switched_on = link.started = link.released = false;
  link.residual = link.limit = link.weight = 0;
  link.begin_tick();
  link.status = LinkStatus::free;
}

double capped(double stiffness, const DeviceLimits& limits) noexcept {
  return stiffness > limits.max_stiffness_n_per_m ? limits.max_stiffness_n_per_m : stiffness;
}

// Repairs results of a plug-in constraint: a proxy that is not finite, or a status or reason outside its enumeration.
void keep_sane(const Vec3& incoming, LinkState& link) noexcept {
  if (is_finite(link.proxy) && is_valid_enum(link.status, LinkStatus::bad_probe) && is_valid_enum(link.reason, SampleStatus::parallel))
    return;
  link.proxy = incoming;
  set_link_status(link, LinkStatus::critical, SampleStatus::not_finite);
}

// Advances one active link: starts it if it was just switched on, then advances its proxy and its weight (the ramp after a switch).
void advance_link(const HapticProgram& program, std::size_t i, const Vec3& incoming, bool first_tick, double dt, double ramp_step,
                  LinkState& link, LinkScratch& scratch) noexcept {
  const Link& spec = program.links[i];
  link.begin_tick();
  link.dt_s = dt;
  link.max_probe_step = kMaxProbeSpeed * dt / program.meters_per_unit;
  if (!link.started) {
    begin_link(spec, incoming, first_tick, link, scratch);
  } else {
    link.stiffness_n_per_m = spec.stiffness_n_per_m.at(link.proxy, scratch.stiffness_cursor, link.evaluations);
  }
  link.stiffness_n_per_m = capped(link.stiffness_n_per_m, program.limits);
  const double newtons_per_unit = link.stiffness_n_per_m * program.meters_per_unit;
  link.max_slip =
      newtons_per_unit > 0 ? kSlipFraction * program.coupling.max_force_n / newtons_per_unit : std::numeric_limits<double>::infinity();
  spec.constraint->advance(incoming, link, scratch);
  keep_sane(incoming, link);
  link.weight = link.weight + ramp_step < 1 ? link.weight + ramp_step : 1;
}

// Sets the proxies of links that are off: the proxy of the previous link in the scene, or the probe if a mode orders the chain.
void pass_through(const HapticProgram& program, const LinkOrder& order, const Vec3& probe, ChainState& state) noexcept {
  Vec3 before = probe;
  for (std::size_t i = 0; i < program.links.size(); ++i) {
    if (!state.links[i].switched_on) state.links[i].proxy = before;
    if (order.mode < 0) before = state.links[i].proxy;
  }
}

Vec3 last_proxy(const LinkOrder& order, const Vec3& probe, const ChainState& state) noexcept {
  return order.count > 0 ? state.links[static_cast<std::size_t>(order.links[static_cast<std::size_t>(order.count - 1)])].proxy : probe;
}

// Runs a tick of a baseline method, with one proxy for all links; the force is K S (p - x).
Coupled one_proxy(const HapticProgram& program, const LinkOrder& order, const Vec3& probe, double dt, ChainState& state,
                  ChainScratch& scratch) noexcept {
  SingleProxyTick single{program, order, probe, dt, !state.has_probe, state.single_proxy, state.links, scratch.links};
  advance_single_proxy(single, order == state.order);
  Coupled out;
  const Vec3 gap = state.single_proxy.proxy - probe;
  for (std::size_t i = 0; i < kMaxLinks; ++i) {
    LinkState& link = state.links[i];
    link.stiffness_n_per_m = capped(link.stiffness_n_per_m, program.limits);
    if (!link.switched_on || !state.single_proxy.release_states[i].was_holding) continue;
    out.gaps[i] = gap;
    out.shares_n[i] = gap * (link.weight * link.stiffness_n_per_m * program.meters_per_unit);
  }
  out.newtons_per_unit = capped(program.coupling.stiffness_n_per_m, program.limits) * program.meters_per_unit;
  out.force_n = gap * out.newtons_per_unit;
  out.reach = gap;
  return out;
}

// Runs a tick of the chain, in which each proxy is the next link's probe.
Coupled chain(const HapticProgram& program, const LinkOrder& order, const Vec3& probe, double dt, double ramp_step, ChainState& state,
              ChainScratch& scratch) noexcept {
  Coupled out;
  const bool conservative = program.coupling.force == CouplingForce::conservative;
  Vec3 incoming = probe;
  for (int k = 0; k < order.count; ++k) {
    const auto i = static_cast<std::size_t>(order.links[static_cast<std::size_t>(k)]);
    LinkState& link = state.links[i];
    advance_link(program, i, incoming, !state.has_probe, dt, ramp_step, link, scratch.links[i]);
    if (conservative && !program.links[i].stiffness_n_per_m.is_constant())
      link.stiffness_n_per_m =
          capped(program.links[i].stiffness_n_per_m.at(link.proxy, scratch.links[i].stiffness_cursor, link.evaluations), program.limits);
    out.probes[i] = incoming;
    out.gaps[i] = link.proxy - incoming;
    out.shares_n[i] = out.gaps[i] * (link.weight * link.stiffness_n_per_m * program.meters_per_unit);
    out.newtons_per_unit += link.stiffness_n_per_m * program.meters_per_unit;
    out.force_n += out.shares_n[i];
    out.energy_j += 0.5 * program.meters_per_unit * dot(out.shares_n[i], out.gaps[i]);
    incoming = link.proxy;
  }
  if (conservative) {
    const PulledBackForce all = virtual_work_force(program, order, probe, out.gaps, out.shares_n, state.links, scratch.links);
    out.force_n = all.force;
    out.left_out_n = all.truncated;
  }
  out.reach = incoming - probe;
  pass_through(program, order, probe, state);
  return out;
}

// Returns the direction of the total link force plus `braking` times the move, for values too large for a double: each term is scaled down
// before it is computed.
Vec3 huge_direction(const HapticProgram& program, const LinkOrder& order, const Vec3& probe, double braking,
                    const ChainState& state) noexcept {
  constexpr double small = 1e-160;
  Vec3 incoming = probe, force(0.0);
  const bool single = is_single(program);
  if (single && order.count > 0)
    force = (state.single_proxy.proxy * small - probe * small) *
            (capped(program.coupling.stiffness_n_per_m, program.limits) * program.meters_per_unit * small);
  for (int k = 0; k < order.count && !single; ++k) {
    const LinkState& link = state.links[static_cast<std::size_t>(order.links[static_cast<std::size_t>(k)])];
    force += (link.proxy * small - incoming * small) * (link.weight * link.stiffness_n_per_m * program.meters_per_unit * small);
    incoming = link.proxy;
  }
  if (state.has_probe) force -= (probe * small - state.last_probe * small) * (braking * small);
  return direction(force);
}

// Clamps a reported value to the largest double; NaN (an infinite gap of weight 0) becomes 0.
double bounded(double v) noexcept {
  constexpr double maximum = std::numeric_limits<double>::max();
  return v > maximum ? maximum : v < -maximum ? -maximum : v == v ? v : 0;
}

/// Returns the reason for the link's status. LinkState::reason keeps its last value, so it is reported only with a status that has a
/// reason.
SampleStatus reason_of(const LinkState& link) noexcept {
  if (link.status == LinkStatus::bad_probe) return SampleStatus::not_finite;
  return link.status == LinkStatus::critical || link.status == LinkStatus::boundary ? link.reason : SampleStatus::ok;
}

/// Returns the status that is reported: a link holds to the coarse level of a paged grid as to any other values.
LinkStatus reported_status(const LinkState& link) noexcept {
  return link.is_coarse && link.status == LinkStatus::ok ? LinkStatus::coarse : link.status;
}

/// Takes over the bricks of this tick.
void take_bricks(const HapticProgram& program, const ProbeSample& probe, ChainState& state, ChainScratch& scratch) noexcept {
  // the limit stays until the ramp offset has faded
  if (state.limited_ticks > 1 || (state.limited_ticks == 1 && max_abs(state.ramp.offset) == 0)) --state.limited_ticks;
  bool has_changed = false;
  if (probe.bricks != scratch.bricks) {
    std::array<Vec3, kMaxLinks + 2> positions{probe.position, state.last_probe};
    for (std::size_t i = 0; i < program.links.size(); ++i) positions[i + 2] = state.links[i].proxy;
    has_changed =
        state.has_probe && bricks_differ(program.paged_grids, scratch.bricks, probe.bricks, {positions.data(), program.links.size() + 2});
    scratch.bricks = probe.bricks;
  }
  if (has_changed) state.limited_ticks = kLimitedTicks;
  for (std::size_t i = 0; i < program.links.size(); ++i) {
    state.links[i].data_changed = has_changed;
    begin_bricks(probe.bricks, scratch.links[i]);
  }
}

void report(const HapticProgram& program, const ChainState& state, HapticState& out) noexcept {
  out.tick = state.ticks;
  out.t_s = state.last_probe_t_s;
  out.coupling_force_n = state.chain_force_n;
  out.force_n = state.force_limiter.force_n;
  out.torque_nm = state.force_limiter.torque_nm;
  out.force_state = state.force_limiter.force_state;
  out.link_count = static_cast<std::int32_t>(program.links.size());
  out.mode = state.order.mode;
  out.energy_j = state.passivity.energy_j();
  out.dissipated_j = state.passivity.dissipated_j;
  out.omitted_work_j = bounded(state.unaccounted.work_j);
  for (std::size_t i = 0; i < program.links.size(); ++i) {
    const LinkState& link = state.links[i];
    LinkReport& to = out.links[i];
    to.proxy = is_single(program) ? state.single_proxy.proxy : link.proxy;
    to.residual = link.residual;
    to.weight = link.weight;
    to.stiffness_n_per_m = link.stiffness_n_per_m;
    to.accounted_j = bounded(state.passivity.accounted_j(i));
    to.evaluations = link.evaluations;
    to.status = reported_status(link);
    to.sample_status = reason_of(link);
    to.active = link.active();
    to.curve = link.curve_index;
  }
  report_widgets(program, state.widgets, out);
}

void hold_all(const HapticProgram& program, double t_s, ChainState& state, HapticState& out) noexcept {
  for (std::size_t i = 0; i < program.links.size(); ++i) {
    state.links[i].status = LinkStatus::bad_probe;
    state.links[i].begin_tick();
    out.links[i].orientation = state.alignment.rotational_proxies[i];
    out.links[i].force_n = out.links[i].torque_nm = Vec3(0.0);
    out.links[i].gap = out.links[i].release_ratio = 0;
    out.links[i].released = state.release_cues[i].released;
  }
  state.chain_force_n = state.requested_force_n = Vec3(0.0);
  state.ramp = Ramp{};
  state.unaccounted.has_previous = false;
  // without a pose there is no force, even if the tick is in time
  limit_force(program.limits, {Vec3(0.0), Vec3(0.0), TickCondition::no_device, false, 0}, state.force_limiter);
  pause_passivity(state.passivity);
  pause_widgets(state.widgets);
  if (std::isfinite(t_s)) state.last_tick_t_s = t_s;
  ++state.ticks;
  report(program, state, out);
}

}  // namespace

void tick(const HapticProgram& program, const ProbeSample& probe, ChainState& state, ChainScratch& scratch, HapticState& out) noexcept {
  out.probe = probe.position;
  out.buttons = probe.buttons;
  out.program_epoch = program.epoch;
  out.orientation = probe.orientation;
  out.condition = probe.condition;
  out.brick_snapshot = probe.bricks ? probe.bricks->number() : 0;
  if (!program.paged_grids.empty() || scratch.bricks != nullptr) take_bricks(program, probe, state, scratch);
  const bool stopped = probe.condition == TickCondition::no_device || probe.condition == TickCondition::watchdog;
  if (stopped || !is_finite(probe.position) || !is_finite(probe.orientation) || !std::isfinite(probe.t_s))
    return hold_all(program, probe.t_s, state, out);

  const double dt = state.has_probe ? std::fmax(0.0, probe.t_s - state.last_probe_t_s) : 0;
  // ramps count from the last tick, even if it had no probe
  const double ramp_dt = std::fmin(dt, std::fmax(0.0, probe.t_s - state.last_tick_t_s));
  const double ramp_step = program.coupling.ramp_s > 0 ? ramp_dt / program.coupling.ramp_s : 1;
  const double s = program.meters_per_unit;
  LinkOrder order = step_switches(program, probe.buttons, norm(state.chain_force_n), state.switches);
  if (!program.widgets.empty())
    order = engage_widgets(program, {probe.position, probe.buttons}, order, state.switches, state.links, state.widgets);

  for (std::size_t i = 0; i < program.links.size(); ++i)
    if (!order.contains(i)) switch_off(state.links[i]);

  const Coupled coupled = is_single(program) ? one_proxy(program, order, probe.position, dt, state, scratch)
                                             : chain(program, order, probe.position, dt, ramp_step, state, scratch);

  if (!program.paged_grids.empty())
    for (std::size_t i = 0; i < program.links.size(); ++i)
      if (state.links[i].evaluations > 0) state.links[i].is_coarse = is_coarse(scratch.links[i]);

  if (!program.widgets.empty()) move_widgets(program, last_proxy(order, probe.position, state), state.widgets);

  // release cues and reports of the links
  Vec3 cues(0.0);
  for (std::size_t i = 0; i < program.links.size(); ++i) {
    const Vec3& share = coupled.shares_n[i];
    out.links[i].force_n = {bounded(share.x), bounded(share.y), bounded(share.z)};
    out.links[i].gap = bounded(norm(coupled.gaps[i]));
    cues += update_release_cue(program.links[i].release_cue, state.links[i], coupled.gaps[i], probe.t_s, dt, state.release_cues[i],
                               out.links[i]);
  }

  // chain force, with steps ramped
  const Vec3 move = state.has_probe ? probe.position - state.last_probe : Vec3(0.0);
  const double maximum = program.coupling.max_force_n;
  const bool huge = !std::isfinite(norm(coupled.force_n));
  const Vec3 pull = huge ? huge_direction(program, order, probe.position, 0, state) * maximum : clamp_norm(coupled.force_n, maximum);
  if (!state.has_probe) state.ramp.last_force = pull;
  double fall = program.coupling.ramp_s > 0 ? maximum * ramp_step : std::numeric_limits<double>::infinity();
  if (state.limited_ticks > 0) fall = std::fmin(fall, kSlipFraction * maximum);
  const Vec3 ramped = step_ramp(state.ramp, pull, coupled.newtons_per_unit * norm(move), fall);
  const Vec3 requested = coupled.force_n + ramped + cues;
  state.requested_force_n = {bounded(requested.x), bounded(requested.y), bounded(requested.z)};

  // the coupling's damping, then the force limit, which keeps the direction
  const double braking = dt > 0 ? program.coupling.damping_ns_per_m * s / dt : 0;
  const Vec3 braked = state.has_probe ? move * braking : Vec3(0.0), sum = requested - braked;
  const Vec3 total = max_abs(ramped) > 0 ? pull + ramped + cues - braked : sum;
  const Vec3 force =
      std::isfinite(norm(total)) ? clamp_norm(total, maximum) : huge_direction(program, order, probe.position, braking, state) * maximum;

  state.chain_force_n = force;
  const Vec3 torque =
      align_links(program, order, probe.orientation, {!state.has_probe, dt, ramp_step}, state.links, scratch.links, state.alignment, out);
  for (std::size_t i = 0; i < program.links.size(); ++i) state.alignment.rotational_proxies[i] = out.links[i].orientation;
  limit_force(program.limits, {force, torque, probe.condition, probe.forces_on, ramp_dt}, state.force_limiter);
  if (program.coupling.force == CouplingForce::conservative)
    accumulate_unaccounted(state.unaccounted, {coupled.force_n, coupled.left_out_n}, coupled.energy_j, move * s);
  step_passivity(program, state.links, {move, coupled.probes, coupled.gaps, coupled.reach, dt, order, coupled.shares_n, cues, ramped, sum},
                 state.force_limiter, state.passivity);
  state.order = order;
  state.last_probe = probe.position;
  state.last_probe_t_s = state.last_tick_t_s = probe.t_s;
  state.has_probe = true;
  ++state.ticks;
  report(program, state, out);
}

namespace {

bool keeps(const Link& from, const Link& to) noexcept {
  return from.name == to.name && (from.spec_hash != 0 ? from.spec_hash == to.spec_hash : from.constraint == to.constraint);
}

}  // namespace

void rebind_program(const HapticProgram& from, const HapticProgram& to, ChainState& state, ChainScratch& scratch) noexcept {
  const ChainState old = state;
  scratch = ChainScratch{};
  state.alignment.axes = {};
  state.passivity.rebase_pending = true;
  state.unaccounted.has_previous = false;
  if (from.coupling.method != to.coupling.method) state.single_proxy = SingleProxyState{};
  for (std::size_t i = 0; i < static_cast<std::size_t>(kMaxLinks); ++i) {
    state.links[i] = LinkState{};
    state.release_cues[i] = ReleaseCueState{};
    state.single_proxy.release_states[i] = {};
    state.switches.link_on[i] = false;
    state.passivity.work_j[i] = state.passivity.stored_j[i] = state.passivity.weights[i] = 0;
    state.passivity.sent_shares_n[i] = Vec3(0.0);
    if (i >= to.links.size()) continue;
    for (std::size_t k = 0; k < from.links.size(); ++k) {
      if (!keeps(from.links[k], to.links[i])) continue;
      state.links[i] = old.links[k];
      state.release_cues[i] = old.release_cues[k];
      if (from.coupling.method == to.coupling.method) state.single_proxy.release_states[i] = old.single_proxy.release_states[k];
      state.switches.link_on[i] = old.switches.link_on[k];
      // the energy account of a link is kept; the contribution of removed links stays in the observer
      state.passivity.work_j[i] = old.passivity.work_j[k];
      state.passivity.stored_j[i] = old.passivity.stored_j[k];
      state.passivity.weights[i] = old.passivity.weights[k];
      state.passivity.sent_shares_n[i] = old.passivity.sent_shares_n[k];
    }
  }
  rebind_widgets(from, to, state.widgets);
  for (std::size_t i = 0; i < static_cast<std::size_t>(kMaxModes); ++i) {
    state.switches.mode_on[i] = false;
    if (i >= to.modes.size()) continue;
    for (std::size_t k = 0; k < from.modes.size(); ++k)
      if (from.modes[k].name == to.modes[i].name) state.switches.mode_on[i] = old.switches.mode_on[k];
  }
}

}  // namespace catena::haptics
