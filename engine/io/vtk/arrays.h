/// The arrays of a file by name, whichever blocks they are in, and what becomes of each as a field.
///   image       one block, an image: voxel by voxel as it lies; values of cells sit in the cells' middles
///   resampled   anything else with cells that have a volume (resample.h); values of cells are averaged at the points first
#pragma once
#include <vtkDataArray.h>

#include <string>
#include <vector>

#include "engine/io/protocol.h"
#include "engine/io/vtk/open.h"
#include "engine/io/vtk/resample.h"
#include "engine/io/vtk/validity_mask.h"

namespace catena::vtk {

/// An array's name; "data" where it has none.
std::string name_of(vtkDataArray& array);

struct FieldArray {
  std::string name;  ///< of the grid: the array's own; "NAME (cells)" where points have an array of the same name
  std::string array_name;
  bool is_cell_data = false;
  int components = 1;
  std::vector<std::size_t> block_indices;  ///< that have it
  vtkDataArray* find_in(const Block& block) const;
};

/// All that a field can be made of, in the order of the blocks: 1, 2 (a plane's vectors) or 3 components of numbers. Masks, ghosts and
/// identities are left out.
std::vector<FieldArray> list_field_arrays(const ImportedData& opened);
/// The words of arrays that cannot be fields: "tensor (9 components)".
std::vector<std::string> list_unsupported_arrays(const ImportedData& opened);

/// The voxels of an image.
struct ImageGrid {
  field::Index3 size;  ///< at least 2 an axis: flat data are written twice
  field::Mapping mapping;
  bool is_flat[3] = {false, false, false};
};
/// nullopt: it is not an image.
std::optional<ImageGrid> find_image_grid(const ImportedData& opened, const FieldArray& column);

/// Writes the voxels of an image; says whether all were 32-bit floats already, and which are valid (1). `cells`, where it is not null, gets
/// the same of the cells based at the voxels (values of points).
struct ImageWriteResult {
  bool is_exact = true;  ///< no number was rounded
  bool all_valid = true;
  bool has_cell_mask = false;  ///< they say more than the voxels
};
ImageWriteResult write_image(const ImportedData& opened, const FieldArray& column, const ImageGrid& grid, const ValidityMask& seen,
                             float* values, std::uint8_t* valid, std::uint8_t* cells);

/// The blocks of a column as the cells that are data, with values at their points. `seen`: of each block (seen.h). `keep` holds what was
/// made for them.
std::vector<CellValues> make_cell_values(const ImportedData& opened, const FieldArray& column, const std::vector<ValidityMask>& seen,
                                         std::vector<vtkSmartPointer<vtkDataSet>>& keep);

/// Values of the array itself, of all blocks, where they are data.
field::GridStats compute_stats(const ImportedData& opened, const FieldArray& column, const std::vector<ValidityMask>& seen);
/// The display range of the same values.
DisplayRange compute_display_range(const ImportedData& opened, const FieldArray& column, const std::vector<ValidityMask>& seen,
                                   const field::GridStats& stats);

}  // namespace catena::vtk
