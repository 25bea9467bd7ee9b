// SPDX-License-Identifier: MIT
#include "haptics/chain/passivity.h"

namespace catena::haptics {

namespace {

constexpr double kMinEnergy = 1e-15;  // joules; less is round-off
constexpr double kMinDamping = 1e-3;  // N s/m; less counts as none

bool is_apart(const LinkState& link, bool has_gap) noexcept {
  return !link.switched_on || link.released || link.status == LinkStatus::no_surface || (link.status == LinkStatus::budget && !has_gap);
}

/// Returns the fraction of a spring's energy that it can return through a force limit: r (2 - r), r = limit / force.
double through_limit(double force_n, double max_n) noexcept {
  if (!(force_n > max_n)) return 1;
  const double r = max_n / force_n;
  return r * (2 - r);
}

/// Returns the fraction of the chain force that the ramps of the force limiter let through.
double ramp_of(const DeviceLimits& limits, const ForceLimiterState& guard) noexcept {
  if (guard.force_state == ForceState::stopped || guard.force_state == ForceState::off) return 0;
  return guard.late_ticks > limits.max_late_ticks ? guard.ramp_factor * guard.hold_factor : guard.ramp_factor;
}

// Returns the force that acted since the last tick: the one sent in the last tick, or the one `delay_s` before it (interpolated).
PassivityState::SentForce acted(const PassivityState& state, double delay_s, double dt_s) noexcept {
  using Sent = PassivityState::SentForce;
  constexpr std::uint32_t size = PassivityState::kHistoryLength;
  const Sent& last = state.history[(state.next_index + size - 1) % size];
  if (!(delay_s > 0) || !(dt_s > 0)) return last;
  const double periods = std::fmin(delay_s / dt_s, size - 2.0);
  const auto whole_periods = static_cast<std::uint32_t>(periods);
  const double fraction = periods - whole_periods;
  const Sent& newer = state.history[(state.next_index + size - 1 - whole_periods) % size];
  const Sent& older = state.history[(state.next_index + size - 2 - whole_periods) % size];
  const auto mix = [fraction](const Vec3& a, const Vec3& b) { return a * fraction + b * (1 - fraction); };
  return {mix(older.force_n, newer.force_n), mix(older.exempt_n, newer.exempt_n), mix(older.ramped_n, newer.ramped_n),
          mix(older.damping_n, newer.damping_n)};
}

// release time constant of the added damping; damping that changes from tick to tick would be perceived as a buzz
constexpr double kReleaseS = 0.03;

// Returns the damping that dissipates `need_j` if the probe moves by `move_m` in the next tick; it rises at once and falls slowly.
double step_damping(const DeviceLimits& limits, const Vec3& move_m, double dt_s, double need_j, double last) noexcept {
  const double decayed = dt_s < kReleaseS ? last * (1 - dt_s / kReleaseS) : 0;
  const double squared = dot(move_m, move_m);
  const double needed = need_j > 0 && squared > 0 ? need_j * dt_s / squared : 0;
  const double damping = std::fmin(std::fmax(decayed, needed), limits.max_added_damping_ns_per_m);
  return damping > kMinDamping && std::isfinite(damping) ? damping : 0;
}

// Returns the damping force -d v, for a probe that keeps its velocity.
Vec3 brake(double damping_ns_per_m, const Vec3& move_m, double dt_s) noexcept {
  const Vec3 force = dt_s > 0 ? move_m * (-damping_ns_per_m / dt_s) : Vec3(0.0);
  return is_finite(force) ? force : Vec3(0.0);
}

}  // namespace

void step_passivity(const HapticProgram& program, const std::array<LinkState, kMaxLinks>& links, const EnergyTick& tick,
                    ForceLimiterState& guard, PassivityState& state) noexcept {
  const DeviceLimits& limits = program.limits;
  const Vec3 move_m = tick.displacement * program.meters_per_unit;
  const bool weighs = program.coupling.method == CouplingMethod::chain;
  const bool conservative = weighs && program.coupling.force == CouplingForce::conservative;
  const std::size_t count = program.links.size();

  // work done by the last force
  const PassivityState::SentForce did = acted(state, limits.delay_s, tick.dt_s);
  const double work_j = dot(did.force_n, move_m), taken_j = -dot(did.damping_n, move_m);
  // the work of the ramped force is exempt up to the energy that springs held when they were switched, released or engaged
  const bool fades = max_abs(did.ramped_n) > 0 || max_abs(tick.ramped_n) > 0;
  const double faded_j = std::fmin(dot(did.ramped_n, move_m), state.released_j);
  state.released_j = fades ? state.released_j - faded_j : 0;
  const double free_j = dot(did.exempt_n, move_m) + faded_j;

  // fraction of the chain force that is sent, and the fraction of spring energy that can be returned through the limits
  const double asked = dot(tick.total_force_n, tick.total_force_n);
  const double sent = asked > 0 && std::isfinite(asked) ? dot(guard.force_n, tick.total_force_n) / asked : 0;
  const double ramp = ramp_of(limits, guard);
  Vec3 springs_n(0.0);
  for (std::size_t i = 0; i < count; ++i) springs_n += tick.shares_n[i];
  const double max_n = std::fmin(program.coupling.max_force_n, ramp > 0 ? limits.max_force_n / ramp : 0);
  const double share = 0.5 * program.meters_per_unit * ramp * through_limit(norm(springs_n), max_n);

  // energy account of each link, and the energy added by weights that rose
  bool anew = state.rebase_pending || !(tick.order == state.order);
  double storage_j = 0, raised_j = 0;
  Vec3 granted_n = tick.cues_n;
  for (std::size_t i = 0; i < count; ++i) {
    const LinkState& link = links[i];
    const Vec3& force_n = tick.shares_n[i];
    const bool own = conservative && !state.rebase_pending && tick.order == state.order;
    const double given_j = dot(state.sent_shares_n[i], own ? (tick.probes[i] - state.probes[i]) * program.meters_per_unit : move_m);
    state.probes[i] = tick.probes[i];
    state.work_j[i] += given_j;
    state.sent_shares_n[i] = force_n * sent;
    const bool apart = is_apart(link, max_abs(force_n) > 0);
    anew = anew || apart != state.detached[i];
    state.detached[i] = apart;
    const double stored_j = share * dot(force_n, conservative ? tick.gaps[i] : tick.chain_gap);
    if (link.switched_on && program.links[i].constraint->is_energy_source()) {
      granted_n += force_n;
      state.stored_j[i] = 0;
    } else {
      state.stored_j[i] = stored_j;
      storage_j += stored_j;
      if (weighs && link.weight > state.weights[i]) raised_j += stored_j * (1 - state.weights[i] / link.weight);
    }
    state.weights[i] = link.weight;
  }
  if (ramp > state.ramp_factor) raised_j += (storage_j - raised_j) * (1 - state.ramp_factor / ramp);

  // energy balance
  const double made_j = work_j - free_j + storage_j - state.storage_j;
  const double own_j = tick.dt_s > 0 ? limits.damping_ns_per_m * dot(move_m, move_m) / tick.dt_s : 0;
  const double booked_j = anew ? std::fmax(0.0, made_j) : std::fmax(0.0, raised_j);
  if (anew && fades) state.released_j += std::fabs(made_j);
  state.exempt_j += booked_j + free_j;
  const double step_j = own_j - made_j + booked_j;
  state.balance_j = std::fmin(0.0, state.balance_j + step_j);
  state.dissipated_j += taken_j;
  state.storage_j = storage_j;
  if (!std::isfinite(state.balance_j + state.exempt_j + state.dissipated_j + state.storage_j)) {
    // forces or positions too large for a double: reset the account
    state.balance_j = state.exempt_j = state.dissipated_j = state.storage_j = state.released_j = 0;
    state.work_j.fill(0);
    state.stored_j.fill(0);
  }

  // passivity controller
  Vec3 added_n(0.0);
  const bool flows = guard.force_state == ForceState::on || guard.force_state == ForceState::ramping_in;
  if (limits.passivity_control && flows) {
    const double next_j = state.balance_j + std::fmin(0.0, step_j - taken_j);
    state.damping_ns_per_m = step_damping(limits, move_m, tick.dt_s, next_j < -kMinEnergy ? -next_j : 0, state.damping_ns_per_m);
    if (state.damping_ns_per_m > 0) {
      const Vec3 before = guard.force_n;
      guard.force_n = clamp_norm(before + brake(state.damping_ns_per_m, move_m, tick.dt_s),
                                 std::fmin(limits.max_force_n, program.coupling.max_force_n));
      added_n = guard.force_n - before;
    }
  } else {
    state.damping_ns_per_m = 0;
  }

  state.history[state.next_index] = {guard.force_n, granted_n * sent, tick.ramped_n * sent, added_n};
  state.next_index = (state.next_index + 1) % PassivityState::kHistoryLength;
  state.ramp_factor = ramp;
  state.order = tick.order;
  state.rebase_pending = false;
}

void pause_passivity(PassivityState& state) noexcept {
  state.sent_shares_n.fill(Vec3(0.0));
  state.stored_j.fill(0);
  state.history.fill({});
  state.storage_j = state.ramp_factor = state.released_j = state.damping_ns_per_m = 0;
  state.rebase_pending = true;
}

}  // namespace catena::haptics
