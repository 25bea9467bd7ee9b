/// Private to this room: a grid as the box of its voxels, for formats that hold nothing else. One writer a format.
#pragma once
#include <cstdint>
#include <span>
#include <string>

#include "engine/field/field.h"
#include "engine/io/volume/units.h"

namespace catena::field {

class VoxelBox {
 public:
  VoxelBox(const AnyField& field, const std::string& name, const Units& units);

  std::string name;
  Units units;
  Mapping mapping;  ///< of voxel (0, 0, 0) of the box
  Index3 size;
  int components = 1;          ///< 1 or 3
  bool has_mask = false;       ///< some voxel may be invalid
  bool has_cell_mask = false;  ///< beside the voxels some cells are invalid of themselves

  std::size_t layer_voxels() const { return static_cast<std::size_t>(size.x) * static_cast<std::size_t>(size.y); }
  double voxels() const { return static_cast<double>(size.x) * size.y * size.z; }
  /// One layer across z, x fastest; of vectors all components of a voxel together.
  void read_values(std::int32_t z, std::span<float> out) const;
  void read_valid(std::int32_t z, std::span<std::uint8_t> out) const;  ///< 0 or 1; all 1 without a mask
  /// The same of the cells based at the voxels of one layer. Those based at the last voxel of an axis are none: 1.
  void read_cells(std::int32_t z, std::span<std::uint8_t> out) const;
  /// The same values, NaN where a voxel is invalid.
  void read_values_or_nan(std::int32_t z, std::span<float> out) const;

 private:
  AnyField field_;
  Index3 first_index_;
};

Outcome write_vti(const std::string& path, const VoxelBox& box);
Outcome write_nrrd(const std::string& path, const VoxelBox& box);
Outcome write_nifti(const std::string& path, const VoxelBox& box);

}  // namespace catena::field
