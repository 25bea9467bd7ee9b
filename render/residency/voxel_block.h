/// Voxels of a box of a scalar grid, with what packing asks of them: their values, which of them belong to a valid cell, and the codes of
/// 8 bits that stand for values in the fast raycast (render/raycast/fast_volume.h).
#pragma once
#include <array>
#include <cstdint>
#include <functional>
#include <vector>

#include "engine/field/grid/grid.h"

namespace catena::render {

struct ValueInterval {
  double min = 0, max = 0;
  bool operator==(const ValueInterval&) const = default;
};

/// The voxels of a grid's index box, as whole numbers.
struct VoxelExtent {
  field::Index3 lo, size;
};
VoxelExtent voxel_extent(const field::ScalarGrid& grid);

/// Whether some cells of the grid may be invalid: a mask, values or a background that are not finite.
bool has_invalid_cells(const field::ScalarGrid& grid);

struct VoxelBlock {
  field::Index3 size;
  std::vector<float> values;       ///< x fastest; 0 where not finite
  std::vector<std::uint8_t> used;  ///< a voxel: some valid cell has it as a corner; empty: all of them are used

  /// `masked`: has_invalid_cells.
  void read(const field::ScalarGrid& grid, const field::Index3& origin, const field::Index3& box, bool masked);
  std::size_t voxel_index(int x, int y, int z) const {
    return (std::size_t(z) * std::size_t(size.y) + std::size_t(y)) * std::size_t(size.x) + std::size_t(x);
  }
  bool is_used(std::size_t i) const { return used.empty() || used[i] != 0; }
};

/// Values of voxels in use that stand for all: of about 64 blocks of 8^3, spread evenly.
std::vector<float> sample_values(const field::ScalarGrid& grid);

/// Widens `range` so that every cell of the block that `active` touches is whole within it: beyond `active` the picture is of one colour
/// and density, so that nothing else is lost by codes of `range` than their rounding.
void widen_to_cells(ValueInterval& range, const VoxelBlock& block, const ValueInterval& active);
/// The range without what lies beyond both `active` and the grid's display range: codes are not spent on outliers, which are clamped.
ValueInterval clip_outliers(ValueInterval range, const field::ScalarGrid& grid, const ValueInterval& active);

/// PlaneConstraints of a grid, kSlabPlanes at a time and in parallel, each time with `before` planes more in front of them and `behind`
/// behind, where the grid has them: no whole copy of a grid is made.
struct SlabRange {
  int first = 0, count = 0;  ///< planes
  int margin_before = 0, margin_after = 0;
};
struct Slab {
  int first, planes;  ///< of the grid
  int offset;         ///< the block's plane that is `first`
  const VoxelBlock& block;
};
inline constexpr int kSlabPlanes = 8;
void for_each_slab(const field::ScalarGrid& grid, const SlabRange& slabs, const std::function<void(const Slab&)>& body);

/// value = lo + code * per_code. A cell is valid where none of its corners has the code kInvalidCode, which only masked grids use.
struct CodeScale {
  static constexpr std::uint8_t kInvalidCode = 0;
  double lo = 0, per_code = 0;
  bool has_mask = false;

  CodeScale() = default;
  CodeScale(const ValueInterval& range, bool is_masked);
  std::uint8_t min_code() const { return has_mask ? 1 : 0; }
  /// Of `count` voxels of a block from `first` on.
  void encode(const VoxelBlock& block, std::size_t first, std::size_t count, std::uint8_t* out) const;
};

/// The codes of a brick's voxels that are in use.
struct CodeRange {
  std::uint8_t min = 255, max = 0;
  bool has_unused = false;  ///< some voxels are not in use

  bool empty() const { return min > max; }
};

/// What a transfer function makes of codes (make_preintegrated).
struct CodeAppearance {
  std::array<std::uint16_t, 256> appearance_id{};  ///< codes c and c + 1, and all between, look alike if their numbers are equal
  std::array<bool, 256> is_invisible{};            ///< and so are those that look like it

  /// 0: colour or density vary over the range; 1: nothing of it is seen; other numbers: it is of one colour and density, alike where they
  /// are equal.
  std::uint16_t classify(const CodeRange& range) const;
};

}  // namespace catena::render
