/// Private to this room and to engine/vdb: what a buffer holds. Work grows with the buffer's bytes, never with the extent of its tiles.
#pragma once
#include "engine/field/grid.h"
#include "engine/field/nano_build.h"

namespace catena::field {

using NanoMask = nanovdb::NanoGrid<nanovdb::ValueMask>;

/// The box of the active voxels, both corners included.
struct ActiveBox {
  nanovdb::Coord lo = nanovdb::Coord::max(), hi = nanovdb::Coord::min();
  bool empty() const { return hi[0] < lo[0]; }
  void add(const nanovdb::Coord& first, const nanovdb::Coord& last) {
    lo.minComponent(first);
    hi.maxComponent(last);
  }
  std::int64_t voxels(int axis) const { return empty() ? 0 : std::int64_t{hi[axis]} - lo[axis] + 1; }
};
template <class T>
ActiveBox active_box(const nanovdb::NanoGrid<T>& grid);

/// Sizes of boxes and places beside them are 32-bit numbers: an index box must lie within +-kFarthestIndex.
inline constexpr std::int32_t kFarthestIndex = (1 << 30) - kUpperEdge;
bool is_near(const ActiveBox& box);

/// Statistics over the active voxels; with a mask the ranges count only the valid ones. Where there is none, the ranges are zero;
/// `ranged` says so.
struct NanoStats {
  GridStats stats;
  bool ranged = false;
};
template <class T>
NanoStats stats_of(const nanovdb::NanoGrid<T>& grid, const NanoMask* valid);

/// Of a mask: the number of its voxels.
std::uint64_t count_of(const NanoMask& mask);

}  // namespace catena::field
