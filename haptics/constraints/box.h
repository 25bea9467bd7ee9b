/// Keeps the proxy on the surface of a box, turned by R:  y = R^T (x - center), |y_i| <= h_i = size_i / 2.
///   value (above: outside)  |max(|y| - h, 0)| outside, max_i(|y_i| - h_i) inside: the signed distance
///   start                   the closest point; from inside that of the nearest face (at a tie the first of x, y, z; + before -)
///   from then on            the face held stays held while the probe projects into it, also past the middle of the box and out
///                           of the opposite face, so that a thin box is not slipped through; else the probe is outside and the
///                           closest point is y clamped to the box. From outside this is 1-Lipschitz, around edges and corners.
///   within one tick         the face is the one by which the segment of the probe enters
/// One-sided with free above, a box left through the opposite face still holds up to 0.02 L behind the face held.
/// L = max(4, the longest edge). Keys: `center`, `size` (three edges > 0), `rotation` (as the workspace's), `free` (above:
/// outside), `release`: the rules of surface_side.h. Lengths in world units.
/// Closed form, no field fetch. Haptic thread: no allocation, lock, or throw.
#pragma once
#include "haptics/constraints/registry.h"

namespace catena::haptics {

ConstraintType box_constraint();

}  // namespace catena::haptics
