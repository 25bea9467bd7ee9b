// SPDX-License-Identifier: MIT
/// Colors of a packet in linear radiance, in which light is added (IlluminationItem::is_linear).
#pragma once
#include "render/frame/frame_packet.h"

namespace catena::render {

/// Converts the colors of the fog, of volumes, isosurfaces and slices, and those of fields that color them, to linear radiance. Colors of
/// transfer functions are interpolated in the display encoding; points are added where that matters. Vertex colors, item colors of
/// triangles and tubes, and the background remain as they are.
void make_colors_linear(FramePacket& packet);

}  // namespace catena::render
