// SPDX-License-Identifier: MIT
/// Morton codes: the bits of a point's coordinates, interleaved, so that neighbors in this order are mostly neighbors in space.
/// G. M. Morton, IBM technical report (1966). Any thread.
#pragma once
#include <algorithm>
#include <cstdint>

#include "engine/base/vec.h"

namespace catena::haptics {

inline std::uint64_t spread_bits(std::uint64_t x) {
  /// Returns the low 21 bits of x with two zero bits between each two of them.
  x &= 0x1fffff;
  x = (x | x << 32) & 0x1f00000000ffff;
  x = (x | x << 16) & 0x1f0000ff0000ff;
  x = (x | x << 8) & 0x100f00f00f00f00f;
  x = (x | x << 4) & 0x10c30c30c30c30c3;
  return (x | x << 2) & 0x1249249249249249;
}

/// Returns the 63-bit code of p in the cube with the corner `lowest` and the given `edge` > 0; p is clamped to the cube.
inline std::uint64_t morton_code(const Vec3& p, const Vec3& lowest, double edge) {
  std::uint64_t code = 0;
  for (int i = 0; i < 3; ++i)
    code |= spread_bits(static_cast<std::uint64_t>(std::clamp((p[i] - lowest[i]) / edge, 0.0, 1.0) * 2097151)) << i;
  return code;
}

}  // namespace catena::haptics
