// SPDX-License-Identifier: MIT
/// Runs the tick over a recorded probe path: deterministic, without a thread.
#pragma once
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "engine/base/export.h"
#include "haptics/chain/offline_ticks.h"
#include "haptics/chain/state_hash.h"

namespace catena::haptics {

/// Statistics of a replay.
struct ReplayStats {
  std::uint64_t ticks = 0;                                                     ///< number of ticks
  double tick_ns_p50 = 0, tick_ns_p99 = 0, tick_ns_p999 = 0, tick_ns_max = 0;  ///< quantiles, maximum of a tick's duration, ns
  std::int64_t evaluations_p50 = 0, evaluations_max = 0;                       ///< field samples per tick, summed over links
  std::uint64_t state_hash = 0;                                                ///< hash of all ticks (StateHash)
};

/// Collects the statistics of a replay, tick by tick.
class CATENA_EXPORT ReplayMeter {
 public:
  /// Reserves memory for this number of ticks.
  void reserve(std::size_t ticks);
  /// Adds the result of a tick and its duration.
  void add(double nanoseconds, const HapticState& state);
  /// Returns the statistics. It reorders the collected values, so call it last.
  ReplayStats stats();

 private:
  std::vector<double> nanoseconds_;
  std::vector<std::int64_t> evaluations_;
  StateHash hash_;
};

/// Runs the program over the path from a fresh state. `on_tick` is called after every tick, outside the timed part; if it returns false the
/// replay ends.
CATENA_EXPORT ReplayStats replay(const HapticProgram& program, std::span<const ProbeSample> path,
                                 const std::function<bool(const HapticState&)>& on_tick);

}  // namespace catena::haptics
