// SPDX-License-Identifier: MIT
/// Default visualization of grids: parts of a scene file, chosen by the kind of data (classify_scalar.h, classify_vector.h). Private to
/// this module. Levels and ranges are in the field's unit.
///   image        grid that is one or two voxels thick, whatever its kind: a slice in gray with its scalar bar
///   CT           skin (-300 HU, translucent) and bone (250 HU), as far as the values reach these levels
///   MR           one surface at the level halfway from the background to Otsu's threshold, which includes dark tissue
///   label map    one surface around all labels, each in its own color, with a legend; nearest-voxel interpolation
///   solid        surface at Otsu's threshold; for a level set at 0
///   angiogram    maximum intensity projection in gray, on black
///   cloud        shaded volume, gray to white
///   simulation   volume with a perceptually uniform map, its scalar bar and a bounding box
///   flow         evenly spaced lines, colored by speed, with scalar bar and bounding box; fibers (unit length or line field) in one
///                color; three slices of the speed if no line can be traced
/// If colors, opacities or a preset are requested, or all values are equal, any scalar grid but an image is a volume with them.
#pragma once
#include <string>

#include "engine/field/grid/grid.h"
#include "engine/io/volume/units.h"
#include "engine/scene/components.h"

namespace catena::scene {

/// Parts of a scene file that show one grid.
struct DefaultVisualization {
  std::string scene_members;   ///< Members of a scene object, without a comma at either end
  std::string extra_fields{};  ///< Further entries of "fields", as ", NAME: {...}"
  bool is_label_map = false;   ///< Label map: use nearest-voxel interpolation and the label table beside the file
  /// True if the mask should be ignored: it removes only empty space, and surfaces are closed without it but open at invalid cells with it.
  bool ignore_mask = false;
  std::string shell_members{};  ///< Solid, level set: its surface as a translucent shell, for use around other data
  bool is_fibers = false;       ///< Vectors of unit length
  std::string note;             ///< One sentence: the kind of data and the reason
};

/// Chooses the visualization of a grid. `field`: its name in the scene, as a JSON string.
DefaultVisualization choose_default_visualization(const std::string& field, const field::ScalarGrid& grid, const field::Units& units,
                                                  const FileColors& colors);
DefaultVisualization choose_default_visualization(const std::string& field, const field::VectorGrid& grid, const NamedColors& colors);
/// Returns the specified colors as further members: `, "color": MAP, "range": [MIN, MAX]` and so on.
std::string color_members(const NamedColors& colors);
/// Returns the background member of the default scene of meshes; all default scenes but angiograms use it.
std::string default_mesh_background();

}  // namespace catena::scene
