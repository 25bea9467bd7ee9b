#include "haptics/chain/indication.h"

#include <cmath>
#include <limits>

namespace catena::haptics {

namespace {

constexpr double kRoundOff = 1e-9;  // a proxy that slips at its limit has reached it
constexpr double kBack = 0.95;      // m below which the link is no longer left

/// A wave of period 1 between -1 and 1, zero at 0 and rising.
double triangle(double phase) noexcept {
  if (!std::isfinite(phase)) return 0;
  const double f = phase + 0.25 - std::floor(phase + 0.25);
  return f < 0.5 ? 4 * f - 1 : 3 - 4 * f;
}

}  // namespace

Vec3 indicate(const Indication& indication, const LinkState& link, const Vec3& gap, double t_s, double dt_s, IndicationState& state,
              exchange::LinkReport& report) noexcept {
  const double at = indication.at > 0 ? indication.at : link.limit;
  const double m = link.released ? 1 : at > 0 ? report.gap / at : 0;
  report.leaving = std::fmin(m, std::numeric_limits<double>::max());
  report.left = link.on && (m >= 1 - kRoundOff || (state.left && m >= kBack));
  if (max_abs(gap) > 0) state.way = direction(gap);

  // a detent on the way out and on the way back
  const bool passes = state.fresh && report.left != state.left;
  state.left = report.left;
  state.fresh = link.on;
  if (!link.on || indication.cue == Indication::Cue::none) {
    state.pulse = 0;
    return Vec3(0.0);
  }
  if (indication.cue == Indication::Cue::detent) {
    if (passes)
      state.pulse = 1;
    else
      state.pulse = std::fmax(0.0, state.pulse - dt_s / indication.duration_s);
    return state.way * (link.weight * indication.amplitude_n * state.pulse);
  }

  // a vibration while it is near leaving
  if (link.released || report.leaving < indication.from) return Vec3(0.0);
  return state.way * (link.weight * indication.amplitude_n * triangle(indication.frequency_hz * t_s));
}

}  // namespace catena::haptics
