/// The edges of a box that carry the axes' ticks and numbers: those of its outline in the picture, so that nothing of them lies over what
/// is in the box. Pure, any thread.
///   outline   an edge one of whose two faces is turned to the eye; an axis without one (a face seen straight on, an eye in the box) takes
///             any of its four
///   of those  the axis nearest to the view's up takes the leftmost, the others the lowest
///   out       of the two faces' normals the one that leads further away from the edge in the picture. A face's normal at an edge of the
///             outline leads out of the outline
/// It depends on the view's place and direction alone: both eyes of a pair and all tiles of a picture have the same edges, and a view
/// always has the same.
#pragma once
#include <array>

#include "engine/base/bounds.h"
#include "render/frame/frame_packet.h"

namespace catena::render {

struct AxisEdge {
  Vec3 from{0.0}, to{0.0};  ///< the coordinate rises
  Vec3 outward{0.0};        ///< unit, along an axis
};

/// Of x, y, z.
std::array<AxisEdge, 3> find_axis_edges(const Bounds& box, const View& view);

}  // namespace catena::render
