/// What the rows of the flow share: a line that is integrated in every tick, and how a traced one ends.
#pragma once
#include "engine/flow/curve.h"
#include "haptics/constraints/streamline/online.h"
#include "tests/haptics/constraints/rig.h"

namespace catena::extremes {

using Velocity = Vec3 (*)(const Vec3&);

inline haptics::tests::Rig online_rig(field::VectorFieldPtr field, const Vec3& seed) {
  haptics::OnlineSpec spec;
  spec.field = std::move(field);
  spec.seed = seed;
  return haptics::tests::Rig(haptics::make_online_streamline(spec));
}

inline std::string ends_of(const flow::Curve& curve) {
  return std::string("from ") + flow::end_word(curve.first_end().end) + " to " + flow::end_word(curve.last_end().end);
}

}  // namespace catena::extremes
