/// Curves that are traced along the vortex cores of a field (engine/geometry/flow/vortex_cores.h). Between two knots of a core lie so many
/// points that a chord leaves it by at most 1e-6 L; "swirl" is the value at each. Frame thread.
#pragma once
#include "engine/scene/scene.h"

namespace catena::scene {

/// Of curves with `traced`: those of the field as it is now, which after a step in time are others. An error where there is no core.
Result<curves::CurveSetPtr> resolve_vortex_core_curves(Scene& scene, Entity curves);

}  // namespace catena::scene
