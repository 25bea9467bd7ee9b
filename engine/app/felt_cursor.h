/// The hand in a picture: where it is after a probe path, at a time along it, or at rest at the probe that the scene's cursor names.
#pragma once
#include <memory>
#include <string>
#include <vector>

#include "engine/base/result.h"
#include "engine/scene/scene.h"
#include "haptics/chain/tick.h"

namespace catena::app {

/// Runs the chain along a path, tick by tick, as far as a picture wants it.
class FeltPath {
 public:
  /// `probe_csv`, or, if empty, rest at the scene's own cursor, if it has one and shows it; without either the path is empty.
  static Result<FeltPath> make(const scene::Scene& scene, std::shared_ptr<const haptics::Program> program, const std::string& probe_csv);
  bool empty() const { return path_.empty(); }
  /// Writes the tick at that share of the path's time, 0 to 1, into the scene's cursor and widgets. An earlier one than before begins anew.
  void show(scene::Scene& scene, double share);

 private:
  std::shared_ptr<const haptics::Program> program_;
  std::vector<haptics::ProbeSample> path_;
  std::size_t done_ = 0;  ///< ticks that were run
  std::unique_ptr<haptics::ChainState> state_;
  std::unique_ptr<haptics::ChainScratch> scratch_;
  exchange::HapticState last_;
};

}  // namespace catena::app
