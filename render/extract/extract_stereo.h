/// From a scene's stereo mode to the eyes of a packet. Called by extract_frame; again by who moves the packet's view afterwards.
#pragma once
#include "engine/base/result.h"
#include "engine/scene/stereo.h"
#include "render/frame/frame_packet.h"

namespace catena::render {

Packing packing_of(const scene::Stereo& stereo);
/// How many pictures are packed; 1 where one eye or the view itself is shown.
std::size_t views_of(const scene::Stereo& stereo);
/// Eyes that no picture has both of, for they are too far apart: one sentence.
Outcome check_eyes(const FramePacket& packet, const scene::Stereo& stereo);
/// Sets `eyes` and `packing` from the packet's view, width and height.
void set_eyes(FramePacket& packet, const scene::Stereo& stereo);

}  // namespace catena::render
