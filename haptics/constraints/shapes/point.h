/// Keeps the proxy at a point: p = position. Keys: `position` (world units), `release` (lets go at that distance, takes hold
/// again within a tenth of it). Closed form, no field fetch.
#pragma once
#include "haptics/constraints/registry.h"

namespace catena::haptics {

ConstraintType point_constraint();

}  // namespace catena::haptics
