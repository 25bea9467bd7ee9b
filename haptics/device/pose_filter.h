// SPDX-License-Identifier: MIT
/// Low-pass filter of a pose: input that arrives in steps (frames at 60 Hz, a tracker's samples) reaches the tick without jumps.
///   x += (target - x) (1 - exp(-dt / smoothing)),  the same fraction of the remaining rotation, at the tick rate
/// It comes to rest on the target, bit for bit. Haptic thread: no allocation, lock or throw.
#pragma once
#include "haptics/device/device.h"

namespace catena::haptics {

/// The filter and its current pose, meters.
class PoseFilter {
 public:
  /// `smoothing_s`: time constant; 0: none, the target is reached at once.
  PoseFilter(const Vec3& start_m, double smoothing_s, double rate_hz);

  /// Advances one tick towards the target.
  void step_toward(const Vec3& target_m, const Quat& target) noexcept;
  /// Sets the pose without filtering.
  void reset(const Vec3& position_m, const Quat& orientation) noexcept {
    position_m_ = position_m;
    orientation_ = orientation;
  }
  const Vec3& position_m() const noexcept { return position_m_; }
  const Quat& orientation() const noexcept { return orientation_; }

 private:
  double gain_;  ///< fraction of the remaining distance covered per tick
  Vec3 position_m_;
  Quat orientation_{kIdentityRotation};
};

}  // namespace catena::haptics
