/// What a plan's promise came to: how far the proxies of planned links were off their lines. The ticks are only looked at; the converged
/// lines are traced when somebody asks. Off the tick.
#pragma once
#include <string>
#include <vector>

#include "engine/app/plan/hand_plan.h"
#include "engine/exchange/haptic_state.h"
#include "haptics/chain/program.h"

namespace catena::app::plan {

class HandObserver {
 public:
  /// Of no plan: it looks at nothing.
  HandObserver(const HandPlan* plan, const haptics::Program& program);
  void add(const exchange::HapticState& state);
  /// The greatest distance so far of a planned link's proxy from its converged line, world units; nothing where none held.
  std::optional<double> error(scene::Scene& scene) const;
  /// "observed: error 2.9e-07 (the cells' own error is not in it) in 1.8 us a tick\n"; empty of no plan. `us`: of a tick; none: not known.
  std::string sentence(scene::Scene& scene, std::optional<double> us) const;

 private:
  /// Proxies of one link while it held: all of them, then every 2nd, 4th, ... so that there are never more than kMost.
  struct Track {
    std::string link;
    int index = -1;  ///< in the program
    std::vector<Vec3> places;
    double way = 0;  ///< along all of them
    Vec3 last{0.0};
    std::size_t seen = 0, stride = 1;
  };
  static constexpr std::size_t kMost = 20000;
  std::vector<Track> tracks_;
};

}  // namespace catena::app::plan
