/// How data are shown of which nobody says how: the parts of a scene file, chosen by the kind of the data (data_kind.h). Inside this room
/// only. Levels and ranges are values of the field.
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

#include "engine/field/grid.h"
#include "engine/field/units.h"
#include "engine/scene/components.h"

namespace catena::scene {

struct FirstLook {
  std::string parts;     ///< members of a scene's object, without a comma at either end
  std::string fields{};  ///< more fields, ", NAME: {...}"
  bool labels = false;   ///< a label map: its nearest voxels count, and its table belongs to it
  bool whole = false;    ///< the mask only cuts away what is empty: without it surfaces are closed, with it they end in torn cells
  std::string shell{};   ///< of a body without a quantity: its surface once more, translucent, for what lies in it
  bool fibres = false;   ///< vectors of one length
  std::string note;      ///< one sentence: what the data look like, and why
};

/// `field`: its name in the scene, as JSON.
FirstLook first_look(const std::string& field, const field::ScalarGrid& grid, const field::Units& units, NamedColors colors);
FirstLook first_look(const std::string& field, const field::VectorGrid& grid, const NamedColors& colors);
/// , "color": MAP, "range": [LO, HI] and so on: what is stated of them.
std::string color_members(const NamedColors& colors);
/// Of a mesh: what goes beside it.
std::string soft_background();

}  // namespace catena::scene
