/// Keeps the proxy on the surface of a box, turned by R:  y = R^T (x - center), |y_i| <= h_i = size_i / 2.
///   value (above: outside)  |max(|y| - h, 0)| outside, max_i(|y_i| - h_i) inside: the signed distance
///   start                   the closest point; from inside that of the nearest face (at a tie the first of x, y, z; + before -)
///   inside                  the face held stays held, also past the middle of the box: no jump from face to face
///   outside                 y clamped to the box, the closest point: 1-Lipschitz, around edges and corners
///   within one tick         the face is the one by which the segment of the probe comes in
/// With free above (held from inside), a hand that leaves by the opposite face is still held on the face by which it came in
/// while it is at most 0.02 L behind that and in front of no other face: a thin box is not slipped through, fast or slow.
/// L = max(4, the longest edge). Keys: `center`, `size` (three edges > 0), `rotation` (as the workspace's), `free` (above:
/// outside), `release`: the rules of surface_side.h. Lengths in world units.
/// Closed form, no field fetch. Haptic thread: no allocation, lock, or throw.
#pragma once
#include "haptics/constraints/registry.h"

namespace catena::haptics {

ConstraintType box_constraint();

}  // namespace catena::haptics
