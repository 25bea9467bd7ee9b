// SPDX-License-Identifier: MIT
/// Validation of NanoVDB buffers that other programs wrote. They are untrusted: every byte that a fetch or a traversal of the nodes would
/// follow is compared with the byte that NanoBuilder would have written; values are arbitrary. Private to this module.
///   Sizes and counts match the buffer exactly; the arrays of nodes have the required offsets; each child is the next one of its array
///   and has the origin that its parent's entry implies; root entries are aligned, within the index limits and unique; the values of a
///   mask's tiles are 0 or 1, equal to their states.
#pragma once
#include <cstddef>
#include <span>

#include "engine/base/display_range.h"
#include "engine/base/result.h"
#include "engine/field/grid/grid.h"
#include "engine/field/nanovdb/nano_builder.h"

namespace catena::field {

/// Validates a buffer. Error: a message fragment. T: float, nanovdb::Vec3f or nanovdb::ValueMask. The bytes must be aligned to 32.
template <class T>
Outcome validate_nano(std::span<const std::byte> bytes);

/// Statistics of a buffer. The cost grows with the bytes of the buffer, never with the extent of its tiles. Private to this module and to
/// engine/io/vdb.

using NanoMask = nanovdb::NanoGrid<nanovdb::ValueMask>;

/// Box of the active voxels, both corners included.
struct ActiveBox {
  nanovdb::Coord lo = nanovdb::Coord::max(), hi = nanovdb::Coord::min();
  bool empty() const { return hi[0] < lo[0]; }
  void extend(const nanovdb::Coord& first, const nanovdb::Coord& last) {
    lo.minComponent(first);
    hi.maxComponent(last);
  }
  std::int64_t voxels(int axis) const { return empty() ? 0 : std::int64_t{hi[axis]} - lo[axis] + 1; }
};
/// Returns the box of the active voxels of a grid.
template <class T>
ActiveBox compute_active_box(const nanovdb::NanoGrid<T>& grid);

/// Index boxes must be within +-kMaxAbsIndex, so that their sizes and positions next to them fit into 32-bit integers.
inline constexpr std::int32_t kMaxAbsIndex = (1 << 30) - kUpperEdge;
/// Returns true when the box is within +-kMaxAbsIndex.
bool is_within_index_limits(const ActiveBox& box);

/// Statistics over the active voxels, or over those that are valid when there is a mask. `has_range`: there is a finite value; otherwise
/// the ranges are zero.
struct NanoStats {
  GridStats stats;
  bool has_range = false;
};
/// Computes the statistics; `valid`: mask of valid voxels, null for none.
template <class T>
NanoStats compute_stats(const nanovdb::NanoGrid<T>& grid, const NanoMask* valid);

/// Computes the display range (base/display_range.h) of the values that compute_stats() counts; `stats` are their statistics.
template <class T>
DisplayRange compute_display_range(const nanovdb::NanoGrid<T>& grid, const NanoMask* valid, const GridStats& stats);

/// Returns the number of voxels that are set in a mask.
std::uint64_t count_voxels(const NanoMask& mask);

/// Erosion of a mask of valid voxels to a mask of valid cells.
///   bit at ijk: the voxels ijk + (0 or 1, 0 or 1, 0 or 1) are all valid and in the box of the masked grid, and `cells`, where it is
///               not null, has the bit as well
/// Along an axis with a single slice a cell has no thickness. Cost and memory grow with the surface of large tiles, not with their volume.
/// Private to this module and to engine/io/vdb.

/// Makes the mask of valid cells. `check_memory` checks the memory budget: it is called with a size in bytes before working memory and
/// before the buffer are allocated, and may return an Error. `allocate` provides the buffer, in one piece of the exact size. Error: that of
/// `check_memory`.
Result<NanoMemory> erode_mask(const NanoMask& valid, const ActiveBox& box, const NanoMask* cells, const NanoAllocator& allocate,
                              const std::function<Outcome(double bytes)>& check_memory);

}  // namespace catena::field
