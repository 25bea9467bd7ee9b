// SPDX-License-Identifier: MIT
/// Input of the friction links: the proxies of an isosurface link along a random walk of the hand.
#pragma once
#include "tests/engine/geometry/flow/lambda_field.h"
#include "tests/haptics/constraints/constraint_fixture.h"

namespace catena::haptics::tests {

using catena::test::lambda_field;

/// `step`: the hand's step in world units per tick. Starts near `from`.
inline std::vector<Vec3> walk_on_surface(const field::ScalarFieldPtr& surface, double level, const Vec3& from, double step, int ticks,
                                         std::uint64_t seed) {
  Rig rig(isosurface(surface, level));
  Random random(seed);
  std::vector<Vec3> path;
  Vec3 hand = from, v = random.unit() * step;
  for (int i = 0; i < ticks; ++i) {
    v = direction(v + random.unit() * (0.2 * step)) * step;
    rig.tick(hand + v);
    // the hand follows the surface, slightly off it
    hand = rig.state.proxy;
    if (rig.state.status == LinkStatus::ok) path.push_back(hand);
    if (rig.state.status != LinkStatus::ok) v = -v;
  }
  return path;
}

/// Distance from the level, |s - level| / |grad s|.
inline double off_level(const field::ScalarField& surface, double level, const Vec3& p) {
  field::Cursor cursor;
  const field::ScalarSample s = surface.sample(p, cursor);
  return std::fabs(s.value - level) / norm(s.gradient);
}

}  // namespace catena::haptics::tests
