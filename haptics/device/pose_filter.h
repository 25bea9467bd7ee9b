/// A pose that follows another without jumping: what arrives in steps (a picture's 60 Hz, a tracker's samples) reaches the tick eased.
///   x += (target - x) (1 - exp(-dt / smoothing)),  the same share of the rotation that is left, at 1 / rate
/// It comes to rest on the target, bit for bit. Haptic thread: no allocation, lock or throw.
#pragma once
#include "haptics/device/device.h"

namespace catena::haptics {

class PoseFilter {
 public:
  /// `smoothing_s` 0: none, the target at once.
  PoseFilter(const Vec3& start_m, double smoothing_s, double rate_hz);

  /// One tick on the way.
  void step_toward(const Vec3& target_m, const Quat& target) noexcept;
  /// There at once.
  void reset(const Vec3& position_m, const Quat& orientation) noexcept {
    position_m_ = position_m;
    orientation_ = orientation;
  }
  const Vec3& position_m() const noexcept { return position_m_; }
  const Quat& orientation() const noexcept { return orientation_; }

 private:
  double gain_;  ///< of the way to the target that one tick covers
  Vec3 position_m_;
  Quat orientation_{kIdentityRotation};
};

}  // namespace catena::haptics
