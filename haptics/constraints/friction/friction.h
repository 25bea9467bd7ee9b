// SPDX-License-Identifier: MIT
/// Friction perpendicular to a vector field, tangential to a surface: the proxy p_c of the paper's section 6.1, Figure 5(a).
///   e = x - p,  d = v_t / |v_t|,  v_t = v - (v.n) n (n: the surface's normal; without a surface v_t = v)
///   along d     the proxy follows the streamline of v_t until |e.d| <= b,  b = tau (1 - f) / f, f the safe normalization's factor
///   across      it stays while |e| <= tau, then slides to |e| = tau; both in turn until both hold (at most 8 times; otherwise BUDGET,
///               and the next tick resumes)
/// With f = 1 - 1e-12, the usual value, b is negligible: motion along d is free, e.d within 1e-8 L; at a corner of the line that is
/// the closest point, as it is at faces of a sampled surface, the proxy is within 1e-5 L of the corner. Where v_t is ill-defined
/// (v = 0, v along n) f goes to 0 and b beyond tau: isotropic drag. A large tau turns it into a streamline link.
///
/// Steps along d: midpoint rule in arc length (where the last step gives the turn to 1e-14 L, by that step); along the surface the line
/// turns by at most 0.02 in half a step or, at a crease of a grid, costs at most 1e-6 L; at most 32 steps and trials per tick, each
/// projected back to the level. Drift of a lap of R = 0.05 at 0.2 units/s and 1 kHz: 1.3e-9 (Euler, Eqs. 1-2: 0.63e-3).
///
/// Keys: `field`; `kind` (line: v ~ -v, dyads are interpolated); `threshold` (tau, default 0.005 L, evaluated at the proxy before it
/// moves); `surface`; `level` (none: the surface only gives n). On a level: the rules of friction/friction_contact.h.
///
/// LinkStatus: OK; BUDGET (not yet converged along the line: resumes in the next tick); BOUNDARY, CRITICAL (the line ends ahead, or v is
/// unknown or not finite at p: isotropic drag); FREE, NO_SURFACE. Haptic thread; every field sample counted.
#pragma once
#include "haptics/constraints/registry.h"

namespace catena::haptics {

ConstraintType friction_constraint();

/// Isotropic drag: the proxy stays until the probe pulls it.                              (paper, section 3)
///   |x - p| <= tau: p stays, bit for bit;   else p <- x - tau (x - p) / |x - p|, so that |x - p| = tau
/// Norm-based: the same in all directions. Over a loop of amplitude A it dissipates 4 K tau (A - tau).
/// Keys: `threshold` (tau, world units, may follow a field: evaluated at the proxy before it moves); `surface` and `level`: on a
/// level set, where probe and proxy stay on it and |x - p| is the chord; its rules are those of friction/friction_contact.h.
/// Without a surface closed form, no field sample. Starts at the incoming probe. LinkStatus: OK; on a surface FREE, NO_SURFACE, CRITICAL.
ConstraintType drag_constraint();

/// Drag on a surface, modulated by the field's angle to it: the proxy p_f of the paper's section 6.1, Eqs. 7-9, Figure 5(b).
///   u = cos(theta) = sigma_s sigma_v d_s.d_v,  d_s along grad s, d_v along v, sigma the safe normalization (friction_contact.h)
///   law "robust" (default) tau_f = (1 - |u|) tau_min + |u| tau_max
///   law "as_published"     tau_f = u tau_min + (1 - u) tau_max     (Eq. 7)
/// With Eq. 7 as printed, dragging is easiest where the field is along the normal, while the text around it says hardest; and
/// for u < 0 it exceeds tau_max. It is kept as printed, except that tau_f is never negative. In ill-defined regions u = 0.
/// u, tau_min, tau_max are evaluated at p_f before it moves; then isotropic drag (drag_constraint) with tau_f.
/// Keys: `field`, `kind` (line: v ~ -v, u = |u|), `surface`, `level` (keeps the proxy on it; without, drag in space), `tau_min`
/// (default 0.001 L), `tau_max` (default 0.01 L), `law`. LinkStatus: that of `drag`. At most two field samples at rest.
ConstraintType modulated_friction_constraint();

/// Haptic texture: drag whose threshold is modulated in space, perceived as stick and slip.    (paper, section 3: friction and texture)
///   tau(p) = threshold (1 + amplitude w(p)),  w = (T(x) + T(y) + T(z)) / 3,  T a triangle wave of the world coordinate, -1..1,
///   of period `wavelength`, -1 at multiples of it
/// Evaluated at the proxy before it moves. A sweep along an axis has a force of exactly that period; amplitude 1 along the diagonal
/// reduces tau to 0. A texture from data is a map on `threshold`.
/// Keys: `threshold` (base, world units), `amplitude` (0..1, default 0.5), `wavelength` (world units), `surface`, `level`; the
/// rules on a surface and the LinkStatus values are those of `drag`.
ConstraintType texture_constraint();

}  // namespace catena::haptics
