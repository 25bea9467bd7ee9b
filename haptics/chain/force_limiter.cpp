// SPDX-License-Identifier: MIT
#include "haptics/chain/force_limiter.h"

namespace catena::haptics {

namespace {

// minimum decrease of the ramp factor per tick while ramping out: the ramp ends even if the clock stands still
constexpr double kMinStep = 1e-3;

void stop(ForceLimiterState& state, ForceState as) noexcept {
  state.force_n = state.torque_nm = Vec3(0.0);
  state.ramp_factor = 0;
  state.force_state = as;
}

double step_out(const DeviceLimits& limits, double dt_s) noexcept {
  return limits.ramp_out_s > 0 ? std::fmax(kMinStep, dt_s / limits.ramp_out_s) : 1;
}

// Limits force and torque to their maximum magnitudes; directions are kept.
void limit(const DeviceLimits& limits, ForceLimiterState& state) noexcept {
  state.force_n = clamp_norm(state.force_n, limits.max_force_n);
  state.torque_nm = clamp_norm(state.torque_nm, limits.max_torque_nm);
}

void hold(const DeviceLimits& limits, double dt_s, ForceLimiterState& state) noexcept {
  if (state.force_state == ForceState::stopped || state.force_state == ForceState::off) return stop(state, state.force_state);
  if (++state.late_ticks == 1) {
    state.held_force_n = state.force_n;
    state.held_torque_nm = state.torque_nm;
    state.hold_factor = 1;
  }
  if (state.late_ticks <= limits.max_late_ticks) {
    state.force_state = ForceState::held;
    return;
  }
  state.late_ticks = limits.max_late_ticks + 1;
  const double step = step_out(limits, dt_s);
  state.hold_factor = state.hold_factor > step ? state.hold_factor - step : 0;
  if (!(state.hold_factor > 0)) return stop(state, ForceState::stopped);
  state.force_n = state.held_force_n * state.hold_factor;
  state.torque_nm = state.held_torque_nm * state.hold_factor;
  state.force_state = ForceState::ramping_out;
}

// Returns `last` moved toward `force`, by at most the slew limit.
Vec3 slewed(const DeviceLimits& limits, const Vec3& last, const Vec3& force, double dt_s) noexcept {
  if (!(limits.slew_n_per_s < DeviceLimits::kUnlimited)) return force;
  const Vec3 step = force - last;
  const double maximum = limits.slew_n_per_s * dt_s;
  return norm(step) > maximum ? last + clamp_norm(step, maximum) : force;
}

void ramp_out(const DeviceLimits& limits, const ForceLimiterInput& input, ForceLimiterState& state) noexcept {
  const double step = step_out(limits, input.dt_s);
  state.ramp_factor = state.ramp_factor > step ? state.ramp_factor - step : 0;
  if (!(state.ramp_factor > 0)) return stop(state, ForceState::off);
  const Vec3 last_n = state.force_n;
  const double last_nm = norm(state.torque_nm);
  state.force_n = input.force_n * state.ramp_factor;
  state.torque_nm = clamp_norm(input.torque_nm * state.ramp_factor, last_nm);
  state.force_state = ForceState::ramping_out;
  limit(limits, state);
  const double max_n = std::fmin(norm(state.force_n), norm(last_n));
  state.force_n = clamp_norm(slewed(limits, last_n, state.force_n, input.dt_s), max_n);
}

// Returns the fraction of the input force or torque that was sent in the last tick, at most 1.
double share_of(const Vec3& sent, const Vec3& asked) noexcept {
  const double maximum = norm(asked), length = norm(sent);
  return maximum > length ? length / maximum : 1;
}

void let_through(const DeviceLimits& limits, const ForceLimiterInput& input, ForceLimiterState& state) noexcept {
  // while ramping out, the sent fraction may be below the ramp factor: the chain force may have grown meanwhile
  if (state.force_state == ForceState::ramping_out)
    state.ramp_factor =
        std::fmin(state.ramp_factor, std::fmin(share_of(state.force_n, input.force_n), share_of(state.torque_nm, input.torque_nm)));
  const double left = limits.ramp_in_s > 0 ? state.ramp_factor + input.dt_s / limits.ramp_in_s : 1;
  state.ramp_factor = left < 1 ? left : 1;
  state.force_state = state.ramp_factor < 1 ? ForceState::ramping_in : ForceState::on;
  const Vec3 last_n = state.force_n;
  state.force_n = state.ramp_factor < 1 ? input.force_n * state.ramp_factor : input.force_n;
  state.torque_nm = state.ramp_factor < 1 ? input.torque_nm * state.ramp_factor : input.torque_nm;
  limit(limits, state);
  state.force_n = slewed(limits, last_n, state.force_n, input.dt_s);
}

}  // namespace

Vec3 clamp_norm(const Vec3& v, double max_norm) noexcept {
  const double length = norm(v);
  return length > max_norm ? v * (max_norm / length) : v;
}

void limit_force(const DeviceLimits& limits, const ForceLimiterInput& input, ForceLimiterState& state) noexcept {
  const bool fault = input.condition == TickCondition::no_device || input.condition == TickCondition::watchdog ||
                     !is_finite(input.force_n) || !is_finite(input.torque_nm);
  const bool late = !fault && input.condition == TickCondition::late;
  // the first punctual tick after a hold, or switching forces off during a hold, resumes from the level to which the hold has decayed
  if ((!late || !input.forces_on) && state.late_ticks > 0) {
    if (state.late_ticks > limits.max_late_ticks) state.ramp_factor *= state.hold_factor;
    state.late_ticks = 0;
  }
  if (fault) return stop(state, ForceState::stopped);
  if (!input.forces_on) return ramp_out(limits, input, state);
  if (late) return hold(limits, input.dt_s, state);
  let_through(limits, input, state);
}

}  // namespace catena::haptics
