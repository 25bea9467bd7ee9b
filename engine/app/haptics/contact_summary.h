/// What the hand felt along a path, for a person to read: a sentence for each link, with units of the hand.
///   skin: pressed 12.5 mm deep, own share at most 3.8 N; held 3.88 of 6.00 s. Gap 0.25 units; ticks FREE 2120 OK 3881
/// "pressed" is said of a link with a free side, "pulled ... off" of all others. The depth is the longest way from the link's probe to its
/// proxy, in metres of the hand. Of several links each has its own share, limited as the whole force is; springs that pull against each
/// other give a whole that is smaller. A link holds while its status is none of FREE, RELEASED, NO_SURFACE and BAD_PROBE, and
/// its reason not PARALLEL.
#pragma once
#include <array>
#include <cstdint>
#include <map>
#include <string>

#include "engine/base/haptic_state.h"
#include "haptics/chain/program.h"
#include "haptics/servo/replay.h"

namespace catena::app {

class ContactSummary {
 public:
  void add(const HapticState& state);
  /// A sentence a link, a line each; of a run that is looked at now and then the sentences are of those looks.
  std::string link_lines(const haptics::HapticProgram& program) const;
  /// A line about all ticks, then a line a link.
  std::string report(const haptics::HapticProgram& program, const haptics::ReplayStats& stats) const;

 private:
  struct LinkContact {
    double max_gap = 0, max_force_n = 0, held_s = 0;
    int hold_count = 0, release_count = 0;             ///< how often it took hold, and how often it went from holding to RELEASED
    bool is_holding = false, held_everywhere = false;  ///< nowhere: every place would hold it
    std::map<std::string, std::uint64_t> statuses;
  };
  std::string describe_link(const LinkContact& touch, const haptics::Link& link, const haptics::HapticProgram& program) const;

  double max_force_n_ = 0, force_sum_n_ = 0, first_s_ = 0, last_s_ = 0;
  bool has_ticks_ = false;
  std::array<LinkContact, kMaxLinks> contacts_;
};

}  // namespace catena::app
