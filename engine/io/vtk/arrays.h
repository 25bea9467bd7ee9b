// SPDX-License-Identifier: MIT
/// The arrays of a file by name, across blocks, and their conversion to fields:
///   image       one block that is an image: voxel by voxel; cell values are placed at the cell centers
///   resampled   any other data whose cells have a volume (resample.h); cell values are first averaged at the points
#pragma once
#include <vtkDataArray.h>

#include <string>
#include <vector>

#include "engine/io/protocol.h"
#include "engine/io/vtk/open.h"
#include "engine/io/vtk/resample.h"
#include "engine/io/vtk/validity_mask.h"

namespace catena::vtk {

/// Name of an array; "data" if it has none.
std::string name_of(vtkDataArray& array);

/// A point or cell array that can become a field.
struct FieldArray {
  std::string name;  ///< Name of the grid: that of the array; "NAME (cells)" if points have an array with the same name.
  std::string array_name;
  bool is_cell_data = false;
  int components = 1;
  std::vector<std::size_t> block_indices;  ///< Blocks that have the array.
  /// Returns the array in a block; null: the block does not have it.
  vtkDataArray* find_in(const Block& block) const;
};

/// Lists the arrays that can become fields, in the order of the blocks: 1, 2 (vectors in a plane) or 3 numeric components. Masks, ghost
/// flags and ids are omitted.
std::vector<FieldArray> list_field_arrays(const ImportedData& opened);
/// Lists the arrays with too many components for a field, as "tensor (9 components)".
std::vector<std::string> list_unsupported_arrays(const ImportedData& opened);

/// The voxel grid of an image.
struct ImageGrid {
  field::Index3 size;  ///< At least 2 per axis: the slice of a flat image is stored twice.
  field::Mapping mapping;
  /// Axes along which the image is one voxel thick.
  bool is_flat[3] = {false, false, false};
};
/// Returns the voxel grid of an image; nullopt: the data are not an image.
std::optional<ImageGrid> find_image_grid(const ImportedData& opened, const FieldArray& column);

/// Result of write_image().
struct ImageWriteResult {
  bool is_exact = true;  ///< No number was rounded to a 32-bit float.
  bool all_valid = true;
  bool has_cell_mask = false;  ///< The cell mask excludes more than the voxel mask.
};
/// Writes the voxels of an image: `values` as 32-bit floats, x fastest, `valid` as 1 or 0 per voxel, and, unless `cells` is null, 1 or 0
/// for the cell based at each voxel (point data only).
ImageWriteResult write_image(const ImportedData& opened, const FieldArray& column, const ImageGrid& grid, const ValidityMask& mask,
                             float* values, std::uint8_t* valid, std::uint8_t* cells);

/// Returns the valid cells of the blocks that have an array, with values at their points. `masks`: the validity mask of each block
/// (validity_mask.h). `owned` receives the data sets created for them, which must live as long as the result.
std::vector<CellValues> make_cell_values(const ImportedData& opened, const FieldArray& column, const std::vector<ValidityMask>& masks,
                                         std::vector<vtkSmartPointer<vtkDataSet>>& owned);

/// Returns the statistics of the array's own values, over all blocks, where they are valid.
field::GridStats compute_stats(const ImportedData& opened, const FieldArray& column, const std::vector<ValidityMask>& masks);
/// Returns the display range of the array's own values, over all blocks, where they are valid.
DisplayRange compute_display_range(const ImportedData& opened, const FieldArray& column, const std::vector<ValidityMask>& masks,
                                   const field::GridStats& stats);

}  // namespace catena::vtk
