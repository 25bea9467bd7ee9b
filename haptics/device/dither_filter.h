/// The position of a hand from encoders, without their dither while the hand rests.
///   moving   x passes as it is, without delay, until it has stayed within one encoder step of one place for 30 ms
///   resting  the place is held until x is further than one step from it along one of the device's axes; then x passes in that very tick
/// What a spring sees is thus up to one step off, which the safe stiffness counts (mechanism.h). A step of 0: x passes to the bit.
/// Metres, the device's axes. Haptic thread: no allocation, lock or throw.
#pragma once
#include "engine/base/vec.h"

namespace catena::haptics {

class DitherFilter {
 public:
  DitherFilter(double encoder_step_m, double rate_hz)
      : max_deviation_m_(encoder_step_m * kRounding), ticks_to_rest_(kRestAfter_s * rate_hz) {}

  /// The position to use for one that was read.
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
  /// After a loss of the device: the next position is taken as it is.
  void reset() noexcept { has_position_ = false; }

 private:
  static constexpr double kRestAfter_s = 0.03, kRounding = 1 + 1e-9;
  double max_deviation_m_, ticks_to_rest_;
  double ticks_near_ = 0;
  Vec3 held_{0.0};
  bool has_position_ = false;
};

}  // namespace catena::haptics
