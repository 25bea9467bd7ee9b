/// Keeps the proxy on the straight piece from a to b: p = a + d clamp(d . (x - a), 0, |b - a|), d the unit direction; at an end
/// it is that end, bit for bit. Keys: `from`, `to` (not the same), `release` (lets go at that distance, takes hold again within
/// a tenth of it). Beyond an end its primitive is that point. Lengths in world units; L = max(4, |b - a|).
/// Closed form, no field fetch. Haptic thread: no allocation, lock, or throw.
#pragma once
#include "haptics/constraints/registry.h"

namespace catena::haptics {

ConstraintType segment_constraint();

}  // namespace catena::haptics
