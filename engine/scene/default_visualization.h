/// How data are shown of which nobody says how: the parts of a scene file, chosen by the kind of the data (data_kind.h). Inside this room
/// only. ResolutionLevels and ranges are values of the field.
///   image        one or two voxels thick, whatever it holds: a slice in grey with its scalar bar
///   CT           the skin (-300 HU, translucent) over the bone (250 HU), where the values reach them
///   MR           the surface of what is not background: halfway from the background to Otsu's threshold, which dark tissue lies below
///   label map    the surface of all labels together, each in its colour, with a legend; the field is read by its nearest voxels
///   solid        the surface at Otsu's threshold; a level set's at 0
///   angiogram    the brightest value along each ray, grey
///   cloud        a shaded volume, grey to white
///   simulation   a volume with a perceptual map and its scalar bar, in its box
///   flow         lines that keep a distance from each other, coloured by speed with a scalar bar, in the box; fibres (unit length) in one
///                colour; three slices of the speed where no line begins
/// A stated colour map or range makes it a volume in these colours, whatever the kind.
#pragma once
#include <string>

#include "engine/field/grid/grid.h"
#include "engine/io/volume/units.h"
#include "engine/scene/components.h"

namespace catena::scene {

struct DefaultVisualization {
  std::string scene_members;    ///< members of a scene's object, without a comma at either end
  std::string extra_fields{};   ///< more fields, ", NAME: {...}"
  bool is_label_map = false;    ///< a label map: its nearest voxels count, and its table belongs to it
  bool ignore_mask = false;     ///< the mask only cuts away what is empty: without it surfaces are closed, with it they end in torn cells
  std::string shell_members{};  ///< of a body without a quantity: its surface once more, translucent, for what lies in it
  bool is_fibers = false;       ///< vectors of one length
  std::string note;             ///< one sentence: what the data look like, and why
};

/// `field`: its name in the scene, as JSON.
DefaultVisualization choose_default_visualization(const std::string& field, const field::ScalarGrid& grid, const field::Units& units,
                                                  NamedColors colors);
DefaultVisualization choose_default_visualization(const std::string& field, const field::VectorGrid& grid, const NamedColors& colors);
/// , "color": MAP, "range": [LO, HI] and so on: what is stated of them.
std::string color_members(const NamedColors& colors);
/// Of a mesh: what goes beside it.
std::string default_mesh_background();

}  // namespace catena::scene
