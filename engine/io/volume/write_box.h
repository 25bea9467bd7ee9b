// SPDX-License-Identifier: MIT
/// Private to this module: a grid as a dense box of voxels, for formats that store nothing else. One writer per format.
#pragma once
#include <cstdint>
#include <span>
#include <string>

#include "engine/field/field.h"
#include "engine/io/volume/units.h"

namespace catena::field {

/// Reads a grid slice by slice as the dense box of its voxels.
class VoxelBox {
 public:
  VoxelBox(const AnyField& field, const std::string& name, const Units& units);

  std::string name;
  Units units;
  Mapping mapping;  ///< World from index; voxel (0, 0, 0) is the first one of the box.
  Index3 size;
  int components = 1;          ///< 1 or 3.
  bool has_mask = false;       ///< Some voxels may be invalid.
  bool has_cell_mask = false;  ///< Some cells may be invalid in addition to those with an invalid voxel.

  /// Number of voxels in a slice.
  std::size_t layer_voxels() const { return static_cast<std::size_t>(size.x) * static_cast<std::size_t>(size.y); }
  /// Number of voxels in the box.
  double voxels() const { return static_cast<double>(size.x) * size.y * size.z; }
  /// Reads the slice at z, x fastest; vectors interleaved.
  void read_values(std::int32_t z, std::span<float> out) const;
  void read_valid(std::int32_t z, std::span<std::uint8_t> out) const;  ///< 0 or 1; all 1 without a mask.
  /// Reads the validity (0 or 1) of the cells based at the voxels of a slice; 1 at the last voxel of an axis, where there is no cell.
  void read_cells(std::int32_t z, std::span<std::uint8_t> out) const;
  /// Reads the values of a slice, with NaN where a voxel is invalid.
  void read_values_or_nan(std::int32_t z, std::span<float> out) const { read_values_or_nan({0, 0, z}, {size.x, size.y, 1}, out); }
  /// Reads the values of `count` voxels from `lo` on, with NaN where a voxel is invalid.
  void read_values_or_nan(const Index3& lo, const Index3& count, std::span<float> out) const;

 private:
  AnyField field_;
  Index3 first_index_;
};

/// Writes the header and the slices of a volume as a VolumeWriter (engine/io/formats.h). Error: the box does not fit the memory budget,
/// which a reader of the file needs as well.
Outcome write_box_with(Outcome (*write)(const std::string& path, const VoxelBox& box), const std::string& path, const AnyField& field,
                       const std::string& name, const Units& units);
/// write_box_with() as a function of its own.
template <Outcome (*Write)(const std::string& path, const VoxelBox& box)>
Outcome write_box(const std::string& path, const AnyField& field, const std::string& name, const Units& units) {
  return write_box_with(Write, path, field, name, units);
}

/// Writes a VTK XML image file; see write_field.h.
Outcome write_vti(const std::string& path, const VoxelBox& box);
/// Writes an NRRD file.
Outcome write_nrrd(const std::string& path, const VoxelBox& box);
/// Writes a NIfTI-1 file.
Outcome write_nifti(const std::string& path, const VoxelBox& box);

}  // namespace catena::field
