// SPDX-License-Identifier: MIT
/// Writes grids for other programs. The file extension selects the format:
///   .vdb           unchanged: the tree of the grid and its masks: "valid" of voxels, and also "valid_cells" if there is a cell mask
///   .vti           VTK XML image data, raw appended floats; rotated and mirrored axes, but no sheared ones; invalid voxels are hidden
///                  points, masked cells hidden cells (vtkGhostType)
///   .nrrd          raw floats, any axes; vectors as "vector domain domain domain"
///   .zarr          OME-Zarr 0.4 with levels, scalars only, NaN where a voxel is invalid (engine/io/zarr/write_zarr.h)
///   .nii, .nii.gz  NIfTI-1 with an sform, any axes in single precision; vectors as 5 dimensions with the intent VECTOR
/// All but .vdb store the box of the grid's voxels, slice by slice: the background where a sparse grid has no voxels, NaN where a voxel of
/// an .nrrd or NIfTI file is invalid. Writing is atomic. Errors name the output. Any thread.
#pragma once
#include <string>
#include <string_view>

#include "engine/base/result.h"
#include "engine/io/volume/load_field.h"
#include "engine/io/volume/units.h"
#include "engine/io/zarr/write_zarr.h"

namespace catena::field {

/// Writes a grid. The length unit and the patient space in `units` are stored if the format supports them. Returns an Error for an unknown
/// extension, too little memory or a failed write.
Outcome write_field(const std::string& path, const AnyField& field, const std::string& name, const Units& units);

/// Returns a message, without a final period, on data that the output at `path` cannot store: cells masked between valid voxels, and voxel
/// positions far from the origin in single precision (NIfTI); empty: nothing is lost.
std::string lost_mask_note(const std::string& path, const AnyField& field);

/// Reads one grid of any file and writes it. Returns the name in the output: `name`, else its own, else the file's. `notes`: receives
/// AnyField::notes and lost_mask_note(). A .zarr is written in streams: stores and .raw files may be larger than memory; `progress` is
/// called for these.
Result<std::string> convert_file(const LoadRequest& request, const std::string& path, const std::string& name,
                                 std::vector<std::string>* notes = nullptr, const WriteProgress& progress = {});

}  // namespace catena::field
