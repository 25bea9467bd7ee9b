// SPDX-License-Identifier: MIT
/// Grids from volumes that are read slice by slice, so nothing of the size of the whole volume is allocated besides the grid. Private to
/// this module.
#pragma once
#include <nanovdb/NanoVDB.h>

#include <array>
#include <cmath>
#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "engine/base/display_range.h"
#include "engine/base/result.h"
#include "engine/field/grid/grid.h"
#include "engine/field/nanovdb/nano_builder.h"

namespace catena::field {

/// Source of a box of voxels that starts at index (0, 0, 0). `read` is called for eight slices at a time (for the rest at the end), with
/// ascending z: x fastest, then y, then z; vectors as three numbers per voxel. Its errors are complete messages.
struct DenseSource {
  Index3 size;
  bool has_mask = false;  ///< `valid` is requested too: 0 or 1 per voxel
  std::function<Outcome(int z, int layers, std::span<float> values, std::span<std::uint8_t> valid)> read;
  /// Optional, only with `has_mask`; empty: the mask is one of voxels. Called after `read` for the same slices. Writes 1 where the cell
  /// based at the voxel may be valid. `valid` must exclude voxels that no such cell touches.
  std::function<Outcome(int z, int layers, std::span<std::uint8_t> cells)> read_cells{};
  std::optional<DisplayRange> range{};  ///< display range of the original data, when these values were resampled
};

/// Returns true when a stored value is finite.
inline bool is_finite_value(float v) { return std::isfinite(v); }
inline bool is_finite_value(const nanovdb::Vec3f& v) { return std::isfinite(v[0]) && std::isfinite(v[1]) && std::isfinite(v[2]); }

/// Eight slices in memory, seen as blocks of 8^3. T: float or nanovdb::Vec3f.
template <class T>
class DenseSlab {
 public:
  explicit DenseSlab(const DenseSource& source);
  /// Returns the memory of a slab in bytes.
  static double bytes(const Index3& size, bool masked);

  /// Reads the slices from z on, a multiple of 8.
  Outcome read(int z);
  /// Returns the number of blocks in the slab.
  std::size_t block_count() const { return static_cast<std::size_t>(blocks_x_) * blocks_y_; }
  /// Returns the first voxel of a block.
  nanovdb::Coord origin(std::size_t block) const;
  /// Returns true when all voxels of the block that lie in the box have the same finite value, to the bit; sets `value`. Blocks with NaN or
  /// infinities return false and keep their leaf.
  bool is_constant(std::size_t block, T& value) const;
  /// Copies the voxels of the block that lie in the box, in the order of a leaf.
  void gather(std::size_t block, T* values, nanovdb::Mask<3>& active) const;
  /// Copies the bits of `valid` (or of the mask of cells) of a block.
  void gather_valid(std::size_t block, nanovdb::Mask<3>& valid) const { gather_bits(block, valid_, valid); }
  void gather_cells(std::size_t block, nanovdb::Mask<3>& cells) const { gather_bits(block, cells_, cells); }

 private:
  template <class Visit>
  void for_voxels(std::size_t block, const Visit& visit) const;
  void gather_bits(std::size_t block, const std::vector<std::uint8_t>& bytes, nanovdb::Mask<3>& bits) const;

  const DenseSource& source_;
  int blocks_x_, blocks_y_, z_ = 0, layers_ = 0;  ///< blocks along x and y; first slice and number of slices in memory
  std::vector<T> values_;
  std::vector<std::uint8_t> valid_, cells_;
};

/// Makes a grid from a source. Error: `PREFIX...` for data that are not usable as a field ("x.raw: the data has no finite value in any
/// active voxel"), or an error of `read`. `drop_full_mask`: a mask without any invalid voxel is dropped.
template <class Grid>
Result<std::shared_ptr<const Grid>> make_dense_grid(std::string name, const Mapping& mapping, const DenseSource& source,
                                                    const std::string& prefix, bool drop_full_mask = false);

/// Checks the memory budget for the maximum that make_dense_grid() allocates, and its limit of 4e9 blocks of 8^3 voxels; `what` as in
/// check_memory_available().
Outcome check_dense_memory(const std::string& what, const Index3& size, int components, bool masked);

}  // namespace catena::field
