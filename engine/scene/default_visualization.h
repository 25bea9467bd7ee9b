// SPDX-License-Identifier: MIT
/// Default visualization of grids: parts of a scene file, chosen by the kind of data (classify_scalar.h, classify_vector.h). Levels
/// and ranges are in the field's unit.
///   image        grid that is one or two voxels thick, whatever its kind: a slice with its scalar bar, gray in patient space and for
///                integers (photographs, microscopy), else in the colors of a quantity
///   CT           skin (-300 HU, translucent) and bone (250 HU), as far as the values reach these levels
///   MR           one surface at the level halfway from the background to Otsu's threshold, which includes dark tissue
///   label map    one surface around all labels, each in its own color, with a legend; nearest-voxel interpolation
///   solid        surface at Otsu's threshold; for a level set at 0
///   statistic    the two tails beyond the 95 percentile of the magnitudes, blue and red about 0
///   decades      volume on a logarithmic scale from the 16 percentile on, with its scalar bar
///   inclusions   the body as a translucent shell around the surface of its bright parts
///   two phases   volume that is opaque above Otsu's threshold, so that faces of the box show the cut material
///   angiogram    maximum intensity projection in gray, on black
///   cloud        shaded volume, gray to white
///   simulation   volume with a perceptually uniform map, its scalar bar and a bounding box
///   flow         evenly spaced lines, colored by speed, with scalar bar and bounding box; fibers (unit length or line field) in one
///                color; three slices of the speed if no line can be traced
/// The background is that of scenes, black: volumes and maximum intensities are mixed with it, and dark parts of an image must not be
/// darker than the background. Colors of quantities start well above it.
/// If colors, opacities or a preset are requested, or all values are equal, any scalar grid but an image is a volume with them.
#pragma once
#include <string>

#include "engine/field/grid/grid.h"
#include "engine/io/volume/units.h"
#include "engine/scene/components.h"
#include "engine/scene/label_groups.h"

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
/// Replaces the surface of a label map by one surface a group; groups of opacity 0 are left out.
void show_label_groups(const std::string& field, const std::vector<LabelGroup>& groups, DefaultVisualization& visualization);
/// Returns the specified colors as further members: `, "color": MAP, "range": [MIN, MAX]` and so on.
std::string color_members(const NamedColors& colors);

}  // namespace catena::scene
