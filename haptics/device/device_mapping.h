/// The way from the device to the hand: any device, with what its settings say of encoders, axes, scale, clutch, gravity and switch.
///   in:   x_d without the dither of a hand that rests (still_pose.h);  x = s A x_d + o,   q = q_o A q_d      A: hand axes from device
///   axes;  s: metres of hand per metre of device out:  F_d = A^T F + g,   torque_d = A^T q_o^-1 torque      g: carries the grip, device
///   axes
/// Clutch: while its button is held the probe rests and the forces are off; on release o and q_o keep the difference, and the guard
/// ramps the forces in. Force switch: off at the start and after a loss of the device; each press that is seen turns it over. Both
/// buttons are masked: the scene does not see them.
/// The force is not scaled, so that newtons of the scene are newtons of the hand; a spring K of the scene is then s K at the device.
/// For that reason limits are made of the mechanism as the hand's metres have it (resolve_mechanics in haptics/servo/device_limits.h), so
/// that K <= 2 b / T holds at the device. Energy of the hand's metres is s times the device's: passive stays passive. g rises over 0.1 s
/// where the forces are on, and is gone at once where they are off (clutch, switch, fault, device not ready) and without a read before the
/// write: the last zero on the way out stays zero. A recorded path keeps its own pose. What the settings leave alone passes to the bit.
/// Threads as the device's own.
#pragma once
#include <memory>

#include "haptics/device/device_settings.h"
#include "haptics/device/dither_filter.h"

namespace catena::haptics {

/// True where a device needs no map.
bool is_identity_mapping(const DeviceCapabilities& device, const DeviceSettings& settings);

class MappedDevice final : public Device {
 public:
  MappedDevice(std::unique_ptr<Device> device, const DeviceSettings& settings);

  const DeviceCapabilities& capabilities() const override { return capabilities_; }
  DeviceInput read() noexcept override;
  void write(const DeviceOutput& output) noexcept override;
  std::string status_text() const override { return device_->status_text(); }
  void stop() noexcept override { device_->stop(); }
  bool zero_force_confirmed() const noexcept override { return device_->zero_force_confirmed(); }
  void resume() noexcept override { device_->resume(); }
  Outcome check_output_files() const override { return device_->check_output_files(); }

 private:
  void map_pose(DeviceInput& input, bool rests) noexcept;

  std::unique_ptr<Device> device_;
  DeviceCapabilities capabilities_;
  Mat3 workspace_from_device_;
  Quat rotation_;
  double scale_;
  DitherFilter dither_filter_;
  std::uint32_t clutch_mask_, force_mask_;
  Vec3 gravity_n_;
  double gravity_step_;  ///< of its weight, a tick
  bool has_rotation_;

  // haptic thread
  Vec3 offset_m_{0.0}, rest_m_{0.0};
  Quat offset_rotation_{kIdentityRotation}, rest_rotation_{kIdentityRotation};
  bool has_offset_ = false;
  std::uint32_t last_buttons_ = 0;
  bool has_read_ = false, has_buttons_ = false, switched_on_ = false;
  bool has_fresh_pose_ = false;  ///< a good pose was read since the last write
  bool forces_on_ = false;
  double gravity_weight_ = 0;
};

/// The device itself where the settings change nothing.
std::unique_ptr<Device> with_device_mapping(std::unique_ptr<Device> device, const DeviceSettings& settings);

}  // namespace catena::haptics
