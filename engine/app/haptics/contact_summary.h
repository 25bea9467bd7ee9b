// SPDX-License-Identifier: MIT
/// Human-readable summary of the haptic contact along a probe path: one sentence per link, in device units.
///   skin: pressed 12.5 mm deep, own share at most 3.8 N; held 3.88 of 6.00 s. Gap 0.25 units; ticks FREE 2120 OK 3881
/// "pressed" is used for a one-sided link, "pulled ... off" for all others. The depth is the longest distance from the link's probe to its
/// proxy, in device meters. With several links, each reports its own contribution, limited as the total force is; springs that pull against
/// each other give a smaller total. A link holds while its status is none of FREE, RELEASED, NO_SURFACE and BAD_PROBE, and it is not
/// CRITICAL with the reason PARALLEL.
#pragma once
#include <array>
#include <cstdint>
#include <map>
#include <string>

#include "engine/base/haptic_state.h"
#include "haptics/chain/program.h"
#include "haptics/servo/replay.h"

namespace catena::app {

/// Accumulates the states of a run. One thread.
class ContactSummary {
 public:
  /// Adds one state.
  void add(const HapticState& state);
  /// One line per link. If only some states of a run were added, the lines describe those.
  std::string link_lines(const haptics::HapticProgram& program) const;
  /// One line on all ticks, then one line per link.
  std::string report(const haptics::HapticProgram& program, const haptics::ReplayStats& stats) const;

 private:
  struct LinkContact {
    double max_gap = 0, max_force_n = 0, held_s = 0;
    /// Number of times it began to hold, and number of times it went from holding to RELEASED
    int hold_count = 0, release_count = 0;
    /// At some tick every point of the field would have held it (CRITICAL, PARALLEL)
    bool is_holding = false, held_everywhere = false;
    std::map<std::string, std::uint64_t> statuses;
  };
  std::string describe_link(const LinkContact& touch, const haptics::Link& link, const haptics::HapticProgram& program) const;

  double max_force_n_ = 0, force_sum_n_ = 0, first_s_ = 0, last_s_ = 0;
  bool has_ticks_ = false;
  std::array<LinkContact, kMaxLinks> contacts_;
};

}  // namespace catena::app
