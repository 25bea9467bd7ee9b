/// How far exact rays march in a picture: the cost of a step length before anything is drawn. Some hundred pixels' rays are followed on the
/// processor through the grids' own values, every few voxels, as the exact raycast goes: over what is empty it leaps, but for the bricks
/// beside what is seen, and where next to no light is left it ends. A sample counts where any of the rays that are marched together takes
/// it: those of 4 x 2 pixels. Of several volumes each is followed by itself. Colours by a gradient and what is opaque before a volume are
/// not looked at. Any thread.
#pragma once
#include "render/frame/frame_packet.h"

namespace catena::render {

/// Of all pixels together, in smallest voxel edges.
struct RayPathLength {
  double marched = 0;  ///< where samples are taken
  double visible = 0;  ///< the part of it with an extinction, where light is worked out
};

RayPathLength measure_ray_path_length(const FramePacket& packet);

}  // namespace catena::render
