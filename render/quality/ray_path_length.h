// SPDX-License-Identifier: MIT
/// Path length of exact rays in an image, which determines the cost of a step length before anything is rendered. The rays of some hundred
/// pixels are traced on the CPU through the grids' own values, every few voxels, like the exact raycast: it skips empty space, except for
/// bricks next to visible ones, and ends where almost no light is left. A sample counts if any of the rays that are marched together, those
/// of 4 x 2 pixels, takes it. Several volumes are traced separately. Coloring by gradient and opaque objects in front of a volume are
/// ignored. Any thread.
#pragma once
#include "render/frame/frame_packet.h"

namespace catena::render {

/// Sum over all pixels, in smallest voxel edges.
struct RayPathLength {
  double marched = 0;  ///< length on which samples are taken
  double visible = 0;  ///< part of it with extinction > 0, where shading is computed
};

/// Estimates the path length of all rays of the packet.
RayPathLength measure_ray_path_length(const FramePacket& packet);

}  // namespace catena::render
