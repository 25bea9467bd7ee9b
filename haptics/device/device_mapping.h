// SPDX-License-Identifier: MIT
/// Mapping between any device and the workspace, by the device settings: encoder dither, axes, scale, clutch, gravity and force switch.
///   in:   x_d after the dither filter (dither_filter.h);  x = s A x_d + o,   q = q_o A q_d
///         A: workspace axes from device axes;  s: meters of probe travel per meter of device travel;  o, q_o: clutch offset
///   out:  F_d = A^T F + g,   torque_d = A^T q_o^-1 torque      g: compensates the weight of the grip, device axes
/// Clutch: while its button is held the probe rests and the forces are off; on release o and q_o keep the difference, and the force limiter
/// ramps the forces in. Force switch: off at the start and after a loss of the device; each press toggles it. Both buttons are masked
/// out of the buttons that the scene gets.
/// The force is not scaled, so that a newton of the scene is a newton at the device; a spring K of the scene is then s K at the device.
/// Therefore the limits are computed from the mechanism in meters of probe travel, device scale applied (resolve_mechanics in
/// haptics/servo/device_limits.h), so that K <= 2 b / T holds at the device. Energy in meters of probe travel is s times that of the
/// device: passive stays passive. g ramps in over 0.1 s while the forces are on, and is zero at once where they are off (clutch, switch,
/// fault, device not ready) and where no read precedes the write: the last zero at the end stays zero. A recorded path keeps its own pose.
/// Whatever the settings do not change passes through bit for bit. Threads: as the device's own.
#pragma once
#include <memory>

#include "haptics/device/device_settings.h"
#include "haptics/device/dither_filter.h"

namespace catena::haptics {

/// Returns true if the device needs no mapping: no encoder step, and all mapping settings at their defaults.
bool is_identity_mapping(const DeviceCapabilities& device, const DeviceSettings& settings);

/// A device with the mapping applied; owns the device.
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
  double gravity_step_;  ///< increase of gravity_weight_ per tick
  bool has_rotation_;

  // haptic thread
  Vec3 offset_m_{0.0}, rest_m_{0.0};
  Quat offset_rotation_{kIdentityRotation}, rest_rotation_{kIdentityRotation};
  bool has_offset_ = false;
  std::uint32_t last_buttons_ = 0;
  bool has_read_ = false, has_buttons_ = false, switched_on_ = false;
  bool has_fresh_pose_ = false;  ///< a valid pose was read since the last write
  bool forces_on_ = false;
  double gravity_weight_ = 0;
};

/// Returns the device itself if the settings change nothing, else a MappedDevice around it.
std::unique_ptr<Device> with_device_mapping(std::unique_ptr<Device> device, const DeviceSettings& settings);

}  // namespace catena::haptics
