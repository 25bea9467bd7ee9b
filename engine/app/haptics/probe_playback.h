/// The hand in a picture: where it is after a probe path, at a time along it, or at rest at the probe that the scene's cursor names.
#pragma once
#include <memory>
#include <string>
#include <vector>

#include "engine/base/csv.h"
#include "engine/base/result.h"
#include "engine/scene/scene.h"
#include "haptics/chain/tick.h"

namespace catena::app {

using ProbePath = std::vector<haptics::ProbeSample>;
Result<ProbePath> read_probe_samples(const std::string& probe_csv);
/// Rest at the scene's own cursor, if it has one and shows it, else empty.
ProbePath make_resting_path(const scene::Scene& scene);

/// Runs the chain along a path, tick by tick, as far as a picture wants it.
class ProbePlayback {
 public:
  ProbePlayback(std::shared_ptr<const haptics::HapticProgram> program, ProbePath path)
      : program_(std::move(program)), path_(std::move(path)) {}
  /// Writes the tick at that share of the path's time, 0 to 1, into the scene's cursor. An earlier one than before begins anew. An empty
  /// path leaves the cursor as it is.
  void seek(scene::Scene& scene, double share);

 private:
  std::shared_ptr<const haptics::HapticProgram> program_;
  ProbePath path_;
  std::size_t ticks_done_ = 0;  ///< ticks that were run
  std::unique_ptr<haptics::ChainState> state_;
  std::unique_ptr<haptics::ChainScratch> scratch_;
  HapticState last_state_;
};

/// A probe path as read (engine/base) as the tick takes it (haptics/chain).
inline std::vector<haptics::ProbeSample> to_probe_samples(const std::vector<ProbePathRow>& rows) {
  std::vector<haptics::ProbeSample> samples;
  samples.reserve(rows.size());
  for (const ProbePathRow& row : rows) samples.push_back({row.t_s, row.position, row.buttons, row.orientation});
  return samples;
}

}  // namespace catena::app
