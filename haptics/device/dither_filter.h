// SPDX-License-Identifier: MIT
/// Position of the probe from encoders, without their dither while the probe is at rest.
///   moving   x passes unchanged, without delay, until it has stayed within one encoder step of one position for 30 ms
///   at rest  the position is held until x is further than one step from it along one of the device's axes; then x passes in that tick
/// The position that a spring gets is thus up to one step off, which the safe stiffness accounts for (mass_model.h). With a step of 0, x
/// passes bit for bit. Meters, the device's axes. Haptic thread: no allocation, lock or throw.
#pragma once
#include "engine/base/vec.h"

namespace catena::haptics {

/// The filter of one device.
class DitherFilter {
 public:
  DitherFilter(double encoder_step_m, double rate_hz)
      : max_deviation_m_(encoder_step_m * kRounding), ticks_to_rest_(kRestAfter_s * rate_hz) {}

  /// Returns the filtered position of a position that was read; once per tick.
  Vec3 filter(const Vec3& x) noexcept {
    if (!(max_deviation_m_ > 0)) return x;
    const bool near = has_position_ && max_abs(x - held_) <= max_deviation_m_;
    if (!near) {
      held_ = x;
      ticks_near_ = 0;
      has_position_ = true;
      return x;
    }
    if (ticks_near_ < ticks_to_rest_) {
      ++ticks_near_;
      if (!(ticks_near_ < ticks_to_rest_)) held_ = x;
      return x;
    }
    return held_;
  }
  /// Resets the filter after a loss of the device: the next position passes unchanged.
  void reset() noexcept { has_position_ = false; }

 private:
  static constexpr double kRestAfter_s = 0.03, kRounding = 1 + 1e-9;
  double max_deviation_m_, ticks_to_rest_;
  double ticks_near_ = 0;
  Vec3 held_{0.0};
  bool has_position_ = false;
};

}  // namespace catena::haptics
