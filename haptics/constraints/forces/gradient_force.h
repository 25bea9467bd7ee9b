/// The classical volume mode: a force along the gradient of a scalar field, as large as the gradient is.
///   p = x +- displacement min(1, |grad s| / X) grad s / |grad s|,  X the field's largest gradient (engine/field/magnitude.h)
/// so that the force is at most k_i S displacement. The normalisation is safe: any scale of the field gives the same proxy.
/// Keys: `field` (scalar), `displacement` (the largest |p - x|, world units, >= 0, may follow a field), `towards` high | low.
/// Status OK; on a plateau p = x; outside the domain, the mask, or where values are not finite p = x and FREE.
/// One evaluation a tick. Haptic thread: no allocation, lock or throw.
#pragma once
#include "haptics/constraints/registry.h"

namespace catena::haptics {

ConstraintType gradient_force_constraint();

}  // namespace catena::haptics
