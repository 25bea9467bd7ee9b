/// Private to this room: a NanoVDB buffer that somebody else wrote is looked at as hostile before it is used. Every byte that a fetch or
/// a walk over the nodes would follow is compared with what NanoBuilder would have written there; values may be any.
///   sizes and counts fit the buffer to the byte; the nodes' arrays lie where they must; each child is the next of its array and lies
///   where its parent's entry does; root entries are aligned, near, and each there once; a mask's tiles are 0 or 1 as their states
#pragma once
#include <cstddef>
#include <span>

#include "engine/base/display_range.h"
#include "engine/base/result.h"
#include "engine/field/grid/grid.h"
#include "engine/field/nanovdb/nano_builder.h"

namespace catena::field {

/// An error is a phrase. T: float, nanovdb::Vec3f or nanovdb::ValueMask. The bytes are aligned to 32.
template <class T>
Outcome validate_nano(std::span<const std::byte> bytes);

/// Private to this room and to engine/io/vdb: what a buffer holds. Work grows with the buffer's bytes, never with the extent of its tiles.

using NanoMask = nanovdb::NanoGrid<nanovdb::ValueMask>;

/// The box of the active voxels, both corners included.
struct ActiveBox {
  nanovdb::Coord lo = nanovdb::Coord::max(), hi = nanovdb::Coord::min();
  bool empty() const { return hi[0] < lo[0]; }
  void extend(const nanovdb::Coord& first, const nanovdb::Coord& last) {
    lo.minComponent(first);
    hi.maxComponent(last);
  }
  std::int64_t voxels(int axis) const { return empty() ? 0 : std::int64_t{hi[axis]} - lo[axis] + 1; }
};
template <class T>
ActiveBox compute_active_box(const nanovdb::NanoGrid<T>& grid);

/// Sizes of boxes and places beside them are 32-bit numbers: an index box must lie within +-kMaxAbsIndex.
inline constexpr std::int32_t kMaxAbsIndex = (1 << 30) - kUpperEdge;
bool is_within_index_limits(const ActiveBox& box);

/// Statistics over the active voxels; with a mask over those that are valid. Where there is none, the ranges are zero;
/// `ranged` says so.
struct NanoStats {
  GridStats stats;
  bool has_range = false;
};
template <class T>
NanoStats compute_stats(const nanovdb::NanoGrid<T>& grid, const NanoMask* valid);

/// The display range of the same values (display_range.h).
template <class T>
DisplayRange compute_display_range(const nanovdb::NanoGrid<T>& grid, const NanoMask* valid, const GridStats& stats);

/// Of a mask: the number of its voxels.
std::uint64_t count_voxels(const NanoMask& mask);

/// Private to this room and to engine/io/vdb: from valid voxels to valid cells.
///   bit at ijk: the voxels ijk + (0 or 1, 0 or 1, 0 or 1) are all valid and within the box of the grid that is masked, and `cells`,
///               where it is not null, has the bit as well
/// Along an axis of one layer a cell has no thickness. Work and memory grow with the surface of large tiles, not with what they hold.

/// Memory comes from `allocate`, in one piece of the exact size; before, `ask` is told the bytes and may refuse.
Result<NanoMemory> erode_mask(const NanoMask& valid, const ActiveBox& box, const NanoMask* cells, const NanoAllocator& allocate,
                              const std::function<Outcome(double bytes)>& ask);

}  // namespace catena::field
