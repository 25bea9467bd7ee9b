/// What the figures of `catena tradeoff` share: the hand of a scene written as text.
#pragma once
#include <memory>
#include <string>
#include <string_view>

#include "engine/app/tuning/report/results_dir.h"
#include "engine/base/result.h"
#include "haptics/chain/tick.h"

namespace catena::app {

/// A scene written as text and the hand that feels it: the very tick of `replay`, step by step.
class TickSimulation {
 public:
  /// The text is ours: a mistake in it is a bug.
  explicit TickSimulation(const std::string& scene);
  const HapticState& step(double t_s, const Vec3& probe) {
    haptics::tick(*program_, {t_s, probe, 0}, *state_, *scratch_, out_);
    return out_;
  }

 private:
  std::shared_ptr<const haptics::HapticProgram> program_;
  std::unique_ptr<haptics::ChainState> state_;
  std::unique_ptr<haptics::ChainScratch> scratch_;
  HapticState out_;
};

/// "[x, y, z]" as a scene file has it.
std::string vector_to_json(const Vec3& v);

/// A figure's gnuplot script: `about` as its first line, how its tables are read and its plots look, then `body`.
std::string make_figure_script(const std::string& about, std::string_view body);

/// The figures that `catena tradeoff --figure N` measures: tables, a gnuplot script, plots.
///   2  drift of the linear follow mode and of higher-order methods from the streamline (section 4)
///   3  a penetrable surface and a curve: the baselines' one proxy beside the chain (section 5)
///   stiffness  the largest spring that a device can show, by damping, rate and delay, beside the passive limit
///   energy     what a closed loop of the hand gains from two links, by their angle, by both forces
Outcome figure2(ResultsDir& folder);
Outcome figure3(ResultsDir& folder);
Outcome figure_stiffness(ResultsDir& folder);
Outcome figure_energy(ResultsDir& folder);

}  // namespace catena::app
