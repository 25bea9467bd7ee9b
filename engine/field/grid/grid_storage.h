// SPDX-License-Identifier: MIT
/// NanoVDB buffers of a grid, and the cell cache in a Cursor. Private to this module.
/// When there is a mask, `valid_cells` has one bit per cell, at its base voxel: set when all eight corners of the cell are valid and the
/// mask of cells, where there is one, does not exclude it.
#pragma once
#include <nanovdb/NanoVDB.h>

#include <array>
#include <cstring>
#include <mutex>
#include <new>
#include <optional>
#include <type_traits>

#include "engine/base/display_range.h"
#include "engine/field/grid/cell_range.h"
#include "engine/field/grid/grid.h"
#include "engine/field/nanovdb/nano_statistics.h"

namespace catena::field {

inline nanovdb::Coord to_nano_coord(const Index3& i) { return {i.x, i.y, i.z}; }

/// Buffers of a grid with values of type T. Read-only after construction, except for the cached display range, which range_mutex protects.
template <class T>
struct GridStorage : CellRange {
  using Value = T;
  NanoMemory values_memory, voxels_memory, cells_memory;
  const nanovdb::NanoGrid<T>* values = nullptr;
  const NanoMask* valid_voxels = nullptr;  ///< null: no mask
  const NanoMask* valid_cells = nullptr;
  bool has_invalid_cells = false;
  /// `valid_cells` excludes cells that `valid_voxels` alone would not.
  bool has_cell_mask = false;
  /// Display range of the original data when the values were resampled; of magnitudes for vectors.
  std::optional<DisplayRange> data_range{};
  mutable std::mutex range_mutex;
  /// Set on first use (field_display_range.h).
  mutable std::optional<DisplayRange> cached_range;

  std::size_t bytes() const { return values_memory.size() + voxels_memory.size() + cells_memory.size(); }
  /// Returns true when `base` is a valid base index and the mask of valid cells contains it.
  template <class Accessor>
  bool is_cell_valid(const Accessor& cells, const Index3& base) const {
    return is_legal_base(base) && cells.getValue(nanovdb::Coord(base.x, base.y, base.z));
  }
};

/// Converts a stored value to a cell corner.
inline double corner_value(float v) { return v; }
inline Vec3 corner_value(const nanovdb::Vec3f& v) { return {v[0], v[1], v[2]}; }

/// Buffers of a scalar grid and of a vector grid.
struct ScalarGrid::Storage : GridStorage<float> {};
struct VectorGrid::Storage : GridStorage<nanovdb::Vec3f> {};

/// Cell cache in the bytes of a Cursor: accessors and the last cell. CubicCellCache also contains the cell's samples.
template <class T, class Corner>
struct CellCache {
  using Values = nanovdb::ReadAccessor<T, 0, 1, 2>;
  using Cells = nanovdb::ReadAccessor<nanovdb::ValueMask, 0, -1, -1>;
  std::uint64_t version;
  Index3 base;
  bool filled, valid;
  std::array<Corner, 8> corner;
  Values values;
  alignas(8) std::byte cells[sizeof(Cells)];

  explicit CellCache(const nanovdb::NanoGrid<T>& grid, std::uint64_t v)
      : version(v), base{}, filled(false), valid(false), corner{}, values(grid), cells{} {}
};

using ScalarCellCache = CellCache<float, double>;
using VectorCellCache = CellCache<nanovdb::Vec3f, Vec3>;
static_assert(offsetof(ScalarCellCache, version) == 0 && offsetof(VectorCellCache, version) == 0);

/// Cell cache of a cubic grid, with the samples around the cell.
template <class T, class Corner>
struct CubicCellCache : CellCache<T, Corner> {
  alignas(16) CubicSamples<sizeof(T) / sizeof(float)> samples;
  typename CellCache<T, Corner>::Values halo;

  CubicCellCache(const nanovdb::NanoGrid<T>& grid, const nanovdb::NanoGrid<T>& ghost_grid, std::uint64_t v)
      : CellCache<T, Corner>(grid, v), samples{}, halo(ghost_grid) {}
};

/// Returns the cell cache in the cursor's memory. It is constructed again when the cursor was last used with another grid (or with one that
/// was freed at the same address). `ghosts`: the halo grid, for a CubicCellCache.
template <class W, class Storage, class... Ghosts>
W& cell_cache(Cursor& cursor, const void* owner, std::uint64_t version, const Storage& storage, const Ghosts&... ghosts) {
  static_assert(sizeof(W) <= sizeof(Cursor::memory) && alignof(W) <= 16 && std::is_trivially_copyable_v<W>);
  W* walk = std::launder(reinterpret_cast<W*>(cursor.memory));
  if (cursor.owner == owner && walk->version == version) return *walk;
  walk = new (cursor.memory) W(*storage.values, ghosts..., version);
  if (storage.valid_cells) new (walk->cells) typename W::Cells(*storage.valid_cells);
  cursor.owner = owner;
  return *walk;
}

/// Fills the cache with the cell at a valid base index. `convert` converts a stored value to a corner; `finite` returns whether a corner is
/// finite.
template <class W, class Storage, class Convert, class Finite>
void fetch_cell(W& walk, const Storage& storage, const Index3& base, const Convert& convert, const Finite& finite) {
  const nanovdb::Coord ijk = to_nano_coord(base);
  const int mx = base.x & 7, my = base.y & 7, mz = base.z & 7;
  const auto* leaf = mx < 7 && my < 7 && mz < 7 ? walk.values.probeLeaf(ijk) : nullptr;
  if (leaf) {
    const int at = mx * 64 + my * 8 + mz, sx = storage.step.x * 64, sy = storage.step.y * 8, sz = storage.step.z;
    for (int n = 0; n < 8; ++n)
      walk.corner[n] = convert(leaf->getValue(static_cast<std::uint32_t>(at + (n & 1) * sx + (n >> 1 & 1) * sy + (n >> 2) * sz)));
  } else {
    for (int n = 0; n < 8; ++n)
      walk.corner[n] = convert(walk.values.getValue(
          {base.x + (n & 1) * storage.step.x, base.y + (n >> 1 & 1) * storage.step.y, base.z + (n >> 2) * storage.step.z}));
  }
  walk.base = base;
  walk.filled = true;
  walk.valid = true;
  if (storage.valid_cells) walk.valid = std::launder(reinterpret_cast<typename W::Cells*>(walk.cells))->getValue(ijk);
  for (int n = 0; n < 8; ++n) walk.valid = walk.valid && finite(walk.corner[n]);
}

/// Fills a cubic cache with the samples around a valid base index, read by blocks, at most two per axis. Halo samples replace missing
/// samples.
template <class W, class Storage>
void fetch_cubic_samples(W& walk, const Storage& storage, const Index3& base) {
  constexpr int C = sizeof(typename Storage::Value) / sizeof(float);
  const std::int32_t first[3] = {base.x - storage.step.x, base.y - storage.step.y, base.z - storage.step.z};
  const std::int32_t step[3] = {storage.step.x, storage.step.y, storage.step.z};
  int split[3];  // number of samples in the first block
  for (int a = 0; a < 3; ++a) split[a] = step[a] == 0 ? 4 : std::min(4, 8 - (first[a] & 7));
  const bool inner = storage.is_legal_base({first[0], first[1], first[2]}) &&
                     storage.is_legal_base({base.x + storage.step.x, base.y + storage.step.y, base.z + storage.step.z});
  const bool all_valid = inner && !storage.has_invalid_cells;
  for (int part = 0; part < 8; ++part) {
    int from[3], to[3];
    for (int a = 0; a < 3; ++a) {
      const bool second = (part >> a & 1) != 0;
      from[a] = second ? split[a] : 0;
      to[a] = second ? 4 : split[a];
    }
    if (from[0] >= to[0] || from[1] >= to[1] || from[2] >= to[2]) continue;
    const nanovdb::Coord corner(first[0] + from[0] * step[0], first[1] + from[1] * step[1], first[2] + from[2] * step[2]);
    const auto* leaf = walk.values.probeLeaf(corner);
    const auto* ghosts = all_valid ? nullptr : walk.halo.probeLeaf(corner);
    const auto constant = leaf ? typename Storage::Value(0.f) : walk.values.getValue(corner);
    for (int z = from[2]; z < to[2]; ++z)
      for (int y = from[1]; y < to[1]; ++y)
        for (int x = from[0]; x < to[0]; ++x) {
          const auto n = static_cast<std::uint32_t>(((first[0] + x * step[0]) & 7) * 64 + ((first[1] + y * step[1]) & 7) * 8 +
                                                    ((first[2] + z * step[2]) & 7));
          auto value = leaf ? leaf->getValue(n) : constant;
          if (ghosts && ghosts->valueMask().isOn(n)) value = ghosts->getValue(n);
          float* out = &walk.samples[static_cast<std::size_t>(C * (x + 4 * y + 16 * z))];
          if constexpr (C == 1)
            *out = value;
          else
            for (int c = 0; c < 3; ++c) out[c] = value[c];
        }
  }
}

/// Returns why a position is not inside, given the cache at its cell. `finite` returns whether a corner is finite.
template <class W, class Finite>
SampleStatus cell_status(const W& walk, const Box& box, const Vec3& index, const Finite& finite) {
  if (!box.contains(index, kDomainSlack)) return SampleStatus::outside_box;
  if (walk.valid) return SampleStatus::ok;
  for (const auto& corner : walk.corner)
    if (!finite(corner)) return SampleStatus::not_finite;
  return SampleStatus::masked;
}

/// Calls visit(accessor, block origin, first, after) for every aligned 8^3 block that intersects the region; `first` is the first voxel of
/// the intersection, `after` is one past the last along each axis.
template <class Grid, class Visit>
void for_blocks(const Grid& grid, const Index3& origin, const Index3& size, const Visit& visit) {
  auto accessor = grid.getAccessor();
  const Index3 end{origin.x + size.x, origin.y + size.y, origin.z + size.z};
  for (std::int32_t bz = origin.z & ~7; bz < end.z; bz += 8)
    for (std::int32_t by = origin.y & ~7; by < end.y; by += 8)
      for (std::int32_t bx = origin.x & ~7; bx < end.x; bx += 8) {
        const Index3 first{std::max(bx, origin.x), std::max(by, origin.y), std::max(bz, origin.z)};
        const Index3 after{std::min(bx + 8, end.x), std::min(by + 8, end.y), std::min(bz + 8, end.z)};
        visit(accessor, nanovdb::Coord(bx, by, bz), first, after);
      }
}

}  // namespace catena::field
