// SPDX-License-Identifier: MIT
/// Keeps the proxy on the level set s(x) = level of a scalar field, at the closest point to the probe.   (paper, Eqs. 5-6,
/// safeguarded; the printed form lags behind the closest point and fails on steep profiles)
/// Keys: `field`, `level`, `free` (none | above | below, by field value), `release`; the rules are those of common/one_sided_contact.h.
///   search (isosurface/surface_search.h)    from anywhere to the level: march, bracket, Illinois; then a scan of 26 directions
///   closest (isosurface/closest_point.h)    formulas: Newton with the surface's curvature, SR1
///   descent (isosurface/surface_search.h)   formulas with folds, where `closest` is stuck: down on the surface, in a trust region
///   cell walk (isosurface/cell_walk.h)      linear grids: exact within each trilinear cell, from cell to cell
///   walls (isosurface/domain_wall.h)        cubic grids, otherwise searched as formulas: at the end of their domain
/// Search radius: 2 L around the first probe (on grids the probe clamped to the domain) along the gradient, then L along 26
/// directions. Off the level by at most 1e-11 L (formulas), 1e-9 L (grids); from the closest point by at most 1e-6 L.
/// Travel: while it holds, it walks on its own sheet (cells that share a face, |x - p| decreasing), at most LinkState::max_travel per tick;
/// where that is not enough, BUDGET. The closest point takes precedence over the limit where it has itself moved: the new point was no
/// nearer to the last probe than the point held, over a smooth surface. After a long step of the probe (more than 0.02 L in a tick)
/// the proxy jumps along the surface as if it were smooth, and the link has fewer work units per tick (kThrownWork), so that a tick stays
/// short.
/// LinkStatus: OK; FREE; RELEASED; BUDGET (not at the closest point yet: resumes in the next tick); BOUNDARY (on a wall of the domain,
/// the mask, or voxels that are not finite); CRITICAL (the gradient vanishes or jumps there, or a value is not finite);
/// NO_SURFACE (probe passed through).
#pragma once
#include "haptics/constraints/registry.h"

namespace catena::haptics {

ConstraintType isosurface_constraint();

}  // namespace catena::haptics
