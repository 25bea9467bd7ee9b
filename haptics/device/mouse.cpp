#include "haptics/device/mouse.h"

#include <cmath>

#include "engine/base/result.h"

namespace catena::haptics {

DeviceCapabilities MouseDevice::nominal() {
  DeviceCapabilities out;
  out.name = "mouse";
  out.has_orientation = true;
  out.buttons = 3;
  return out;
}

MouseDevice::MouseDevice(const Vec3& start_m, const MouseParameters& parameters) : capabilities_(nominal()), position_m_(start_m) {
  CATENA_ASSERT(is_finite(start_m) && parameters.rate_hz > 0 && parameters.smoothing_s >= 0);
  share_ = parameters.smoothing_s > 0 ? -std::expm1(-1 / (parameters.rate_hz * parameters.smoothing_s)) : 1;
  newest_.position_m = start_m;
}

void MouseDevice::move_to(const Vec3& position_m, std::uint32_t buttons, const Quat& orientation) {
  if (!is_finite(position_m) || !is_finite(orientation)) return;
  poses_.publish({position_m, orientation, buttons});
}

DeviceInput MouseDevice::read() noexcept {
  if (poses_.take()) newest_ = poses_.front();
  const Vec3 left = newest_.position_m - position_m_;
  // the last nanometre at once: the hand comes to rest, bit for bit
  position_m_ = share_ < 1 && max_abs(left) > 1e-9 ? position_m_ + share_ * left : newest_.position_m;
  if (orientation_ != newest_.orientation) {
    const Vec3 turn = rotation_vector(normalised(newest_.orientation * glm::conjugate(orientation_)));
    const bool eases = share_ < 1 && max_abs(turn) > 1e-9;
    orientation_ = eases ? normalised(rotation_of(share_ * turn) * orientation_) : newest_.orientation;
  }
  DeviceInput input;
  input.position_m = position_m_;
  input.orientation = orientation_;
  input.buttons = newest_.buttons;
  return input;
}

}  // namespace catena::haptics
