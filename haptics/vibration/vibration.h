// SPDX-License-Identifier: MIT
/// Maps the peaks of the force (peak_detector.h) to vibrations of a controller, each with an amplitude a, a frequency and a duration.
///   contact and detents   a = min(1, c / saturation_change_n), frequency pulse_hz, for pulse_s
///   friction              a = max_friction_amplitude min(1, f / saturation_friction_n), frequency speed / grain_m, clamped, for 1.5 call
///                         intervals, so that there is no gap
/// The stronger one is sent; below min_amplitude there is none. The mapping is linear up to the saturation values: it does not model
/// perception.
///
/// VibrationSender returns at each call the command for the runtime. Every command replaces the one before, so a pulse in progress is
/// continued rather than replaced by a weaker vibration; a friction vibration, which changes all the time, is always replaced. Where
/// vibration is not allowed (the session is not focused, the controller is not tracked) the command is `stop`, one time, and the peaks of
/// that time are discarded. Any one thread but the servo's.
#pragma once
#include <cstdint>

#include "haptics/vibration/peak_detector.h"

namespace catena::haptics {

/// One vibration of a controller.
struct Vibration {
  double amplitude = 0;          ///< 0..1; 0: none
  double frequency_hz = 0;       ///< requested frequency; runtimes clamp it
  std::int64_t duration_ns = 0;  ///< duration, nanoseconds
  bool is_pulse = false;         ///< caused by a contact or a detent, not by friction
  bool operator==(const Vibration&) const = default;
};

/// Parameters of the mapping.
struct VibrationMapping {
  double saturation_change_n = 1.5;     ///< change of force with amplitude 1
  double saturation_friction_n = 2;     ///< friction with amplitude max_friction_amplitude
  double max_friction_amplitude = 0.6;  ///< maximum amplitude of friction: since it lasts, it stays below that of a contact
  double min_amplitude = 0.02;          ///< amplitude below which no vibration is sent
  double pulse_hz = 160;                ///< frequency of a pulse
  double pulse_s = 0.02;                ///< duration of a pulse
  double grain_m = 5e-4;                ///< grain of the texture that the frequency of friction represents, meters
  double min_frequency_hz = 40, max_frequency_hz = 250;  ///< range of the frequency of friction
};

/// Returns the vibration for the peaks; amplitude 0: none. `call_s`: time between two calls of the sender, seconds.
Vibration compute_vibration(const ForcePeaks& peaks, double call_s, const VibrationMapping& map = {}) noexcept;

/// Chooses the vibrations to send to a controller. One thread.
class VibrationSender {
 public:
  /// Action of the caller: leave the present vibration as it is, start a vibration, stop vibrating.
  enum class Action { nothing, vibrate, stop };
  /// Command for the runtime.
  struct Command {
    Action action = Action::nothing;  ///< action of the caller
    Vibration vibration{};            ///< vibration to start, with `vibrate`
  };

  /// Creates a sender with these parameters.
  explicit VibrationSender(const VibrationMapping& map = {}) : map_(map) {}
  /// Takes the peaks and returns the command for them. `now_ns`: monotonic time. `allowed`: the controller may vibrate. The time since the
  /// last call, clamped to 1 ms .. 0.1 s, is the estimate of the time until the next.
  Command next(PeakDetector& peaks, std::int64_t now_ns, bool allowed) noexcept;

 private:
  VibrationMapping map_;
  Vibration current_;
  std::int64_t ends_ns_ = 0, last_ns_ = 0;
  bool was_allowed_ = false;
};

}  // namespace catena::haptics
