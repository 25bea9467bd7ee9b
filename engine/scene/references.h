// SPDX-License-Identifier: MIT
/// References in the text of a scene: values that name a file or another item, and items that state another one by its index in a list. Any
/// thread.
#pragma once
#include <array>
#include <functional>

#include "engine/base/json.h"
#include "engine/schema/key.h"

namespace catena::scene {

/// Calls `visit` for every string of a parsed scene whose key has a role other than none, by the description of the keys; also in nested
/// lists, objects and alternatives. Order: that of the text. A string is visited once.
void each_reference(const json::Node& root, const std::function<void(schema::Role, const json::Node&)>& visit);

/// A key that refers to an item of a list by its index.
struct IndexReference {
  const char *holder, *key, *list;  ///< "scalar_bars", "slice", "slices"; the key may be a path.
};
inline constexpr std::array kIndexReferences = {IndexReference{"scalar_bars", "volume", "volumes"},
                                                IndexReference{"scalar_bars", "slice", "slices"},
                                                IndexReference{"scalar_bars", "streamlines", "streamlines"},
                                                IndexReference{"scalar_bars", "glyphs", "glyphs"},
                                                IndexReference{"scalar_bars", "curves", "curves"},
                                                IndexReference{"scalar_bars", "points", "points"},
                                                IndexReference{"glyphs", "on/slice", "slices"},
                                                IndexReference{"glyphs", "on/isosurface", "isosurfaces"}};

}  // namespace catena::scene
