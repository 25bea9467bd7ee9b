// SPDX-License-Identifier: MIT
/// The streamline link (paper, section 4, Eqs. 1-4): keeps the proxy on the streamline through a seed, at the local minimum of
/// the distance to the probe that lies downhill from the proxy.
///   selected (a seed, no method): moves on the traced arc-length curve, the object that is rendered; selected_streamline.h
///   online (a method, "follow": "online", or no seed): integrates in every tick; online_streamline.h
#pragma once
#include "haptics/constraints/registry.h"

namespace catena::haptics {

ConstraintType streamline_constraint();

/// Keeps the proxy on a path line (engine/geometry/flow/pathlines.h), as on a selected streamline: the curve does not change with the
/// scene's time. The time of the particle at the proxy is the curve's; with "clock": "proxy" the scene follows it (frame thread).
ConstraintType pathline_constraint();
/// Reads which path line a link asks for: `seed`, `times`, `time_interpolation`.
Result<PathlineSpec> read_pathline_spec(const json::Node& link);

/// Keeps the probe in a tube about a vortex core line (the vortex tube of the haptic flow literature). The lines are traced off the tick,
/// while the link is built (engine/geometry/flow/vortex_cores.h); `curves` of a scene render the same lines.
///   c: the point of all lines that is nearest to the probe x (engine/geometry/flow/curve.h), a function of x alone, so that the force
///   k (c - x) derives from the energy k |x - c|^2 / 2: no closed loop of the probe gains or loses energy. Where two points are equally
///   near, half way between two cores or on the concave side of a bent one, the force changes direction and keeps its magnitude.
///   |x - c| <= radius: FREE.  Otherwise p = c + radius (x - c) / |x - c|, on the tube's wall (radius 0: on the core).
/// Keys: `field` (vector), `radius` (>= 0, default 0), `search` (maximum distance of the core from the probe, default 0.1 L or
/// 2 radius, whichever is more), world units; `criterion`, `min_length`, `min_swirl` of vortex_cores.h. `limit` = search - radius.
/// In one tick c moves at most LinkState::max_travel (then BUDGET); a hold that begins far away ramps in its force.
/// LinkStatus: OK FREE BUDGET; RELEASED (for one tick, where another core is nearer than 0.7 times the distance of the one held); BOUNDARY
/// (the core ends where the domain or its mask does); NO_SURFACE (no core within `search`); CRITICAL with reason PARALLEL (every point
/// satisfies the criterion: no force). No field samples in a tick. Haptic thread: no allocation, lock or throw.
ConstraintType vortex_core_constraint();

}  // namespace catena::haptics
