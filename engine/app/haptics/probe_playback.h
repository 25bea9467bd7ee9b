// SPDX-License-Identifier: MIT
/// The probe in an image: after a probe path, at a time along it, or at rest at the probe position of the scene's cursor.
#pragma once
#include <memory>
#include <string>
#include <vector>

#include "engine/base/csv.h"
#include "engine/base/result.h"
#include "engine/scene/scene.h"
#include "haptics/chain/offline_ticks.h"

namespace catena::app {

/// Samples of a probe path in order of time.
using ProbePath = std::vector<haptics::ProbeSample>;
/// Reads a probe path from a CSV file.
Result<ProbePath> read_probe_samples(const std::string& probe_csv);
/// A path of 500 ticks of 1 ms at rest at the scene's cursor; empty if the scene has no visible cursor.
ProbePath make_resting_path(const scene::Scene& scene);

/// Runs the chain along a probe path, tick by tick, up to the requested time. One thread.
class ProbePlayback {
 public:
  ProbePlayback(std::shared_ptr<const haptics::HapticProgram> program, ProbePath path)
      : program_(std::move(program)), path_(std::move(path)) {}
  /// Writes the haptic state at the fraction `share`, 0 to 1, of the path's duration into the scene's cursor. Seeking backward restarts the
  /// chain. An empty path leaves the cursor unchanged.
  void seek(scene::Scene& scene, double share);

 private:
  std::shared_ptr<const haptics::HapticProgram> program_;
  ProbePath path_;
  std::size_t ticks_done_ = 0;  ///< Number of ticks that were run
  std::unique_ptr<haptics::ChainState> state_;
  std::unique_ptr<haptics::ChainScratch> scratch_;
  haptics::OfflineTicks ticks_;
  HapticState last_state_;
};

/// Converts a probe path as read from a file (engine/base) to samples for the tick (haptics/chain).
inline std::vector<haptics::ProbeSample> to_probe_samples(const std::vector<ProbePathRow>& rows) {
  std::vector<haptics::ProbeSample> samples;
  samples.reserve(rows.size());
  for (const ProbePathRow& row : rows) samples.push_back({row.t_s, row.position, row.buttons, row.orientation});
  return samples;
}

}  // namespace catena::app
