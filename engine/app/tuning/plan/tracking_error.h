/// What a plan's promise came to: how far the proxies of planned links were off their lines. The ticks are only looked at; the converged
/// lines are traced when somebody asks. Off the tick.
#pragma once
#include <string>
#include <vector>

#include "engine/app/tuning/plan/tick_tuning.h"
#include "engine/base/haptic_state.h"
#include "haptics/chain/program.h"

namespace catena::app::plan {

class TrackingErrorMonitor {
 public:
  /// Of no plan: it looks at nothing.
  TrackingErrorMonitor(const TickTuning* plan, const haptics::HapticProgram& program);
  void add(const HapticState& state);
  /// The greatest distance so far of a planned link's proxy from its converged line, world units; nothing where none held.
  std::optional<double> max_error(scene::Scene& scene) const;
  /// "observed: error 2.9e-07 (the cells' own error is not in it) in 1.8 us a tick\n"; empty of no plan. `us`: of a tick; none: not known.
  std::string summary(scene::Scene& scene, std::optional<double> us) const;

 private:
  /// Proxies of one link while it held: all of them, then every 2nd, 4th, ... so that there are never more than kMost.
  struct Track {
    std::string link;
    int index = -1;  ///< in the program
    std::vector<Vec3> positions;
    double path_length = 0;  ///< along all of them
    Vec3 last_position{0.0};
    std::size_t proxy_count = 0, stride = 1;
  };
  static constexpr std::size_t kMaxPositions = 20000;
  std::vector<Track> tracks_;
};

}  // namespace catena::app::plan
