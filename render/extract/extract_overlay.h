/// Private to this room: the scene's annotations into the packet's overlay. After everything else: bars show the colours that volumes
/// and streamlines have got. Frame thread.
#pragma once
#include "engine/base/result.h"
#include "engine/scene/scene.h"
#include "render/frame/frame_packet.h"

namespace catena::render {

void extract_overlay(const scene::Scene& scene, FramePacket& packet);

}  // namespace catena::render
