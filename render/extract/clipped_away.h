// SPDX-License-Identifier: MIT
/// Detection of clip planes that leave nothing of the data. Pure functions, any thread.
#pragma once
#include <span>

#include "render/frame/frame_packet.h"

namespace catena::render {

/// Returns whether a box and the half spaces of planes have a point in common.
bool has_common_point(const Bounds& box, std::span<const Plane> planes);

/// Returns whether the packet has data, all of which its clip planes cut away; judged by the bounds of each item.
bool is_clipped_away(const FramePacket& packet);

}  // namespace catena::render
