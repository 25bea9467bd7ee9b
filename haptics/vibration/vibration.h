/// The map from what is felt (peaks.h) to what a controller can do: vibrate with an amplitude, a frequency and for a time.
///   contact and detents   a = min(1, c / full_change),        f = pulse_hz,                          for pulse_s
///   friction              a = max_friction_amplitude min(1, f / full_friction),  f = speed / grain, clamped,  for 1.5 calls, so that none
///   is missing
/// The stronger one is sent; below `least` there is none. A step of `full_change` and a friction of `full_friction` are as strong as they
/// get, and linear below: no curve of perception is claimed.
///
/// VibrationSender says at each of its turns what to ask of the runtime. Every call replaces the one before, so a pulse under way is not
/// cut short by something weaker; friction, which changes all the time, is. Where vibration is not allowed (the session is not focused,
/// the controller is not tracked) it says stop, once, and what was felt meanwhile is forgotten. Any one thread, never the servo's.
#pragma once
#include <cstdint>

#include "haptics/vibration/peak_detector.h"

namespace catena::haptics {

struct Vibration {
  double amplitude = 0;     ///< 0..1
  double frequency_hz = 0;  ///< asked for; runtimes clamp it
  std::int64_t duration_ns = 0;
  bool is_pulse = false;  ///< of a contact or a detent, not of friction
  bool operator==(const Vibration&) const = default;
};

struct VibrationMapping {
  double saturation_change_n = 1.5;
  double saturation_friction_n = 2;
  double max_friction_amplitude = 0.6;  ///< friction lasts: it stays below what a contact may be
  double min_amplitude = 0.02;          ///< of the amplitude
  double pulse_hz = 160;
  double pulse_s = 0.02;
  double grain_m = 5e-4;  ///< of the texture that friction's frequency stands for
  double min_frequency_hz = 40, max_frequency_hz = 250;
};

/// `call_s`: the time between two calls of the sender. Amplitude 0: nothing to feel.
Vibration compute_vibration(const ForcePeaks& peaks, double call_s, const VibrationMapping& map = {}) noexcept;

class VibrationSender {
 public:
  enum class Action { nothing, vibrate, stop };
  struct Command {
    Action action = Action::nothing;
    Vibration vibration{};  ///< of `vibrate`
  };

  explicit VibrationSender(const VibrationMapping& map = {}) : map_(map) {}
  /// `now_ns`: monotonic, not going back. The time since the last call counts as that to the next, of 1 ms to 0.1 s.
  Command next(PeakDetector& peaks, std::int64_t now_ns, bool allowed) noexcept;

 private:
  VibrationMapping map_;
  Vibration current_;
  std::int64_t ends_ns_ = 0, last_ns_ = 0;
  bool was_allowed_ = false;
};

}  // namespace catena::haptics
