// SPDX-License-Identifier: MIT
/// Mouse and keyboard as a haptic device without force output: the frame thread writes position and orientation of the probe, the servo
/// reads them each tick through a triple buffer, so that a slow frame never delays a tick; the probe then rests.
/// The motion is low-pass filtered (pose_filter.h), because the steps of a 60 Hz display would otherwise reach the tick as jumps.
#pragma once
#include "engine/base/triple_buffer.h"
#include "haptics/device/pose_filter.h"

namespace catena::haptics {

/// Parameters of a MouseDevice.
struct MouseParameters {
  double smoothing_s = 0.02;  ///< time constant of the low-pass filter; 0: none
  double rate_hz = 1000;      ///< tick rate of the servo that reads it
};

/// The device. move_to: frame thread; read and write: haptic thread.
class MouseDevice final : public Device {
 public:
  explicit MouseDevice(const Vec3& start_m, const MouseParameters& parameters = {});

  /// Sets the target pose. Frame thread. Meters, the device's own axes. A pose that is not finite is ignored.
  void move_to(const Vec3& position_m, std::uint32_t buttons, const Quat& orientation = kIdentityRotation);

  // haptic thread
  const DeviceCapabilities& capabilities() const override { return capabilities_; }
  DeviceInput read() noexcept override;
  void write(const DeviceOutput&) noexcept override {}  ///< no force output: the force is only rendered

  static DeviceCapabilities nominal_capabilities();

 private:
  struct Pose {
    Vec3 position_m{0.0};
    Quat orientation{kIdentityRotation};
    std::uint32_t buttons = 0;
  };

  DeviceCapabilities capabilities_;
  TripleBuffer<Pose> poses_;

  // haptic thread
  Pose latest_pose_;
  PoseFilter filter_;
};

}  // namespace catena::haptics
