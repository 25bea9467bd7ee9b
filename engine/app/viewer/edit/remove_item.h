// SPDX-License-Identifier: MIT
/// Removal of an item from a list of the scene, with everything that refers to it. Frame thread.
///   references to other items of the list by index   are renumbered
///   references to the item itself                    scalar bars are removed; glyphs on a slice stay on a plane equal to the slice's,
///                                                    other glyphs are removed
///   links of the chain bound to it                   are removed (haptic_binding.h), unless another visible item lies there
///   followers of a widget                            stay at its pose
#pragma once
#include <string>
#include <vector>

#include "engine/app/viewer/edit/scene_items.h"

namespace catena::app {

/// Returns the edits that remove the item and adapt the references to items by index. `item`: "slices[1]" (json::Node::label); `text`: the
/// scene's.
TextEdits make_remove_edits(const std::string& text, const std::string& item);

/// Returns pointers to the links that lie on the item as a haptic binding makes them, in the order of the chain. For a volume: links at
/// levels of its field without a visible isosurface; for a set of streamlines: links whose seed is the seed of one of its lines.
std::vector<std::string> find_links_on(scene::Scene& scene, const std::string& item);

/// Returns the edits that remove a widget and its items of "clip"; slices, glyphs, seeds and levels that follow it stay at its pose.
TextEdits make_remove_widget_edits(const scene::Scene& scene, const std::string& text, const std::string& name);

/// Returns the edits that remove the item and the links that lie on the item.
TextEdits make_remove_edits_with_links(scene::Scene& scene, const std::string& text, const std::string& item);

}  // namespace catena::app
