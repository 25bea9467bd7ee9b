// SPDX-License-Identifier: MIT
/// Curves along the vortex core lines of a field (engine/geometry/flow/vortex_cores.h). Between two knots of a core there are enough points
/// that a chord deviates from the core by at most 1e-6 L (at most 16 points per interval); each point has the value "swirl". Frame thread.
#pragma once
#include "engine/scene/scene.h"

namespace catena::scene {

/// Returns the curves of an entity whose CurvesSource has `vortex_cores`, for the field at the current time step. Error: the field is no
/// vector field, or has no vortex core by the criterion.
Result<curves::CurveSetPtr> resolve_vortex_core_curves(Scene& scene, Entity curves);

}  // namespace catena::scene
