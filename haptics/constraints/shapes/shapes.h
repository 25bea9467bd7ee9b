/// Keeps the proxy at a point: p = position. Keys: `position` (world units), `release` (lets go at that distance, takes hold
/// again within a tenth of it). Closed form, no field fetch.
#pragma once
#include "haptics/constraints/registry.h"

namespace catena::haptics {

ConstraintType point_constraint();

/// Keeps the proxy on an infinite line: p = point + d (d . (x - point)), the orthogonal projection of the probe x; d the unit
/// direction. Keys: `point`, `direction` (any length but zero), `release` (lets go at that distance, takes hold again within a
/// tenth of it). Lengths in world units. Closed form, no field fetch. Haptic thread: no allocation, lock, or throw.
ConstraintType line_constraint();

/// Keeps the proxy on the straight piece from a to b: p = a + d clamp(d . (x - a), 0, |b - a|), d the unit direction; at an end
/// it is that end, bit for bit. Keys: `from`, `to` (not the same), `release` (lets go at that distance, takes hold again within
/// a tenth of it). Outliers an end its primitive is that point. Lengths in world units; L = max(4, |b - a|).
/// Closed form, no field fetch. Haptic thread: no allocation, lock, or throw.
ConstraintType segment_constraint();

/// Keeps the proxy on a polyline, at the local minimum of the distance to the probe that lies downhill from where the proxy is:
/// on a piece the foot of the perpendicular (closed_form.h), at a corner the corner, bit for bit; from piece to piece while that
/// leads nearer. A hand that merely passes near another part does not change over.
/// Start, `seek` and taking hold again after a release: the closest place anywhere (polyline_search.h), within 1024 boxes in the
/// first tick and 128 in each later one, then BUDGET with the best so far, and on from there. A tick walks at most 4096 pieces,
/// then BUDGET likewise. An open end holds with OK; a closed polyline wraps.
/// Keys: `points` (at least two; equal neighbours count once), `closed` (the last joins the first; needs three), `release` (lets go
/// at that distance, takes hold again within a tenth of it). Its primitive: the line of the piece, at a corner or an end the point.
/// Lengths in world units; L = max(4, the longest edge of the box around it). Haptic thread: no allocation, lock, or throw.
ConstraintType polyline_constraint();

/// Keeps the proxy on the lines of curves from a file (engine/geometry/curves), as on polylines with open ends: on the line that it holds,
/// until the link lets go. Where it takes hold is the closest place of all the lines, or of one: a tree of boxes over runs of at most eight
/// consecutive pieces, put in order along a Morton curve (closest_search.h); within 512 boxes in the first tick and 256 in each later one,
/// then BUDGET with the best so far, and on from there. A tick walks at most 1024 pieces, then BUDGET likewise. The tree is made off the
/// tick, once for all links and programs that hold the same lines.
/// Keys: `curves` (their name), `line` (one of them, counted from 0; without it all), `release` (lets go at that distance, takes hold again
/// within a tenth of it). Its primitive is that of a polyline. Lengths in world units; L = max(4, the longest edge of the box around it).
/// Haptic thread: no allocation, lock, or throw.
ConstraintType curves_constraint();

/// Keeps the proxy at a point of a table (engine/geometry/curves/point_set.h): where it takes hold, the closest of all, and there until the
/// link lets go. A tree of boxes over eight points each, in the order of a Morton curve (closest_search.h): within 768 boxes in the first
/// tick and 256 in each later one, then BUDGET with the best so far, and on from there. The tree is made off the tick, once for all links
/// and programs. Keys: `points` (their name), `release` (lets go at that distance, takes hold again within a tenth of it). Its primitive is
/// the point. Lengths in world units; L = max(4, the longest edge of the box around all). Haptic thread: no allocation, lock, or throw.
ConstraintType points_constraint();

/// Keeps the proxy on a plane: p = x - n (n . (x - point)), the orthogonal projection of the probe x.
/// Keys: `point`, `normal` (normalised), `free` (above: the side that the normal points to), `release`: the same rules as the
/// isosurface with the signed distance as the field's value. Closed form, no field fetch.
ConstraintType plane_constraint();

/// Keeps the proxy on a sphere: p = c + r (x - c) / |x - c|. A probe at the centre keeps the last direction (+x at the start).
/// Keys: `center`, `radius` (> 0), `free` (above: outside), `release`: the rules of surface_side.h with the value |x - c| - r.
/// One-sided with free above, a sphere passed within one step of at most 0.02 L (L = max(4, 2 r)) holds on its near half, seen
/// along the step's direction -m:  p = c + q + m sqrt(r^2 - |q|^2), q = (x - c) without its part along m; free where |q| >= r.
/// Lengths in world units. Closed form, no field fetch. Haptic thread: no allocation, lock, or throw.
ConstraintType sphere_constraint();

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
ConstraintType box_constraint();

}  // namespace catena::haptics
