// SPDX-License-Identifier: MIT
#include "engine/app/tuning/measure/fetch_timing.h"

#include <random>

namespace catena::app::tuning {

std::vector<Vec3> straight_sample_paths(const field::Box& box) {
  std::mt19937 random(7);
  const auto unit = [&] { return static_cast<double>(random() >> 8) / 16777216.0; };
  std::vector<Vec3> places;
  while (places.size() < 100000) {
    Vec3 p = box.lo + Vec3(unit(), unit(), unit()) * (box.hi - box.lo);
    const Vec3 step = 0.1 * direction(Vec3(unit() - 0.5, unit() - 0.5, unit() - 0.5));
    for (int k = 0; k < 200 && box.contains(p); ++k, p += step) places.push_back(p);
  }
  return places;
}

}  // namespace catena::app::tuning
