// SPDX-License-Identifier: MIT
#include "haptics/device/mouse.h"

namespace catena::haptics {

DeviceCapabilities MouseDevice::nominal_capabilities() {
  DeviceCapabilities out;
  out.name = "mouse";
  out.has_orientation = true;
  out.button_count = 3;
  return out;
}

MouseDevice::MouseDevice(const Vec3& start_m, const MouseParameters& parameters)
    : capabilities_(nominal_capabilities()), filter_(start_m, parameters.smoothing_s, parameters.rate_hz) {
  latest_pose_.position_m = start_m;
}

void MouseDevice::move_to(const Vec3& position_m, std::uint32_t buttons, const Quat& orientation) {
  if (!is_finite(position_m) || !is_finite(orientation)) return;
  poses_.publish({position_m, orientation, buttons});
}

DeviceInput MouseDevice::read() noexcept {
  if (poses_.acquire()) latest_pose_ = poses_.front();
  filter_.step_toward(latest_pose_.position_m, latest_pose_.orientation);
  DeviceInput input;
  input.position_m = filter_.position_m();
  input.orientation = filter_.orientation();
  input.buttons = latest_pose_.buttons;
  return input;
}

}  // namespace catena::haptics
