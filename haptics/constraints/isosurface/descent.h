/// The closest point of a strongly folded level set to the probe x, where the quick iteration of isosurface/analytic.h fails.
/// Every point kept is on the level; f = |x - p|^2 / 2 falls from point to point:
///   u = (I + delta B)^-1 t in a trust region (|eigenvalues|), then back to the level along n: Newton, halves inside a bracket
///   accepted: f falls by 1e-4 t.u at least; near a minimum (I + delta B positive, |t| small): |t| falls to 0.7
/// B is measured after a refusal, else learned. 2 to 6 fetches an iteration. Haptic thread.
#pragma once
#include "haptics/constraints/isosurface/analytic.h"

namespace catena::haptics {

/// From `at`, on the level to 1e-9 L or so. stuck: no step that can be told from noise goes down: a kink, or no gradient.
Closest descend(LevelField& field, const Vec3& probe, const ClosestGoal& goal, LevelPoint& at, Curvature& curvature) noexcept;

}  // namespace catena::haptics
