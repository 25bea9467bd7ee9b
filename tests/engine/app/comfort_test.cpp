// SPDX-License-Identifier: MIT
/// Snap turns, and the strength of the vignette while the world moves.
#include "engine/app/viewer/xr/comfort.h"

#include <gtest/gtest.h>

#include "engine/app/viewer/xr/world_grab.h"

namespace comfort_test {

using namespace catena;
using namespace catena::xr_interaction;

TEST(SnapTurn, APushOfTheStickIsOneStep) {
  SnapTurn turn;
  double sum = 0;
  for (const double x : {0.0, 0.2, 0.5, 0.69, 0.71, 1.0, 0.8, 0.4, 0.9, 0.29, 0.5, 0.75}) sum += turn.step(x);
  EXPECT_NEAR(sum, -2 * M_PI / 6, 1e-15) << "0.4 is not far enough back";
  EXPECT_EQ(turn.step(-0.9), 0) << "through the middle too fast: not armed";
  EXPECT_EQ(turn.step(0), 0);
  EXPECT_NEAR(turn.step(-1), M_PI / 6, 1e-15);
  EXPECT_EQ(turn.step(NAN), 0);
}

TEST(SnapTurn, AStepRotatesTheWorldAboutTheHead) {
  const Placement before{{1, 1, 1}, glm::mat3_cast(rotation_from_vector({0.2, 0.3, 0.4})), 0.1};
  const Vec3 head(0.5, 1.7, 0.2);
  const Placement after = rotate_about(before, head, M_PI / 2);
  EXPECT_LT(norm(after.to_room(before.to_world(head)) - head), 1e-15);
  // Seen from above, counter-clockwise: a point ahead (-z) moves to the left (-x).
  EXPECT_LT(norm(after.to_room(before.to_world(head + Vec3(0, 0.3, -1))) - head - Vec3(-1, 0.3, 0)), 1e-14);
}

TEST(Vignette, RisesWhileTheWorldMovesAndFallsAtRest) {
  Vignette vignette;
  Placement still, now;
  const Vec3 head(0, 1.7, 0);
  const double dt = 0.01;
  EXPECT_EQ(vignette.step(still, still, head, dt), 0);
  double last = 0;
  for (int k = 0; k < 10; ++k) {
    const Placement before = now;
    now.world_origin.x -= 0.02;  // 2 m/s
    const double strength = vignette.step(before, now, head, dt);
    EXPECT_NEAR(strength, last + 0.1, 1e-12);
    last = strength;
  }
  EXPECT_NEAR(last, 1, 1e-12);
  for (int k = 0; k < 40; ++k) last = vignette.step(now, now, head, dt);
  EXPECT_NEAR(last, 0, 1e-12);

  // Half the reference rotation speed gives half the strength; scaling counts away from its fixed point; slow drift does not count.
  for (int k = 0; k < 100; ++k) {
    const Placement before = now;
    now = rotate_about(now, head, 0.005);
    last = vignette.step(before, now, head, dt);
  }
  EXPECT_NEAR(last, 0.5, 1e-9);
  for (int k = 0; k < 100; ++k) {
    const Placement before = now;
    now = move_world(now, head, kIdentityRotation, std::exp(0.0025), head);
    last = vignette.step(before, now, head, dt);
  }
  EXPECT_NEAR(last, 0.25, 1e-9);
  for (int k = 0; k < 100; ++k) {
    const Placement before = now;
    now.world_origin.y -= 0.0005 / now.meters_per_unit;
    last = vignette.step(before, now, head, dt);
  }
  EXPECT_NEAR(last, 0, 1e-12);
  EXPECT_EQ(vignette.step(now, still, head, 0), last) << "no time, no change";
}

}  // namespace comfort_test
