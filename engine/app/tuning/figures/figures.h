// SPDX-License-Identifier: MIT
/// Figures of `catena tradeoff --figure N` and what they share.
#pragma once
#include <memory>
#include <string>
#include <string_view>

#include "engine/app/tuning/report/results_dir.h"
#include "engine/base/result.h"
#include "haptics/chain/tick.h"

namespace catena::app {

/// Haptic simulation of a scene given as text: runs the same tick as `replay`, step by step.
class TickSimulation {
 public:
  /// `scene`: trusted scene text; an invalid one is a programming error (assertion).
  explicit TickSimulation(const std::string& scene);
  /// Runs one tick at time `t_s` with the probe at a world position; the returned state is valid until the next call.
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

/// Returns "[x, y, z]" in the format of a scene file.
std::string vector_to_json(const Vec3& v);

/// Returns the gnuplot script of a figure: `about` as a comment in its first line, settings for the tables and the look of the plots, then
/// `body`.
std::string make_figure_script(const std::string& about, std::string_view body);

/// The figures that `catena tradeoff --figure N` measures; each adds tables, a gnuplot script and plots to the folder.
///   2  drift from the streamline, for the linear follow mode and for higher-order methods (section 4)
///   3  a penetrable surface and a curve: the single proxy of the baselines compared with the chain (section 5)
///   stiffness  the largest spring that a device can render, by damping, rate and delay, compared with the passivity limit
///   energy     energy gained by a closed probe path on two links, by the angle between them, for both force methods
Outcome figure2(ResultsDir& folder);
Outcome figure3(ResultsDir& folder);
Outcome figure_stiffness(ResultsDir& folder);
Outcome figure_energy(ResultsDir& folder);

}  // namespace catena::app
