// SPDX-License-Identifier: MIT
/// Choice of the box edges that carry the axes' ticks and numbers: edges on the outline of the box in the image, so that the ticks do not
/// cover the box's content. Pure functions, any thread.
///   outline   edges of which one of the two faces faces the camera; an axis without one (face seen straight on, camera inside the box) may
///             use any of its four edges
///   of those  the axis nearest to the view's up uses the leftmost one, the others the lowest one
///   outward   of the two faces' normals the one that leads further away from the edge in the image. A face's normal at an edge of the
///             outline leads out of the outline
/// The choice depends on the view's position and direction only: both eyes of a pair and all tiles of an image get the same edges, and so
/// does the same view at any time.
#pragma once
#include <array>

#include "engine/base/bounds.h"
#include "render/frame/frame_packet.h"

namespace catena::render {

/// Box edge that carries an axis.
struct AxisEdge {
  Vec3 from{0.0}, to{0.0};  ///< world units; the coordinate rises
  Vec3 outward{0.0};        ///< unit vector along an axis, away from the box
};

/// Returns the edges of the x, y and z axis.
std::array<AxisEdge, 3> find_axis_edges(const Bounds& box, const View& view);

}  // namespace catena::render
