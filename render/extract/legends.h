// SPDX-License-Identifier: MIT
/// Private to this module: the legends of the drawables. Frame thread.
#pragma once
#include "render/extract/drawable.h"

namespace catena::render {

/// Returns the color table of a volume.
Legend volume_legend(const scene::Scene& scene, scene::Entity item, const FramePacket& packet);
/// The following return the colors of "color_by", for sets the final ones over the range of rendered values.
Legend isosurface_legend(const scene::Scene& scene, scene::Entity item, const FramePacket& packet);
Legend slice_legend(const scene::Scene& scene, scene::Entity item, const FramePacket& packet);
Legend streamlines_legend(const scene::Scene& scene, scene::Entity item, const FramePacket& packet);
Legend glyphs_legend(const scene::Scene& scene, scene::Entity item, const FramePacket& packet);
Legend curves_legend(const scene::Scene& scene, scene::Entity item, const FramePacket& packet);
Legend points_legend(const scene::Scene& scene, scene::Entity item, const FramePacket& packet);

}  // namespace catena::render
