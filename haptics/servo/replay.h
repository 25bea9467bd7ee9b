/// Drives the tick from a recorded probe path: deterministic, no thread.
#pragma once
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "haptics/chain/state_hash.h"
#include "haptics/chain/tick.h"

namespace catena::haptics {

/// What a replay took and did.
struct ReplayStats {
  std::uint64_t ticks = 0;                                                     ///< how many ran
  double tick_ns_p50 = 0, tick_ns_p99 = 0, tick_ns_p999 = 0, tick_ns_max = 0;  ///< quantiles of a tick's time, nanoseconds
  std::int64_t evaluations_p50 = 0, evaluations_max = 0;                       ///< summed over links
  std::uint64_t state_hash = 0;                                                ///< of all ticks (StateHash)
};

/// Collects the figures of a replay, tick by tick.
class ReplayMeter {
 public:
  /// Takes the memory for so many ticks.
  void reserve(std::size_t ticks);
  /// Adds a tick and how long it took.
  void add(double nanoseconds, const HapticState& state);
  ReplayStats stats();  ///< reorders what it has collected: call it last

 private:
  std::vector<double> nanoseconds_;
  std::vector<std::int64_t> evaluations_;
  StateHash hash_;
};

/// Calls `on_tick` after every tick, outside the timed part. False from it stops the replay.
ReplayStats replay(const HapticProgram& program, std::span<const ProbeSample> path, const std::function<bool(const HapticState&)>& on_tick);

}  // namespace catena::haptics
