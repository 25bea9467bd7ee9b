#include "haptics/device/mouse.h"

namespace catena::haptics {

DeviceCapabilities MouseDevice::nominal() {
  DeviceCapabilities out;
  out.name = "mouse";
  out.has_orientation = true;
  out.buttons = 3;
  return out;
}

MouseDevice::MouseDevice(const Vec3& start_m, const MouseParameters& parameters)
    : capabilities_(nominal()), eased_(start_m, parameters.smoothing_s, parameters.rate_hz) {
  newest_.position_m = start_m;
}

void MouseDevice::move_to(const Vec3& position_m, std::uint32_t buttons, const Quat& orientation) {
  if (!is_finite(position_m) || !is_finite(orientation)) return;
  poses_.publish({position_m, orientation, buttons});
}

DeviceInput MouseDevice::read() noexcept {
  if (poses_.take()) newest_ = poses_.front();
  eased_.follow(newest_.position_m, newest_.orientation);
  DeviceInput input;
  input.position_m = eased_.position_m();
  input.orientation = eased_.orientation();
  input.buttons = newest_.buttons;
  return input;
}

}  // namespace catena::haptics
