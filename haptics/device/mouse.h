/// Mouse and keyboard as a haptic device without force output: the frame writes where the hand is and how it is turned, the servo
/// reads it each tick through a triple buffer, so that a slow picture never delays a tick; the hand then stays where it was.
/// ProbeMotion is eased (eased_pose.h), because a picture's 60 Hz steps would otherwise reach the tick as jumps.
#pragma once
#include "engine/base/triple_buffer.h"
#include "haptics/device/pose_filter.h"

namespace catena::haptics {

struct MouseParameters {
  double smoothing_s = 0.02;  ///< 0: none
  double rate_hz = 1000;      ///< of the servo that reads it
};

class MouseDevice final : public Device {
 public:
  explicit MouseDevice(const Vec3& start_m, const MouseParameters& parameters = {});

  /// Frame thread. Metres, the device's own axes. A pose that is not finite is ignored.
  void move_to(const Vec3& position_m, std::uint32_t buttons, const Quat& orientation = kIdentityRotation);

  // haptic thread
  const DeviceCapabilities& capabilities() const override { return capabilities_; }
  DeviceInput read() noexcept override;
  void write(const DeviceOutput&) noexcept override {}  ///< a mouse cannot push: the force is drawn

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
