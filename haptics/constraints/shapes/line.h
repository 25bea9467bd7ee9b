/// Keeps the proxy on an infinite line: p = point + d (d . (x - point)), the orthogonal projection of the probe x; d the unit
/// direction. Keys: `point`, `direction` (any length but zero), `release` (lets go at that distance, takes hold again within a
/// tenth of it). Lengths in world units. Closed form, no field fetch. Haptic thread: no allocation, lock, or throw.
#pragma once
#include "haptics/constraints/registry.h"

namespace catena::haptics {

ConstraintType line_constraint();

}  // namespace catena::haptics
