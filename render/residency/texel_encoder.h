/// Values as texels of a grid's mirror: value = offset + scale * texel (grid_mirror.h has the formats). Any thread.
#pragma once
#include <cstddef>

#include "render/residency/resident_grid.h"

namespace catena::render {

/// What is not finite becomes the least value (its cells are masked); what lies outside the range can only be outside the domain, where it
/// must stay finite all the same.
struct TexelEncoder {
  bool float32;
  float offset, scale, min, max;

  TexelEncoder(const field::ScalarGrid& grid, bool float32_texels);
  void write(const float* from, std::size_t count, std::byte* out) const;
  /// What a texel gives back; rounding is monotonic, so ranges can be rounded at their ends.
  BrickRange round_trip(const BrickRange& r) const;
  std::size_t texel_bytes() const { return float32 ? 4 : 2; }  ///< bytes
};

}  // namespace catena::render
