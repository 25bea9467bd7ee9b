// SPDX-License-Identifier: MIT
/// The probe's path of several rows.
#pragma once
#include <cmath>

#include "engine/base/vec.h"

namespace catena::extremes {

/// A motion near the circle of radius 0.8 about the z axis, about 2e-3 per tick.
inline Vec3 probe_at(int tick) {
  const double a = 2e-3 * tick;
  return {(0.8 + 0.1 * std::sin(5 * a)) * std::cos(a), (0.8 + 0.1 * std::sin(3 * a)) * std::sin(a), 0.1 * std::sin(7 * a)};
}

}  // namespace catena::extremes
