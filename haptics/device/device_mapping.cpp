// SPDX-License-Identifier: MIT
#include "haptics/device/device_mapping.h"

#include <algorithm>

#include "engine/base/result.h"

namespace catena::haptics {
namespace {

constexpr double kGravityRamp_s = 0.1;

double encoder_step_m(const DeviceCapabilities& device, const DeviceSettings& settings) {
  return settings.encoder_step_m.value_or(device.mechanics.encoder_step_m);
}

std::uint32_t mask_of(int button) { return button > 0 ? 1u << (button - 1) : 0u; }

DeviceCapabilities mapped(DeviceCapabilities device, const DeviceSettings& settings, bool turns) {
  if (turns) device.workspace_center_m = settings.workspace_from_device * device.workspace_center_m;
  if (settings.scale != 1) {
    device.workspace_center_m *= settings.scale;
    device.workspace_m *= settings.scale;
  }
  return device;
}

}  // namespace

bool is_identity_mapping(const DeviceCapabilities& device, const DeviceSettings& settings) {
  return !(encoder_step_m(device, settings) > 0) && settings.workspace_from_device == Mat3(1.0) && settings.scale == 1 &&
         settings.clutch_button == 0 && settings.force_button == 0 && settings.gravity_n == Vec3(0.0);
}

std::unique_ptr<Device> with_device_mapping(std::unique_ptr<Device> device, const DeviceSettings& settings) {
  if (is_identity_mapping(device->capabilities(), settings)) return device;
  return std::make_unique<MappedDevice>(std::move(device), settings);
}

MappedDevice::MappedDevice(std::unique_ptr<Device> device, const DeviceSettings& settings)
    : device_(std::move(device)),
      workspace_from_device_(settings.workspace_from_device),
      rotation_(normalized(glm::quat_cast(settings.workspace_from_device))),
      scale_(settings.scale),
      dither_filter_(encoder_step_m(device_->capabilities(), settings), settings.rate_hz),
      clutch_mask_(mask_of(settings.clutch_button)),
      force_mask_(mask_of(settings.force_button)),
      gravity_n_(settings.gravity_n),
      gravity_step_(std::min(1.0, 1 / (kGravityRamp_s * settings.rate_hz))),
      has_rotation_(settings.workspace_from_device != Mat3(1.0)) {
  CATENA_ASSERT(device_ != nullptr && settings.scale > 0 && settings.rate_hz > 0);
  capabilities_ = mapped(device_->capabilities(), settings, has_rotation_);
}

// Maps a pose. Parts of the mapping that are not set are skipped, so that the values remain bitwise equal.
void MappedDevice::map_pose(DeviceInput& input, bool rests) noexcept {
  if (has_rotation_) input.position_m = workspace_from_device_ * input.position_m;
  if (scale_ != 1) input.position_m *= scale_;
  if (has_rotation_ && capabilities_.has_orientation) input.orientation = rotation_ * input.orientation;

  // clutch: the position is frozen while it is pressed; the offset remains when it is released
  if (rests) {
    offset_m_ = rest_m_ - input.position_m;
    if (capabilities_.has_orientation) offset_rotation_ = normalized(rest_rotation_ * glm::conjugate(input.orientation));
    has_offset_ = true;
    input.position_m = rest_m_;
    input.orientation = rest_rotation_;
  } else if (has_offset_) {
    input.position_m += offset_m_;
    if (capabilities_.has_orientation) input.orientation = normalized(offset_rotation_ * input.orientation);
  }
  rest_m_ = input.position_m;
  rest_rotation_ = input.orientation;
}

DeviceInput MappedDevice::read() noexcept {
  DeviceInput input = device_->read();
  const bool ready = input.status == DeviceStatus::ready && is_finite(input.position_m) && is_finite(input.orientation);
  const bool clutches = (input.buttons & clutch_mask_) != 0;
  if (ready) {
    const std::uint32_t pressed = has_buttons_ ? input.buttons & ~last_buttons_ : 0u;
    if ((pressed & force_mask_) != 0) switched_on_ = !switched_on_;
    if (!input.is_recorded) {
      input.position_m = dither_filter_.filter(input.position_m);
      map_pose(input, clutches && has_read_);
    }
    last_buttons_ = input.buttons;
    has_read_ = has_buttons_ = true;
  } else {
    switched_on_ = has_buttons_ = false;
    dither_filter_.reset();
  }
  input.forces_on = input.forces_on && !clutches && (force_mask_ == 0 || switched_on_);
  input.buttons &= ~(clutch_mask_ | force_mask_);
  forces_on_ = input.forces_on;
  has_fresh_pose_ = ready;
  return input;
}

void MappedDevice::write(const DeviceOutput& output) noexcept {
  DeviceOutput out = output;
  if (has_offset_ && capabilities_.has_orientation) out.torque_nm = rotate(glm::conjugate(offset_rotation_), out.torque_nm);
  if (has_rotation_) {
    out.force_n = out.force_n * workspace_from_device_;  // v A = A^T v
    out.torque_nm = out.torque_nm * workspace_from_device_;
  }
  if (gravity_n_ != Vec3(0.0)) {
    const bool carries = has_fresh_pose_ && forces_on_ && output.forces_active;
    gravity_weight_ = carries ? std::min(1.0, gravity_weight_ + gravity_step_) : 0;
    out.force_n += gravity_n_ * gravity_weight_;
  }
  if (scale_ != 1) out.accounted_j /= scale_;
  has_fresh_pose_ = false;
  device_->write(out);
}

}  // namespace catena::haptics
