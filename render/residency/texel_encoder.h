// SPDX-License-Identifier: MIT
/// Encoding of values as texels of a resident grid: value = offset + scale * texel (resident_grid.h describes the formats). Any thread.
#pragma once
#include <cstddef>

#include "render/residency/resident_grid.h"

namespace catena::render {

/// Encodes values. Values that are not finite become the minimum (their cells are masked); values outside the range occur only outside the
/// domain, where they must be finite, too.
struct TexelEncoder {
  bool float32;
  float offset, scale, min, max;

  /// Determines the scale from the grid's values.
  TexelEncoder(const field::ScalarGrid& grid, bool float32_texels);
  /// Encodes `count` values to `out`.
  void write(const float* from, std::size_t count, std::byte* out) const;
  /// Returns the range as decoded from texels; rounding is monotonic, so that it suffices to round the ends.
  BrickRange round_trip(const BrickRange& r) const;
  std::size_t texel_bytes() const { return float32 ? 4 : 2; }  ///< bytes per texel
};

}  // namespace catena::render
