/// Keeps the proxy on a polyline, at the local minimum of the distance to the probe that lies downhill from where the proxy is:
/// on a piece the foot of the perpendicular (straight.h), at a corner the corner, bit for bit; from piece to piece while that
/// leads nearer. A hand that merely passes near another part does not change over.
/// Start, `seek` and taking hold again after a release: the closest place anywhere (polyline_search.h), within 1024 boxes in the
/// first tick and 128 in each later one, then BUDGET with the best so far, and on from there. A tick walks at most 4096 pieces,
/// then BUDGET likewise. An open end holds with OK; a closed polyline wraps.
/// Keys: `points` (at least two; equal neighbours count once), `closed` (the last joins the first; needs three), `release` (lets go
/// at that distance, takes hold again within a tenth of it). Its primitive: the line of the piece, at a corner or an end the point.
/// Lengths in world units; L = max(4, the longest edge of the box around it). Haptic thread: no allocation, lock, or throw.
#pragma once
#include "haptics/constraints/registry.h"

namespace catena::haptics {

ConstraintType polyline_constraint();

}  // namespace catena::haptics
