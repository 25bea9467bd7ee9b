// SPDX-License-Identifier: MIT
/// Range of the cells of a grid, and the position of a point relative to one. Any thread.
#pragma once
#include <algorithm>
#include <cstdint>

#include "engine/base/vec.h"
#include "engine/field/cell.h"

namespace catena::field {

/// Base indices of the cells of a box of voxels.
struct CellRange {
  Index3 first_base, last_base;  ///< valid base indices: first_base..last_base
  Index3 step;                   ///< offset to the next corner: 1, or 0 along an axis with a single slice

  /// Sets the range of base indices from the first and the last voxel.
  void set_box(const Index3& first, const Index3& final_voxel) {
    first_base = first;
    step = {first.x < final_voxel.x, first.y < final_voxel.y, first.z < final_voxel.z};
    last_base = {final_voxel.x - step.x, final_voxel.y - step.y, final_voxel.z - step.z};
  }
  Index3 last_voxel() const { return {last_base.x + step.x, last_base.y + step.y, last_base.z + step.z}; }  ///< last voxel of the index box
  /// Returns true when base and base + step are in the index box.
  bool is_legal_base(const Index3& b) const {
    return b.x >= first_base.x && b.y >= first_base.y && b.z >= first_base.z && b.x <= last_base.x && b.y <= last_base.y &&
           b.z <= last_base.z;
  }
  /// Returns the nearest valid base index.
  Index3 clamp_base(const Index3& b) const {
    return {std::min(std::max(b.x, first_base.x), last_base.x), std::min(std::max(b.y, first_base.y), last_base.y),
            std::min(std::max(b.z, first_base.z), last_base.z)};
  }
  /// Returns the floor of an index position, clamped before the conversion to integers: safe for any input.
  Index3 cell_base(const Vec3& index) const {
    const auto axis = [](double x, std::int32_t first, std::int32_t final_base) {
      if (!(x >= first)) return first;
      if (x >= final_base) return final_base;
      const std::int32_t i = static_cast<std::int32_t>(x);
      return i - (x < i);
    };
    return {axis(index.x, first_base.x, last_base.x), axis(index.y, first_base.y, last_base.y), axis(index.z, first_base.z, last_base.z)};
  }
};

/// Returns the position relative to the base voxel, clamped far outside of the cell to a range in which the polynomial cannot overflow.
inline Vec3 position_in_cell(const Vec3& index, const Index3& base) {
  static constexpr double far = 1e9;
  const auto axis = [](double x, std::int32_t b) { return std::min(std::max(x - b, -far), far); };
  return {axis(index.x, base.x), axis(index.y, base.y), axis(index.z, base.z)};
}

/// Returns the corner of a cell that is nearest to a position in it; of two equally near ones that with the larger index.
inline unsigned nearest_corner(const Vec3& position) {
  return (position.x >= 0.5 ? 1u : 0u) + (position.y >= 0.5 ? 2u : 0u) + (position.z >= 0.5 ? 4u : 0u);
}

constexpr double kDomainSlack = 1e-9;  ///< tolerance at the faces of the domain, voxels

}  // namespace catena::field
