/// The streamline link (paper, section 4, Eqs. 1-4): keeps the proxy on the streamline through a seed, at the local minimum of
/// the distance to the probe that lies downhill from where the proxy is.
///   selected (a seed, no method): moves on the traced arc-length curve, the same object that is drawn; streamline/selected.h
///   online (a method, "follow": "online", or no seed): integrates every tick; streamline/online.h
#pragma once
#include "haptics/constraints/registry.h"

namespace catena::haptics {

ConstraintType streamline_constraint();

/// Keeps the hand in a tube about a vortex core line (the vortex tube of the haptic flow literature). The lines are traced once, off the
/// tick (engine/geometry/flow/vortex_cores.h); `curves` of a scene draw the same ones.
///   c: the place of all lines that is nearest to the probe x (engine/geometry/flow/curve.h), a function of x alone, so that the pull
///   k (c - x) comes of the energy k |x - c|^2 / 2: no closed loop of the hand gains or loses. Where two places are equally near, half way
///   between two cores or in the hollow of a bent one, the pull turns over and its size stays.
///   |x - c| <= radius: FREE.  Outliers: p = c + radius (x - c) / |x - c|, on the tube's wall (radius 0: on the core).
/// Keys: `field` (vector), `radius` (>= 0, default 0), `search` (longest distance of the core from the probe, default 0.1 L or
/// 2 radius, if that is more), world units; `criterion`, `min_length`, `min_swirl` of vortex_cores.h. `limit` = search - radius.
/// In one tick c moves at most as far as the probe and LinkState::slip (then BUDGET); a hold that begins far away pulls by the ramp.
/// LinkStatus: OK FREE BUDGET; BOUNDARY (the core ends where the domain or its mask does); NO_SURFACE (no core within `search`); CRITICAL
/// and PARALLEL (every place satisfies the criterion: no pull). No fetch in a tick. Haptic thread: no allocation, lock or throw.
ConstraintType vortex_core_constraint();

}  // namespace catena::haptics
