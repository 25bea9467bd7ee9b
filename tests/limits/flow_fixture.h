// SPDX-License-Identifier: MIT
/// Shared helpers of the flow's rows: an online line, and the end of a traced line.
#pragma once
#include "engine/geometry/flow/curve.h"
#include "haptics/constraints/streamline/online_streamline.h"
#include "tests/haptics/constraints/constraint_fixture.h"
#include "tests/limits/limits_table.h"

namespace catena::extremes {

using Velocity = Vec3 (*)(const Vec3&);

inline haptics::tests::Rig make_online_rig(field::VectorFieldPtr field, const Vec3& seed) {
  haptics::OnlineStreamlineSpec spec;
  spec.field = std::move(field);
  spec.seed = seed;
  return haptics::tests::Rig(haptics::make_online_streamline(spec));
}

inline flow::CurvePtr trace(const field::VectorFieldPtr& field, const Vec3& seed) { return get(flow::trace({field.get()}, seed)); }

inline std::string stop_names(const flow::Curve& curve) {
  return std::string("from ") + flow::to_string(curve.first_end().termination) + " to " + flow::to_string(curve.last_end().termination);
}

}  // namespace catena::extremes
