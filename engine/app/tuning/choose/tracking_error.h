// SPDX-License-Identifier: MIT
/// Measured tracking error of tuned links: distance of their proxies from the converged streamlines. add() only records the proxies; the
/// converged streamlines are traced when the error is requested. Not for the haptic thread.
#pragma once
#include <string>
#include <vector>

#include "engine/app/tuning/choose/tick_tuning.h"
#include "engine/base/haptic_state.h"
#include "haptics/chain/program.h"

namespace catena::app::tuning {

/// Records the proxies of the links of a TickTuning and compares them with the converged streamlines.
class TrackingErrorMonitor {
 public:
  /// A null `plan` gives a monitor that records nothing. Neither argument is kept.
  TrackingErrorMonitor(const TickTuning* plan, const haptics::HapticProgram& program);
  /// Records the proxies of the tuned links that are in contact in this tick.
  void add(const HapticState& state);
  /// Returns the largest distance so far of a tuned link's proxy from its converged line, world units; nothing if no tuned link was in
  /// contact.
  std::optional<double> max_error(scene::Scene& scene) const;
  /// Returns "observed: error 2.9e-07 (without the discretization error) in 1.8 us per tick\n"; empty without a tuning. `us`: time per
  /// tick; nothing if unknown.
  std::string summary(scene::Scene& scene, std::optional<double> us) const;

 private:
  /// Proxies of one link while it was in contact: all of them at first, then every 2nd, 4th, ..., so that fewer than kMaxPositions are
  /// stored.
  struct Track {
    std::string link;
    int index = -1;  ///< Index of the link in the program.
    std::vector<Vec3> positions;
    double path_length = 0;  ///< Length along all proxies, stored or not, world units.
    Vec3 last_position{0.0};
    std::size_t proxy_count = 0, stride = 1;
  };
  static constexpr std::size_t kMaxPositions = 20000;
  std::vector<Track> tracks_;
};

}  // namespace catena::app::tuning
