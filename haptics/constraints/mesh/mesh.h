/// Keeps the proxy on a triangle mesh.                                  (section 3 of the paper; Zilles and Salisbury 1995)
///   free none: held from both sides, at the local closest point (mesh/walk.h)
///   free above (the side that the normals point to: outside) or below: a god-object (mesh/contact.h). What decides is its way, not
///   where the probe is: it stays on the face that it met until the probe comes back, however thin the part, and what is met from
///   behind lets it pass. At the start it is held if the nearest face has the probe behind it (not at an open edge).
/// Keys: `mesh`, `free`, `release`: lets go where |probe - proxy| >= release; takes hold again when the nearest face has the probe on
/// the free side, or it is over an open edge (free none: when the probe passes through the mesh or comes within 0.1 release of it).
/// No field fetch: evaluations are those of `release`. On the mesh to 1e-12 L, plus the rounding of world coordinates.
/// LinkStatus: OK, FREE, RELEASED, BUDGET (goes on next tick), NO_SURFACE (never, unless coordinates overflow).
#pragma once
#include "haptics/constraints/registry.h"

namespace catena::haptics {

ConstraintType mesh_constraint();

}  // namespace catena::haptics
