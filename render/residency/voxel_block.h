// SPDX-License-Identifier: MIT
/// Voxels of a box of a scalar grid, as needed for packing: their values, which of them belong to a valid cell, and the 8-bit codes that
/// represent values in the fast raycast (render/raycast/fast_volume.h).
#pragma once
#include <array>
#include <cstdint>
#include <functional>
#include <vector>

#include "engine/field/grid/grid.h"

namespace catena::render {

/// Interval of field values.
struct ValueInterval {
  double min = 0, max = 0;
  bool operator==(const ValueInterval&) const = default;
};

/// Voxels of a grid's index box, as integers.
struct VoxelExtent {
  field::Index3 lo, size;
};
/// Returns the voxel box of a grid.
VoxelExtent voxel_extent(const field::ScalarGrid& grid);

/// Returns whether some cells of the grid may be invalid: it has a mask, or values or a background that are not finite.
bool has_invalid_cells(const field::ScalarGrid& grid);

/// Voxel values of a box.
struct VoxelBlock {
  field::Index3 size;
  std::vector<float> values;       ///< x fastest; 0 where not finite
  std::vector<std::uint8_t> used;  ///< per voxel: it is a corner of a valid cell; empty: all voxels are

  /// Reads the voxels of a box from `origin` on. `masked`: result of has_invalid_cells().
  void read(const field::ScalarGrid& grid, const field::Index3& origin, const field::Index3& box, bool masked);
  std::size_t voxel_index(int x, int y, int z) const {
    return (std::size_t(z) * std::size_t(size.y) + std::size_t(y)) * std::size_t(size.x) + std::size_t(x);
  }
  bool is_used(std::size_t i) const { return used.empty() || used[i] != 0; }
};

/// Returns a representative sample of the values of used voxels: from about 64 blocks of 8^3, spread evenly.
std::vector<float> sample_values(const field::ScalarGrid& grid);

/// Widens `range` so that it includes all values of every cell of the block that `active` touches: beyond `active` the image has a constant
/// color and extinction, so that encoding in `range` loses nothing but rounding.
void widen_to_cells(ValueInterval& range, const VoxelBlock& block, const ValueInterval& active);
/// Returns the range without the part beyond both `active` and the grid's display range: outliers are clamped instead of taking up codes.
ValueInterval clip_outliers(ValueInterval range, const field::ScalarGrid& grid, const ValueInterval& active);

/// Slabs of a grid: kSlabPlanes planes at a time, processed in parallel, each with `margin_before` extra planes in front and `margin_after`
/// behind, as far as the grid has them: the grid is never copied as a whole.
struct SlabRange {
  int first = 0, count = 0;  ///< first plane and number of planes
  int margin_before = 0, margin_after = 0;
};
/// One slab, as passed to the body of for_each_slab().
struct Slab {
  int first, planes;  ///< planes of the grid
  int offset;         ///< plane of the block that corresponds to `first`
  const VoxelBlock& block;
};
inline constexpr int kSlabPlanes = 8;
/// Calls `body` for every slab, from several threads at a time.
void for_each_slab(const field::ScalarGrid& grid, const SlabRange& slabs, const std::function<void(const Slab&)>& body);

/// Range of the codes of a brick's used voxels.
struct CodeRange {
  std::uint8_t min = 255, max = 0;  ///< some voxels are not used
  bool has_unused = false;          ///< some voxels are not in use

  bool empty() const { return min > max; }
};

/// Scale of codes of 8 or 16 bits: value = lo + code * per_code. A cell is valid if none of its corners has the code kInvalidCode, which
/// only masked grids use.
struct CodeScale {
  static constexpr std::uint8_t kInvalidCode = 0;
  double lo = 0, per_code = 0;
  bool has_mask = false;
  int max_code = 255;
  /// Of 16-bit codes: a CodeRange is in units of range_step codes above range_lo.
  int range_lo = 0, range_step = 1;

  bool operator==(const CodeScale&) const = default;
  CodeScale() = default;
  CodeScale(const ValueInterval& range, bool is_masked, int bits = 8);
  std::uint8_t min_code() const { return has_mask ? 1 : 0; }
  /// Codes of a value between two are the lower or the upper one by the voxel's position, so that the mean is right.
  bool is_dithered = false;
  /// Returns the function that encodes finite values, as codes of a type that holds them; rounds down after adding `offset`.
  template <class Code = std::uint8_t>
  auto encoder() const {
    return [zero = float(lo), scale = per_code > 0 ? float(1 / per_code) : 0.0f, least = float(min_code()), most = float(max_code)](
               float value, float offset = 0.5f) {
      const float code = (value - zero) * scale + offset;
      return Code(code > least ? (code < most ? code : most) : least);
    };
  }
  /// Returns the range of codes from min to max: of 16-bit codes, min >= lower_end(range.min) and max < lower_end(range.max).
  CodeRange range_of(int min, int max, bool has_unused) const;
  /// Returns the smallest 16-bit code of a unit of CodeRange; the first and the last unit have no lower and no upper end.
  double lower_end(int unit) const;
  /// Encodes `count` voxels of a block from `first` on.
  void encode(const VoxelBlock& block, std::size_t first, std::size_t count, std::uint8_t* out) const;
};

/// Classification of codes by a transfer function (make_preintegrated).
struct CodeAppearance {
  std::array<std::uint16_t, 256>
      appearance_id{};  ///< codes c and c + 1, and all values between them, have the same appearance if their numbers are equal
  std::array<bool, 256> is_invisible{};  ///< invisible; applies to all codes with the same number

  /// Returns 0 if color or extinction vary over the range, 1 if it is completely invisible, else a number that identifies its constant
  /// color and extinction.
  std::uint16_t classify(const CodeRange& range) const;
};

}  // namespace catena::render
