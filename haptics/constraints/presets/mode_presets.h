// SPDX-License-Identifier: MIT
/// Mode presets: one element of a scene's chain that expands to several links, in order.      (paper, section 6.1)
///   anisotropic_friction   NAME_surface    isosurface: the probe on a level of a scalar field (p_s)
///                          NAME_direction  friction across the tangential component of a vector field (p_c)
///                          NAME_friction   friction modulated by the field's angle to the surface, Eqs. 7-9 (p_f)
/// A mode is a table entry: which of its keys go to which link, under which name. Of the common keys, stiffness, active_when and enabled go
/// to all links, the others to the first. Values keep their file and line, so that errors name the line in the scene. Off the tick.
#pragma once
#include "haptics/constraints/registry.h"

namespace catena::haptics {

/// A mode: its name and keys in scenes, its documentation, and the links that it expands to.
struct ModePreset {
  /// One key that is copied from the mode to a link.
  struct KeyMapping {
    std::string_view from, to;  ///< the mode's key, the link's key
  };
  /// One link of the mode: the suffix of its name, its constraint type, the keys that it takes from the mode.
  struct LinkTemplate {
    std::string_view suffix, type;
    std::vector<KeyMapping> keys;
  };
  std::string type;   ///< value of "type" in the scene file
  std::string help;   ///< one sentence for docs/reference/scene.md
  std::string paper;  ///< equations and sections of the paper that it implements
  schema::Keys keys;  ///< keys of the mode, besides the common ones
  std::vector<LinkTemplate> link_templates;
};

/// Returns all modes, in the order of the documentation.
const std::vector<ModePreset>& mode_presets();
/// Returns the mode of that name; null: none.
const ModePreset* find_mode_preset(std::string_view type);

/// Returns the links that an element of the chain stands for: the element itself if it is a constraint, or the expanded links of a mode.
/// An Error where a key of the mode is unknown or a required one is absent; the constraints check the values.
Result<std::vector<json::Node>> expand_link(const json::Node& item);

}  // namespace catena::haptics
