/// A probe path as read (engine/base) as the tick takes it (haptics/chain).
#pragma once
#include <vector>

#include "engine/base/csv_paths.h"
#include "haptics/chain/tick.h"

namespace catena::app {

inline std::vector<haptics::ProbeSample> probe_samples(const std::vector<ProbeRow>& rows) {
  std::vector<haptics::ProbeSample> samples;
  samples.reserve(rows.size());
  for (const ProbeRow& row : rows) samples.push_back({row.t_s, row.position, row.buttons, row.orientation});
  return samples;
}

}  // namespace catena::app
