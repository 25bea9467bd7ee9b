// SPDX-License-Identifier: MIT
/// Keeps the proxy at a point: p = position. Keys: `position` (world units), `release` (releases at that distance, re-engages within a
/// tenth of it). Closed form, no field sample. Haptic thread: no allocation, lock, or throw.
#pragma once
#include "haptics/constraints/registry.h"

namespace catena::haptics {

ConstraintType point_constraint();

/// Keeps the proxy on an infinite line: p = point + d (d . (x - point)), the orthogonal projection of the probe x; d the unit
/// direction. Keys: `point`, `direction` (any length but zero), `release` (releases at that distance, re-engages within a tenth of it).
/// Lengths in world units. Closed form, no field sample. Haptic thread: no allocation, lock, or throw.
ConstraintType line_constraint();

/// Keeps the proxy on the line segment from a to b: p = a + d clamp(d . (x - a), 0, |b - a|), d the unit direction; at an end
/// it is that end, bit for bit. Keys: `from`, `to` (not the same), `release` (releases at that distance, re-engages within a tenth
/// of it). Past an end its primitive is that point. Lengths in world units; L = max(4, |b - a|).
/// Closed form, no field sample. Haptic thread: no allocation, lock, or throw.
ConstraintType segment_constraint();

/// Keeps the proxy on a polyline, at the local minimum of the distance to the probe that lies downhill from the proxy: on a segment the
/// foot of the perpendicular (closed_form.h), at a corner the corner, bit for bit; from segment to segment while that reduces the
/// distance. A probe that merely passes near another part does not change over.
/// Start, `seek` and re-engagement after a release: the globally closest point (polyline_bvh.h), within 1024 BVH nodes in the first tick
/// and 128 in each later one, then BUDGET with the best point so far, and the search resumes in the next tick. A tick walks at most 4096
/// segments, then BUDGET likewise. An open end holds with OK; a closed polyline wraps.
/// Keys: `points` (at least two; equal neighbors count as one), `closed` (the last joins the first; needs three), `release` (releases
/// at that distance, re-engages within a tenth of it). Its primitive: the line of the segment, at a corner or an end the point.
/// Lengths in world units; L = max(4, the longest edge of the bounding box). Haptic thread: no allocation, lock, or throw.
ConstraintType polyline_constraint();

/// Keeps the proxy on the lines of curves from a file (engine/geometry/curves), each an open polyline: on the line that it holds, until the
/// link releases. It engages at the closest point of all lines, or of one line: a BVH over runs of at most eight consecutive segments,
/// sorted along a Morton curve (common/closest_point_bvh.h); within 512 nodes in the first tick and 256 in each later one, then BUDGET with
/// the best point so far, and the search resumes in the next tick. A tick walks at most 1024 segments, then BUDGET likewise. The BVH is
/// built off the tick and shared by all links and programs that hold the same lines.
/// Keys: `curves` (their name), `line` (index of one of them, from 0; without it all), `release` (releases at that distance, re-engages
/// within a tenth of it). Its primitive is that of a polyline. Lengths in world units; L = max(4, the longest edge of the bounding box).
/// Haptic thread: no allocation, lock, or throw.
ConstraintType curves_constraint();

/// Keeps the proxy at a point of a table (engine/geometry/curves/point_set.h): it engages at the closest of all points and stays there
/// until the link releases. A BVH over eight points per leaf, sorted along a Morton curve (common/closest_point_bvh.h): within 768 nodes in
/// the first tick and 256 in each later one, then BUDGET with the best point so far, and the search resumes in the next tick. The BVH is
/// built off the tick and shared by all links and programs. Keys: `points` (their name), `release` (releases at that distance, re-engages
/// within a tenth of it). Its primitive is the point. Lengths in world units; L = max(4, the longest edge of the bounding box). Haptic
/// thread: no allocation, lock, or throw.
ConstraintType points_constraint();

/// Keeps the proxy on a plane: p = x - n (n . (x - point)), the orthogonal projection of the probe x.
/// Keys: `point`, `normal` (normalized), `free` (above: the side that the normal points to), `release`: the same rules as the
/// isosurface, with the signed distance as the field's value. Closed form, no field sample.
ConstraintType plane_constraint();

/// Keeps the proxy on a sphere: p = c + r (x - c) / |x - c|. A probe at the center keeps the last direction (+x at the start).
/// Keys: `center`, `radius` (> 0), `free` (above: outside), `release`: the rules of common/one_sided_contact.h with the value |x - c| - r.
/// One-sided with free above, a sphere passed within one step of at most 0.02 L (L = max(4, 2 r)) holds on its near half, seen
/// along the step's direction -m:  p = c + q + m sqrt(r^2 - |q|^2), q = (x - c) without its component along m; free where |q| >= r.
/// Lengths in world units. Closed form, no field sample. Haptic thread: no allocation, lock, or throw.
ConstraintType sphere_constraint();

/// Keeps the proxy on the surface of a box, rotated by R:  y = R^T (x - center), |y_i| <= h_i = size_i / 2.
///   value (above: outside)  |max(|y| - h, 0)| outside, max_i(|y_i| - h_i) inside: the signed distance
///   start                   the closest point; from inside that of the nearest face (at a tie the first of x, y, z; + before -)
///   inside                  the face held stays held, also past the middle of the box: no jump from face to face
///   outside                 y clamped to the box, the closest point: 1-Lipschitz, around edges and corners
///   within one tick         the face through which the segment of the probe enters
/// With free above (held from inside), a probe that leaves by the opposite face is still held on the face through which it entered
/// while it is at most 0.02 L behind that face and in front of no other face: no tunneling through a thin box, fast or slow.
/// L = max(4, the longest edge). Keys: `center`, `size` (three edges > 0), `rotation` (written as the workspace's), `free` (above:
/// outside), `release`: the rules of common/one_sided_contact.h. Lengths in world units.
/// Closed form, no field sample. Haptic thread: no allocation, lock, or throw.
ConstraintType box_constraint();

}  // namespace catena::haptics
