/// Drag on a surface, modulated by the field's angle to it: the proxy p_f of the paper's section 6.1, Eqs. 7-9, Figure 5(b).
///   u = cos(theta) = sigma_s sigma_v d_s.d_v,  d_s along grad s, d_v along v, sigma the safe normalisation (safe_direction.h)
///   law "safe" (default)   tau_f = (1 - |u|) tau_min + |u| tau_max
///   law "printed"          tau_f = u tau_min + (1 - u) tau_max     (Eq. 7)
/// Eq. 7 as printed is the easiest to drag where the field is along the normal, while the text around it says the hardest; and
/// for u < 0 it goes beyond tau_max. It is kept as it is, except that tau_f is never negative. In ill-defined regions u = 0.
/// u, tau_min, tau_max are taken at p_f before it moves; then the isotropic drag of drag.h with tau_f.
/// Keys: `field`, `kind` (line: v ~ -v, u = |u|), `surface`, `level` (keeps the proxy on it; without, drag in space), `tau_min`
/// (default 0.001 L), `tau_max` (default 0.01 L), `law`. Statuses: those of drag.h. At most two fetches at rest.
#pragma once
#include "haptics/constraints/registry.h"

namespace catena::haptics {

ConstraintType modulated_friction_constraint();

}  // namespace catena::haptics
