/// Keeps the proxy on the level set s(x) = level of a scalar field, at the closest point to the probe.   (paper, Eqs. 5-6,
/// safeguarded; the printed form lags behind the closest point and fails on steep profiles)
/// Keys: `field`, `level`, `free` (none | above | below, by field value), `release`; the rules are those of surface_side.h.
///   reach (isosurface/reach.h)          from anywhere to the level: march, bracket, Illinois; then a scan of 26 directions
///   closest (isosurface/analytic.h)     formulas: Newton with the surface's curvature, SR1
///   descent (isosurface/reach.h)      formulas with folds, where that is stuck: down on the surface, in a trust region
///   cell walk (isosurface/cell_walk.h)  linear grids: exact within each trilinear cell, from cell to cell
///   walls (isosurface/wall.h)           cubic grids, which are else searched as formulas: where their domain ends
/// Search radius: 2 L around the first probe (the probe clamped to the domain on grids) along the gradient, then L along 26
/// directions. Off the level by at most 1e-11 L (formulas), 1e-9 L (grids); from the closest point by at most 1e-6 L.
/// Travel: while it holds it walks on its own sheet (cells that share a face, |x - p| falling), at most LinkState::travel a tick; where
/// that is not enough, BUDGET. The closest point wins where it has itself moved: what is met was no nearer to the last probe than what
/// was held, over a smooth surface. A probe that is thrown (more than 0.02 L in a tick) leaps along the surface as if it were smooth and
/// has less work a tick (kThrownWork), so that a tick stays short.
/// LinkStatus: OK; FREE; RELEASED; BUDGET (not at the closest point yet: goes on next tick); BOUNDARY (on a wall of the domain, the
/// mask, or voxels that are not finite); CRITICAL (the gradient vanishes or jumps there, or a value is not finite);
/// NO_SURFACE (probe passed through).
#pragma once
#include "haptics/constraints/registry.h"

namespace catena::haptics {

ConstraintType isosurface_constraint();

}  // namespace catena::haptics
