/// The streamline link (paper, section 4, Eqs. 1-4): keeps the proxy on the streamline through a seed, at the local minimum of
/// the distance to the probe that lies downhill from where the proxy is.
///   selected (a seed, no method): moves on the traced arc-length curve, the same object that is drawn; streamline/selected.h
///   online (a method, "follow": "online", or no seed): integrates every tick; streamline/online.h
#pragma once
#include "haptics/constraints/registry.h"

namespace catena::haptics {

ConstraintType streamline_constraint();

/// Keeps the hand in a tube about a vortex core line (the vortex tube of the haptic flow literature).
///   axis w = curl v / |curl v|;  core: v - w (w . v) = 0 in a plane across w where the flow swirls (complex eigenvalues of the
///   in-plane velocity gradient A: (tr A)^2 < 4 det A), after Sujudi and Haimes with the vorticity for the real eigenvector.
///   The core's place c in the plane through the probe x: Newton, w . (x - c) = 0 and A d = -v in the plane, from the last c;
///   steps no longer than `search`, halved where they do not come nearer; <= 32 iterations, then BUDGET and on from there.
///   On grids the axis turns by a step from cell to cell; where the probe's plane meets the core at such a face, c is on it.
///   |x - c| <= radius: FREE.  Beyond: p = c + radius (x - c) / |x - c|, on the tube's wall (radius 0: on the core).
/// Keys: `field` (vector), `radius` (>= 0, default 0), `search` (longest distance of the core from the probe, default 0.1 L or
/// 2 radius, if that is more), world units. `limit` = search - radius.
/// Status: OK FREE BUDGET; BOUNDARY (the core has left the domain); NO_SURFACE (no swirl, or no core within `search`).
/// One fetch a trial on grids, seven on formulas; at most 100 a search and two searches a tick (from the last core, then from x).
/// Across the axis c is within 1e-12 L of where v vanishes (1e-6 L where A jumps there). Haptic thread: no allocation, lock or throw.
ConstraintType vortex_core_constraint();

}  // namespace catena::haptics
