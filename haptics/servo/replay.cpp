#include "haptics/servo/replay.h"

#include <memory>
#include <vector>

#include "engine/base/clock.h"
#include "engine/base/quantile.h"
#include "haptics/chain/state_hash.h"

namespace catena::haptics {

ReplayStats replay(const Program& program, std::span<const ProbeSample> path,
                   const std::function<bool(const exchange::HapticState&)>& on_tick) {
  auto state = std::make_unique<ChainState>();
  auto scratch = std::make_unique<ChainScratch>();
  exchange::HapticState out;
  StateHash hash;
  std::vector<double> nanoseconds;
  std::vector<std::int64_t> evaluations;
  nanoseconds.reserve(path.size());
  evaluations.reserve(path.size());

  for (const ProbeSample& probe : path) {
    const std::int64_t start = now_ns();
    tick(program, probe, *state, *scratch, out);
    nanoseconds.push_back(static_cast<double>(now_ns() - start));
    std::int64_t sum = 0;
    for (int i = 0; i < out.link_count; ++i) sum += out.links[static_cast<std::size_t>(i)].evaluations;
    evaluations.push_back(sum);
    hash.add(out);
    if (!on_tick(out)) break;
  }

  ReplayStats stats;
  stats.ticks = nanoseconds.size();
  stats.tick_ns_p50 = quantile(nanoseconds, 0.5);
  stats.tick_ns_p99 = quantile(nanoseconds, 0.99);
  stats.tick_ns_p999 = quantile(nanoseconds, 0.999);
  stats.tick_ns_max = quantile(nanoseconds, 1.0);
  stats.evaluations_p50 = quantile(evaluations, 0.5);
  stats.evaluations_max = quantile(evaluations, 1.0);
  stats.state_hash = hash.value();
  return stats;
}

}  // namespace catena::haptics
