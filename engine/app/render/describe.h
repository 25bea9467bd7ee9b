/// "1 volume, 3 streamlines, 1 cursor": what a packet draws.
#pragma once
#include <string>

#include "render/frame/frame_packet.h"

namespace catena::app {

std::string what_is_drawn(const render::FramePacket& packet);

}  // namespace catena::app
