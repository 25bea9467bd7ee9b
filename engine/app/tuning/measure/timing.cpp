// SPDX-License-Identifier: MIT
#include "engine/app/tuning/measure/timing.h"

#include "engine/base/clock.h"
#include "engine/base/numbers.h"

namespace catena::app::tuning {

Timing compute_timing(std::vector<double> times) {
  if (times.empty()) return {};
  Timing t;
  t.repeats = static_cast<int>(times.size());
  t.lower_quartile = quantile(times, 0.25);
  t.median = quantile(times, 0.5);
  t.upper_quartile = quantile(times, 0.75);
  return t;
}

Result<std::vector<Timing>> time_interleaved(const std::vector<TimedRun>& settings, double seconds, int max_repeats) {
  constexpr int kMinimum = 3;
  const std::size_t n = settings.size();
  std::vector<std::vector<double>> times(n);
  const std::int64_t start = now_ns();
  for (int round = 0; round <= max_repeats; ++round) {
    const double over = 1e-3 * ms_since(start) - seconds;
    if (round > kMinimum ? over > 0 : round > 1 && over > seconds) break;
    for (std::size_t k = 0; k < n; ++k) {
      const std::size_t i = (k + static_cast<std::size_t>(round)) % n;
      CATENA_TRY(const double took, settings[i]());
      if (round > 0) times[i].push_back(took);
    }
  }
  std::vector<Timing> out;
  for (std::vector<double>& all : times) out.push_back(compute_timing(std::move(all)));
  return out;
}

Outcome time_points(Curve& curve, const std::vector<TimedRun>& repeats, double seconds, int max_repeats) {
  CATENA_ASSERT(repeats.size() == curve.points.size());
  CATENA_TRY(const std::vector<Timing> times, time_interleaved(repeats, seconds, max_repeats));
  for (std::size_t i = 0; i < times.size(); ++i) curve.points[i].time = times[i];
  return Done{};
}

}  // namespace catena::app::tuning
