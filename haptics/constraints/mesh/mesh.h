// SPDX-License-Identifier: MIT
/// Keeps the proxy on a triangle mesh.                                  (section 3 of the paper; Zilles and Salisbury 1995)
///   free none: held from both sides, at the local closest point (mesh/mesh_walk.h)
///   free above (the side that the normals point to: outside) or below: a god-object (mesh/god_object.h). The contact depends on the
///   god-object's path, not on the probe's position: it stays on the face that it met until the probe comes back, however thin the part;
///   faces met from behind let it pass. At the start it is held if the probe is behind the nearest face (not at an open edge).
/// Keys: `mesh`, `free`, `release`: releases where |probe - proxy| >= release; re-engages when the probe is on the free side of the
/// nearest face, or over an open edge (free none: when the probe passes through the mesh or comes within 0.1 release of it).
/// No field samples: evaluations are those of `release`. On the mesh to 1e-12 L, plus the rounding of world coordinates.
/// LinkStatus: OK, FREE, RELEASED, BUDGET (resumes in the next tick), NO_SURFACE (never, unless coordinates overflow).
#pragma once
#include "haptics/constraints/registry.h"

namespace catena::haptics {

ConstraintType mesh_constraint();

}  // namespace catena::haptics
