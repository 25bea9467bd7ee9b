// SPDX-License-Identifier: MIT
#include "haptics/servo/replay.h"

#include <memory>

#include "engine/base/clock.h"
#include "engine/base/numbers.h"

namespace catena::haptics {

void ReplayMeter::reserve(std::size_t ticks) {
  nanoseconds_.reserve(ticks);
  evaluations_.reserve(ticks);
}

void ReplayMeter::add(double nanoseconds, const HapticState& state) {
  nanoseconds_.push_back(nanoseconds);
  std::int64_t sum = 0;
  for (int i = 0; i < state.link_count; ++i) sum += state.links[static_cast<std::size_t>(i)].evaluations;
  evaluations_.push_back(sum);
  hash_.add(state);
}

ReplayStats ReplayMeter::stats() {
  ReplayStats stats;
  stats.ticks = nanoseconds_.size();
  stats.tick_ns_p50 = quantile(nanoseconds_, 0.5);
  stats.tick_ns_p99 = quantile(nanoseconds_, 0.99);
  stats.tick_ns_p999 = quantile(nanoseconds_, 0.999);
  stats.tick_ns_max = quantile(nanoseconds_, 1.0);
  stats.evaluations_p50 = quantile(evaluations_, 0.5);
  stats.evaluations_max = quantile(evaluations_, 1.0);
  stats.state_hash = hash_.value();
  return stats;
}

ReplayStats replay(const HapticProgram& program, std::span<const ProbeSample> path,
                   const std::function<bool(const HapticState&)>& on_tick) {
  auto state = std::make_unique<ChainState>();
  auto scratch = std::make_unique<ChainScratch>();
  OfflineTicks ticks;
  HapticState out;
  ReplayMeter meter;
  meter.reserve(path.size());
  for (const ProbeSample& probe : path) {
    const std::int64_t start = now_ns();
    ticks.run(program, probe, *state, *scratch, out);
    meter.add(static_cast<double>(now_ns() - start), out);
    if (!on_tick(out)) break;
  }
  return meter.stats();
}

}  // namespace catena::haptics
