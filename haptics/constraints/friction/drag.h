/// Isotropic drag: the proxy stays until the probe pulls it.                              (paper, section 3)
///   |x - p| <= tau: p stays, bit for bit;   else p <- x - tau (x - p) / |x - p|, so that |x - p| = tau
/// Norm-based: the same in all directions. In a loop of amplitude A it takes 4 K tau (A - tau) from the hand.
/// Keys: `threshold` (tau, world units, may follow a field: asked at the proxy before it moves); `surface` and `level`: on a
/// level set, where probe and proxy stay on it and |x - p| is the chord; its rules are those of friction/contact.h.
/// Without a surface closed form, no fetch. Starts at the incoming probe. Statuses: OK; on a surface FREE, NO_SURFACE, CRITICAL.
#pragma once
#include "haptics/constraints/registry.h"

namespace catena::haptics {

ConstraintType drag_constraint();

}  // namespace catena::haptics
