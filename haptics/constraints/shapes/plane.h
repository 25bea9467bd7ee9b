/// Keeps the proxy on a plane: p = x - n (n . (x - point)), the orthogonal projection of the probe x.
/// Keys: `point`, `normal` (normalised), `free` (above: the side that the normal points to), `release`: the same rules as the
/// isosurface with the signed distance as the field's value. Closed form, no field fetch.
#pragma once
#include "haptics/constraints/registry.h"

namespace catena::haptics {

ConstraintType plane_constraint();

}  // namespace catena::haptics
