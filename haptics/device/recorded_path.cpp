// SPDX-License-Identifier: MIT
#include "haptics/device/recorded_path.h"

#include "engine/base/csv.h"
#include "engine/base/result.h"

namespace catena::haptics {

RecordedPath::RecordedPath(std::vector<Sample> samples, bool has_orientation) : samples_(std::move(samples)) {
  CATENA_ASSERT(!samples_.empty());
  capabilities_.name = "recorded path";
  capabilities_.has_orientation = has_orientation;
  capabilities_.button_count = 32;
}

Result<std::unique_ptr<Device>> RecordedPath::open(const std::string& path) {
  CATENA_TRY(const std::vector<ProbePathRow> rows, read_probe_path(path));
  std::vector<Sample> samples;
  samples.reserve(rows.size());
  for (const ProbePathRow& row : rows) samples.push_back({row.t_s, row.position, row.buttons, row.orientation});
  return std::unique_ptr<Device>(std::make_unique<RecordedPath>(std::move(samples), rows.front().has_orientation));
}

DeviceInput RecordedPath::read() noexcept {
  const Sample& sample = samples_[next_];
  if (next_ + 1 < samples_.size()) ++next_;
  DeviceInput input;
  input.position_m = sample.position;
  input.orientation = sample.orientation;
  input.buttons = sample.buttons;
  input.is_recorded = true;
  input.t_s = sample.t_s;
  return input;
}

}  // namespace catena::haptics
