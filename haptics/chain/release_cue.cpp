// SPDX-License-Identifier: MIT
#include "haptics/chain/release_cue.h"

#include <cmath>
#include <limits>

namespace catena::haptics {

namespace {

constexpr double kRoundOff = 1e-9;  // relative; a proxy that slips at its limit counts as having reached it
constexpr double kBack = 0.95;      // release ratio below which the link re-engages (hysteresis)

/// Returns a triangle wave of period 1 between -1 and 1, zero and rising at 0.
double triangle(double phase) noexcept {
  if (!std::isfinite(phase)) return 0;
  const double f = phase + 0.25 - std::floor(phase + 0.25);
  return f < 0.5 ? 4 * f - 1 : 3 - 4 * f;
}

}  // namespace

Vec3 update_release_cue(const ReleaseCue& indication, const LinkState& link, const Vec3& gap, double t_s, double dt_s,
                        ReleaseCueState& state, LinkReport& report) noexcept {
  const double at = indication.distance > 0 ? indication.distance : link.limit;
  const double m = link.released ? 1 : at > 0 ? report.gap / at : 0;
  report.release_ratio = std::fmin(m, std::numeric_limits<double>::max());
  report.released = link.switched_on && (m >= 1 - kRoundOff || (state.released && m >= kBack));
  if (max_abs(gap) > 0) state.direction = direction(gap);

  // detent at release and at re-engagement
  const bool passes = state.initialized && report.released != state.released;
  state.released = report.released;
  state.initialized = link.switched_on;
  if (!link.switched_on || indication.type == ReleaseCue::Type::none) {
    state.pulse_level = 0;
    return Vec3(0.0);
  }
  if (indication.type == ReleaseCue::Type::detent) {
    if (passes)
      state.pulse_level = 1;
    else
      state.pulse_level = std::fmax(0.0, state.pulse_level - dt_s / indication.duration_s);
    return state.direction * (link.weight * indication.amplitude_n * state.pulse_level);
  }

  // vibration near release
  if (link.released || report.release_ratio < indication.onset) return Vec3(0.0);
  return state.direction * (link.weight * indication.amplitude_n * triangle(indication.frequency_hz * t_s));
}

}  // namespace catena::haptics
