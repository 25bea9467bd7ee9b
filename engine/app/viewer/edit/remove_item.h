/// Taking an item out of a list of the scene, with all that hangs on it. Frame thread.
///   what names an item of the list by its index    names the same item as before: later indices are one less
///   what names the item itself                     a scalar bar goes; glyphs on a slice stay on a plane that lies as the slice did, other
///                                                  glyphs go
///   links of the chain that feel it (feel.h)       go, unless something that is drawn still lies there
#pragma once
#include <string>
#include <vector>

#include "engine/app/viewer/edit/scene_items.h"

namespace catena::app {

/// What becomes of what names items of lists by their indices, without the item and with it: `item` is "slices[1]" (json::Node::label),
/// `text` the scene's.
TextEdits make_remove_edits(const std::string& text, const std::string& item);

/// Pointers to the links that lie on the item as "Feel" would make them, in the order of the chain. A volume has those at levels of its
/// field where no isosurface is drawn; a set of streamlines those that begin where a line of it does.
std::vector<std::string> find_links_on(scene::Scene& scene, const std::string& item);

/// With the links that lie on it.
TextEdits make_remove_edits_with_links(scene::Scene& scene, const std::string& text, const std::string& item);

}  // namespace catena::app
