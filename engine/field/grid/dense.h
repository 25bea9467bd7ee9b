/// Private to this room: volumes that come layer by layer. Nothing of the size of the whole stands beside the grid that is made of them.
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

/// A box of voxels from index (0, 0, 0). `read` is asked for eight layers at a time (the last time for what is left), z rising: x fastest,
/// then y, then z; vectors as three numbers a voxel. Its errors are whole sentences.
struct DenseSource {
  Index3 size;
  bool has_mask = false;  ///< `valid` is asked for too: 0 or 1 a voxel
  std::function<Outcome(int z, int layers, std::span<float> values, std::span<std::uint8_t> valid)> read;
  /// With `masked` only, asked for after `read` for the same layers; empty: the mask is one of voxels. 1 where the cell based at the voxel
  /// may be valid. Voxels that no such cell touches are not valid, and `valid` says so.
  std::function<Outcome(int z, int layers, std::span<std::uint8_t> cells)> read_cells{};
  std::optional<DisplayRange> range{};  ///< of the data that these were resampled from
};

inline bool is_finite_value(float v) { return std::isfinite(v); }
inline bool is_finite_value(const nanovdb::Vec3f& v) { return std::isfinite(v[0]) && std::isfinite(v[1]) && std::isfinite(v[2]); }

/// Eight layers in memory, seen as blocks of 8^3. T: float or nanovdb::Vec3f.
template <class T>
class DenseSlab {
 public:
  explicit DenseSlab(const DenseSource& source);
  static double bytes(const Index3& size, bool masked);

  Outcome read(int z);  ///< a multiple of 8
  std::size_t block_count() const { return static_cast<std::size_t>(blocks_x_) * blocks_y_; }
  nanovdb::Coord origin(std::size_t block) const;
  /// The block lies within the box and holds one finite value, the same to the bit. NaN and infinities keep their leaf.
  bool is_constant(std::size_t block, T& value) const;
  /// All voxels of the block that lie in the box, in the order of a leaf.
  void gather(std::size_t block, T* values, nanovdb::Mask<3>& active) const;
  void gather_valid(std::size_t block, nanovdb::Mask<3>& valid) const { gather_bits(block, valid_, valid); }
  void gather_cells(std::size_t block, nanovdb::Mask<3>& cells) const { gather_bits(block, cells_, cells); }

 private:
  template <class Visit>
  void for_voxels(std::size_t block, const Visit& visit) const;
  void gather_bits(std::size_t block, const std::vector<std::uint8_t>& bytes, nanovdb::Mask<3>& bits) const;

  const DenseSource& source_;
  int blocks_x_, blocks_y_, z_ = 0, layers_ = 0;  ///< blocks along x and y; layers in memory
  std::vector<T> values_;
  std::vector<std::uint8_t> valid_, cells_;
};

/// What is wrong with the data as a field is told as `PREFIX...`: "x.raw: the data has no finite value in any active voxel".
/// With `drop_full_mask` a mask without a single invalid voxel is none.
template <class Grid>
Result<std::shared_ptr<const Grid>> make_dense_grid(std::string name, const Mapping& mapping, const DenseSource& source,
                                                    const std::string& prefix, bool drop_full_mask = false);

/// Asks for what make_dense_grid takes at most; `what` as in check_memory_available.
Outcome check_dense_memory(const std::string& what, const Index3& size, int components, bool masked);

}  // namespace catena::field
