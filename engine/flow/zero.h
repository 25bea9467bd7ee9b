/// Newton's search for a zero of the field near a place: nodes, saddles, centres. Central differences over 2e-6 L; minimum-norm
/// steps, so that planar fields and lines of zeros work. Scale of the field is irrelevant. Any thread; no allocation.
#pragma once
#include <optional>

#include "engine/flow/flow.h"

namespace catena::flow {

/// A zero within `radius` of p, or nothing. `evaluations` is added to; at most `budget` are spent.
std::optional<Vec3> find_zero(const Flow& flow, const Vec3& p, const Vec3& reference, double radius, field::Cursor& cursor, int budget,
                              int& evaluations) noexcept;

}  // namespace catena::flow
