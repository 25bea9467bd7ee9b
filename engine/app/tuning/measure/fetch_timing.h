// SPDX-License-Identifier: MIT
/// Cost of a field fetch: positions along random straight lines, distributed like the fetches of a probe, and a timed run (timing.h) over
/// them.
#pragma once
#include <vector>

#include "engine/app/tuning/measure/timing.h"
#include "engine/base/clock.h"
#include "engine/field/mapping.h"

namespace catena::app::tuning {

/// Returns 1e5 positions in a box of grid indices, on straight lines with a tenth of a voxel between neighbors; the same at every call.
std::vector<Vec3> straight_sample_paths(const field::Box& box);

/// Returns a timed run of `fetch(position)`, which returns a number: nanoseconds per position. `points`, and whatever `fetch` refers to,
/// must outlive it.
template <class Fetch>
TimedRun make_fetch_run(const std::vector<Vec3>& points, Fetch fetch) {
  return [&points, fetch]() mutable -> Result<double> {
    const std::int64_t start = process_cpu_ns();
    double sum = 0;
    for (const Vec3& p : points) sum += fetch(p);
    volatile double sink = sum;
    (void)sink;
    return static_cast<double>(process_cpu_ns() - start) / static_cast<double>(points.size());
  };
}

}  // namespace catena::app::tuning
