// SPDX-License-Identifier: MIT
/// Private to this module: the legends of the drawables. Frame thread.
#pragma once
#include "render/extract/drawable.h"
#include "render/extract/extract_internal.h"

namespace catena::render {

/// Makes the legend of lines, glyphs, curves or points from their cached table. `field`: the field that they show; none: no field.
Legend colored_legend(const scene::Scene& scene, const ColorTable* table, const std::optional<scene::ColorBy>& by,
                      scene::Entity field = {});
/// Returns the color table of a volume.
Legend volume_legend(const scene::Scene& scene, scene::Entity item, const FramePacket& packet);
/// The following return the colors of "color_by", for sets the final ones over the range of rendered values.
Legend isosurface_legend(const scene::Scene& scene, scene::Entity item, const FramePacket& packet);
Legend slice_legend(const scene::Scene& scene, scene::Entity item, const FramePacket& packet);

}  // namespace catena::render
