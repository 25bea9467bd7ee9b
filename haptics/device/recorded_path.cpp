#include "haptics/device/recorded_path.h"

#include "engine/base/assert.h"

namespace catena::haptics {

RecordedPath::RecordedPath(std::vector<Sample> samples) : samples_(std::move(samples)), capabilities_{.name = "recorded path"} {
  CATENA_ASSERT(!samples_.empty());
}

DeviceInput RecordedPath::read() noexcept {
  const Sample& sample = samples_[next_];
  if (next_ + 1 < samples_.size()) ++next_;
  DeviceInput input;
  input.position_m = sample.position;
  input.buttons = sample.buttons;
  input.recorded = true;
  input.t_s = sample.t_s;
  return input;
}

}  // namespace catena::haptics
