#include "haptics/device/mouse.h"

#include <cmath>

#include "engine/base/assert.h"

namespace catena::haptics {

static_assert(std::atomic<unsigned>::is_always_lock_free);

MouseDevice::MouseDevice(const Vec3& start_m, const MouseParameters& parameters) : capabilities_{.name = "mouse"}, position_m_(start_m) {
  CATENA_ASSERT(is_finite(start_m) && parameters.rate_hz > 0 && parameters.smoothing_s >= 0);
  share_ = parameters.smoothing_s > 0 ? -std::expm1(-1 / (parameters.rate_hz * parameters.smoothing_s)) : 1;
  for (Slot& slot : slots_) slot.position_m = start_m;
}

void MouseDevice::move_to(const Vec3& position_m, std::uint32_t buttons) {
  if (!is_finite(position_m)) return;
  slots_[back_] = {position_m, buttons};
  back_ = middle_.exchange(back_ | kFresh, std::memory_order_acq_rel) & kIndex;
}

DeviceInput MouseDevice::read() noexcept {
  if ((middle_.load(std::memory_order_relaxed) & kFresh) != 0) front_ = middle_.exchange(front_, std::memory_order_acq_rel) & kIndex;
  const Slot& newest = slots_[front_];
  const Vec3 left = newest.position_m - position_m_;
  // the last nanometre at once: the hand comes to rest, bit for bit
  position_m_ = share_ < 1 && max_abs(left) > 1e-9 ? position_m_ + share_ * left : newest.position_m;
  DeviceInput input;
  input.position_m = position_m_;
  input.buttons = newest.buttons;
  return input;
}

}  // namespace catena::haptics
