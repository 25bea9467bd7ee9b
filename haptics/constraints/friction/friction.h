/// Friction perpendicular to a vector field, tangential to a surface: the proxy p_c of the paper's section 6.1, Figure 5(a).
///   e = x - p,  d = v_t / |v_t|,  v_t = v - (v.n) n (n: the surface's normal; without a surface v_t = v)
///   along d     the proxy follows the streamline of v_t until |e.d| <= b,  b = tau (1 - f) / f, f the safe normalisation's factor
///   across      it stays while |e| <= tau, then slides to |e| = tau; both in turn until both hold (at most 8 times; BUDGET where they do
///               not yet: the next tick goes on)
/// With f = 1 - 1e-12, the field's usual place, b is nothing: motion along d is free, e.d within 1e-8 L; at a corner
/// of the line that is the closest point, as it is at faces of a sampled surface, the proxy is within 1e-5 L of the corner. Where v_t is
/// ill-defined (v = 0, v along n) f goes to 0 and b beyond tau: the isotropic drag. A large tau makes a streamline link of it.
///
/// Steps along d: midpoint rule in arc length (where the last step tells the turn to 1e-14 L, by that); along the surface the line turns by
/// at most 0.02 in half a step or, at a crease of a grid, costs at most 1e-6 L; at most 32 steps and trials a tick, each brought back to
/// the level. Drift of a lap of R = 0.05 at 0.2 units/s and 1 kHz: 1.3e-9 (Euler, Eqs. 1-2: 0.63e-3).
///
/// Keys: `field`; `kind` (line: v ~ -v, dyads are interpolated, line_axis.h); `threshold` (tau, default 0.005 L, asked at the proxy
/// before it moves); `surface`; `level` (none: the surface only gives n). On a level: the rules of friction/contact.h.
///
/// Status: OK; BUDGET (not there yet along the line: goes on next tick); BOUNDARY, CRITICAL (the line ends ahead, or v is unknown
/// or not finite at p: isotropic drag); FREE, NO_SURFACE. Haptic thread; every fetch counted.
#pragma once
#include "haptics/constraints/registry.h"

namespace catena::haptics {

ConstraintType friction_constraint();

}  // namespace catena::haptics
