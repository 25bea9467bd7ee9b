/// DrawState-made modes: one item of a scene's chain that stands for several links, in order.      (paper, section 6.1)
///   anisotropic_friction   NAME_surface    isosurface: the hand on a level of a scalar field (p_s)
///                          NAME_direction  friction across the tangential part of a vector field (p_c)
///                          NAME_friction   friction modulated by the field's angle to the surface, Eqs. 7-9 (p_f)
/// A mode is an entry of a table: which of its keys go to which link, under which name. Of the common keys stiffness, on and enabled go to
/// all links, the others to the first. Values keep their file and line, so that errors name the place in the scene.
/// Off the tick.
#pragma once
#include "haptics/constraints/registry.h"

namespace catena::haptics {

struct ModePreset {
  struct KeyMapping {
    std::string_view from, to;  ///< the mode's key, the link's key
  };
  struct LinkTemplate {
    std::string_view suffix, type;
    std::vector<KeyMapping> keys;
  };
  std::string type;   ///< the word in the scene file
  std::string help;   ///< one sentence for docs/scene.md
  std::string paper;  ///< equations and sections it comes from
  schema::Keys keys;  ///< its own, beside the common ones
  std::vector<LinkTemplate> link_templates;
};

const std::vector<ModePreset>& mode_presets();
const ModePreset* find_mode_preset(std::string_view type);

/// The links that an item of the chain stands for: itself where it is a constraint, or the parts of a mode. Checks a mode's
/// keys and that the required ones are there; the constraints check the values.
Result<std::vector<json::Node>> expand_link(const json::Node& item);

}  // namespace catena::haptics
