// SPDX-License-Identifier: MIT
/// Snap turns, and the strength of the vignette while the world moves.
#include "engine/app/viewer/xr/comfort.h"

#include <gtest/gtest.h>

#include <functional>
#include <utility>

#include "engine/app/viewer/xr/world_grab.h"

namespace catena::comfort_test {

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
  double last = 0;
  // Moves the world `steps` times; each strength is passed on.
  const auto move = [&](int steps, const std::function<Placement(Placement)>& moved) {
    for (int k = 0; k < steps; ++k) {
      const Placement before = std::exchange(now, moved(now));
      last = vignette.step(before, now, head, dt);
    }
  };
  const auto shifted = [](const Vec3& by) {
    return [by](Placement p) {
      p.world_origin += by;
      return p;
    };
  };
  EXPECT_EQ(vignette.step(still, still, head, 0.01), 0);
  for (int k = 1; k <= 10; ++k) {
    move(1, shifted({-0.02, 0, 0}));  // 2 m/s
    EXPECT_NEAR(last, 0.1 * k, 1e-12);
  }
  move(40, shifted(Vec3(0.0)));
  EXPECT_NEAR(last, 0, 1e-12);

  // Half the reference rotation speed gives half the strength; scaling counts away from its fixed point; slow drift does not count.
  move(100, [&](const Placement& p) { return rotate_about(p, head, 0.005); });
  EXPECT_NEAR(last, 0.5, 1e-9);
  move(100, [&](const Placement& p) { return move_world(p, head, kIdentityRotation, std::exp(0.0025), head); });
  EXPECT_NEAR(last, 0.25, 1e-9);
  move(100, shifted({0, -0.0005 / now.meters_per_unit, 0}));
  EXPECT_NEAR(last, 0, 1e-12);
  EXPECT_EQ(vignette.step(now, still, head, 0), last) << "no time, no change";
}

}  // namespace catena::comfort_test
