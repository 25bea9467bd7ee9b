/// Keeps the proxy on a sphere: p = c + r (x - c) / |x - c|. A probe at the centre keeps the last direction (+x at the start).
/// Keys: `center`, `radius` (> 0), `free` (above: outside), `release`: the rules of surface_side.h with the value |x - c| - r.
/// One-sided with free above, a sphere passed within one step of at most 0.02 L (L = max(4, 2 r)) holds on its near half, seen
/// along the step's direction -m:  p = c + q + m sqrt(r^2 - |q|^2), q = (x - c) without its part along m; free where |q| >= r.
/// Lengths in world units. Closed form, no field fetch. Haptic thread: no allocation, lock, or throw.
#pragma once
#include "haptics/constraints/registry.h"

namespace catena::haptics {

ConstraintType sphere_constraint();

}  // namespace catena::haptics
