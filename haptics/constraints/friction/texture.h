/// Haptic texture: drag whose threshold is modulated in space, felt as stick and slip.    (paper, section 3: friction and texture)
///   tau(p) = threshold (1 + amplitude w(p)),  w = (T(x) + T(y) + T(z)) / 3,  T a triangle wave of the world coordinate, -1..1,
///   of period `wavelength`, -1 at multiples of it
/// At the proxy before it moves. A sweep along an axis has a force of exactly that period; amplitude 1 along the diagonal
/// takes tau down to 0. Texture by data is a map on `threshold`.
/// Keys: `threshold` (base, world units), `amplitude` (0..1, default 0.5), `wavelength` (world units), `surface`, `level`; the
/// rules on a surface and the statuses are those of drag.h.
#pragma once
#include "haptics/constraints/registry.h"

namespace catena::haptics {

ConstraintType texture_constraint();

}  // namespace catena::haptics
