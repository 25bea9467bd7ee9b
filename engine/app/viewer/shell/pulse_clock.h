/// PulseClock moves the scene's phase as time goes by: pulses run along streamlines while somebody looks. Pure logic: the time is told.
#pragma once
#include <cmath>
#include <cstdint>
#include <optional>

namespace catena::app {

class PulseClock {
 public:
  static constexpr double kTurnsPerS = 0.5;
  static constexpr double kStepS = 0.04;  ///< no more than 25 new pictures a second for pulses alone

  /// The phase (0 to 1) to draw now; nothing where it has not moved. While not `running` time does not count.
  std::optional<double> advance(std::int64_t now_ns, bool running, double phase) {
    const std::optional<std::int64_t> before = last_ns_;
    if (!running || !before) {
      last_ns_ = running ? std::optional(now_ns) : std::nullopt;
      return std::nullopt;
    }
    const double s = 1e-9 * static_cast<double>(now_ns - *before);
    if (s < kStepS) return std::nullopt;
    last_ns_ = now_ns;
    const double next = phase + kTurnsPerS * s;
    return next - std::floor(next);
  }

 private:
  std::optional<std::int64_t> last_ns_;  ///< of the last step; none: it stands
};

}  // namespace catena::app
