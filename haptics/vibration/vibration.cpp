// SPDX-License-Identifier: MIT
#include "haptics/vibration/vibration.h"

#include <algorithm>
#include <utility>

namespace catena::haptics {
namespace {

constexpr double kShortestCallS = 1e-3, kLongestCallS = 0.1;
constexpr double kFrictionCalls = 1.5;  // duration of the vibration in calls: a call that is a little late leaves no gap

std::int64_t nanoseconds(double s) noexcept { return static_cast<std::int64_t>(1e9 * s); }

}  // namespace

Vibration compute_vibration(const ForcePeaks& peaks, double call_s, const VibrationMapping& map) noexcept {
  const double pulse = std::min(1.0, peaks.change_n / map.saturation_change_n);
  const double rubs = map.max_friction_amplitude * std::min(1.0, peaks.friction_n / map.saturation_friction_n);
  if (!(std::max(pulse, rubs) >= map.min_amplitude)) return {};
  if (pulse >= rubs) return {pulse, map.pulse_hz, nanoseconds(map.pulse_s), true};
  return {rubs, std::clamp(peaks.speed_m_per_s / map.grain_m, map.min_frequency_hz, map.max_frequency_hz),
          nanoseconds(kFrictionCalls * call_s), false};
}

VibrationSender::Command VibrationSender::next(PeakDetector& peaks, std::int64_t now_ns, bool allowed) noexcept {
  const ForcePeaks peaks_in_period = peaks.take_peaks();
  if (!allowed) {
    const bool stops = was_allowed_;
    was_allowed_ = false;
    current_ = {};
    return {stops ? Action::stop : Action::nothing, {}};
  }
  const bool began = !was_allowed_;
  was_allowed_ = true;
  const double since_s = 1e-9 * static_cast<double>(now_ns - std::exchange(last_ns_, now_ns));
  if (began) return {};  // discards values accumulated before vibration was allowed
  const Vibration requested = compute_vibration(peaks_in_period, std::clamp(since_s, kShortestCallS, kLongestCallS), map_);
  const bool pulse_lasts = current_.is_pulse && now_ns < ends_ns_;
  if (!(requested.amplitude > 0) || (pulse_lasts && requested.amplitude < current_.amplitude)) return {};
  current_ = requested;
  ends_ns_ = now_ns + requested.duration_ns;
  return {Action::vibrate, requested};
}

}  // namespace catena::haptics
