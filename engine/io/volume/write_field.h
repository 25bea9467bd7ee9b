/// Writing of grids for other programs. The ending of the name says how:
///   .vdb           as it is: the grid's tree and its masks: "valid" of voxels, and "valid_cells" beside it where cells are masked
///   .vti           VTK's XML image data, raw appended floats; rotated and mirrored axes, no sheared ones; voxels that are not valid are
///                  hidden points, masked cells hidden cells (vtkGhostType)
///   .nrrd          raw floats, any axes; vectors as "vector domain domain domain"
///   .nii, .nii.gz  NIfTI-1 with an sform, any axes in single precision; vectors as 5 dimensions with the intent VECTOR
/// All but .vdb hold the box of the grid's voxels, layer by layer: where a sparse grid holds nothing its background, where a voxel of an
/// .nrrd or a NIfTI file is not valid NaN. An output is whole or not there. Errors name the output. Any thread.
#pragma once
#include <string>
#include <string_view>

#include "engine/base/result.h"
#include "engine/io/volume/load_field.h"
#include "engine/io/volume/units.h"

namespace catena::field {

bool is_writable_format(std::string_view path);  ///< by its ending
std::string writable_extensions();               ///< ".vdb, .vti, .nrrd, .nii or .nii.gz"

/// `field`: a grid. What `units` says of lengths and of a patient's axes goes with it where the format has a place.
Outcome write_field(const std::string& path, const AnyField& field, const std::string& name, const Units& units);

/// What of a mask of cells the output at `path` cannot hold, as a sentence without an end; empty: nothing.
std::string lost_mask_note(const std::string& path, const AnyField& field);

/// Reads one grid of any file and writes it. Returns its name in the output: `name`, else its own, else the file's. `notes`: those of
/// AnyField.
Result<std::string> convert_file(const LoadRequest& request, const std::string& path, const std::string& name,
                                 std::vector<std::string>* notes = nullptr);

}  // namespace catena::field
