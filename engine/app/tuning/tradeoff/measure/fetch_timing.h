/// What a fetch takes: places along random straight walks, as a hand's fetches lie, and a repeat (timing.h) over them.
#pragma once
#include <vector>

#include "engine/app/tuning/tradeoff/measure/timing.h"
#include "engine/base/clock.h"
#include "engine/field/mapping.h"

namespace catena::app::tradeoff {

/// 1e5 places in a box of indices, a tenth of a voxel from one to the next of a walk; the same at every call.
std::vector<Vec3> straight_sample_paths(const field::Box& box);

/// Nanoseconds a place of `fetch`(place), a number; it and the places outlive the repeat's use.
template <class Fetch>
TimedRun make_fetch_run(const std::vector<Vec3>& places, Fetch fetch) {
  return [&places, fetch]() mutable -> Result<double> {
    const std::int64_t start = process_cpu_ns();
    double sum = 0;
    for (const Vec3& p : places) sum += fetch(p);
    volatile double keep = sum;
    (void)keep;
    return static_cast<double>(process_cpu_ns() - start) / static_cast<double>(places.size());
  };
}

}  // namespace catena::app::tradeoff
