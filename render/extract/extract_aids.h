/// Private to this room: bounding box, axes, ground, fog and lights into the packet. Frame thread.
///   bounding box   the twelve edges of a field's domain, true to rotated and sheared grids; else of the box of all that is drawn
///   axes           three edges of that box with ticks at round numbers (along the world's axes)
///   ground         a checkerboard across z, just below all that is drawn
///   fog            from the nearest to the farthest view depth of all that is drawn
#pragma once
#include "engine/scene/scene.h"
#include "render/frame/camera.h"
#include "render/frame/frame_packet.h"

namespace catena::render {

/// After everything else that is drawn, and after the view: `drawn` is its box.
void extract_aids(const scene::Scene& scene, const Bounds& drawn, FramePacket& packet);
/// The fog alone: its range follows the packet's view.
void set_fog(const scene::Scene& scene, const Bounds& drawn, FramePacket& packet);

}  // namespace catena::render
