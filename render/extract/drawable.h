// SPDX-License-Identifier: MIT
/// Registry of what the image shows of each kind of drawable (engine/scene/drawable.h): a row beside its extraction, and one line in
/// drawable.cpp. Frame thread.
#pragma once
#include <array>
#include <string>
#include <string_view>
#include <vector>

#include "engine/base/result.h"
#include "engine/scene/scene.h"
#include "render/frame/frame_packet.h"

namespace catena::render {

/// Content of an item's scalar bar.
struct Legend {
  std::vector<std::array<double, 4>> colors;  ///< Value, r, g, b, with rising values; empty: nothing is shown
  std::string name;                           ///< Name and unit of the values
  const scene::LabelMap* labels = nullptr;    ///< Label map that the colors belong to; null: none
  double linear_below = 0;                    ///< Linear threshold of a symlog scale; 0: linear scale
};

/// Extraction of a kind of drawable.
struct DrawableExtraction {
  std::string_view name;                                               ///< Name of the kind: "glyphs"
  Outcome (*prepare)(scene::Scene& scene);                             ///< Rebuilds cached data of items that changed; nullptr: none
  Outcome (*extract)(const scene::Scene& scene, FramePacket& packet);  ///< Adds the visible items to the packet
  /// Returns the legend of an item; nullptr: the kind has no colors by value.
  Legend (*legend)(const scene::Scene& scene, scene::Entity item, const FramePacket& packet);
};

/// Adds a kind, which must be registered in the scene, too. Call it at startup.
void register_extraction(const DrawableExtraction& kind);
/// Returns all kinds, in the order of extraction.
const std::vector<DrawableExtraction>& extractions();

}  // namespace catena::render
