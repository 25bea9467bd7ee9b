// SPDX-License-Identifier: MIT
/// Clip planes that leave nothing, against points drawn at random.
#include "render/extract/clipped_away.h"

#include <gtest/gtest.h>

#include <random>

namespace catena::render::clipped_away_test {

TEST(ClippedAway, AgreesWithPointsInTheBox) {
  const Bounds box{{-1, -2, 0}, {1, 1, 3}};
  std::mt19937_64 random(7);
  std::uniform_real_distribution<double> unit(-1, 1);
  const auto any = [&] { return Vec3(unit(random), unit(random), unit(random)); };
  int empty = 0;
  for (int trial = 0; trial < 200; ++trial) {
    std::vector<Plane> planes;
    for (int k = 0; k < 5; ++k) planes.push_back({box.center() + 1.2 * any(), any()});
    bool found = false;
    for (int n = 0; n < 3000 && !found; ++n) {
      const Vec3 p = box.center() + 0.5 * any() * (box.hi - box.lo);
      found = std::ranges::all_of(planes, [&](const Plane& plane) { return dot(p - plane.point, plane.normal) >= 0; });
    }
    const bool common = has_common_point(box, planes);
    EXPECT_TRUE(common || !found) << trial << ": a point is inside";
    empty += !common;
  }
  EXPECT_GT(empty, 20);
  EXPECT_LT(empty, 180);
}

TEST(ClippedAway, ASlabBetweenTwoPlanesIsVisibleAndOppositePlanesLeaveNothing) {
  const Bounds box{Vec3(-1.0), Vec3(1.0)};
  const Plane right{{0.1, 0, 0}, {1, 0, 0}}, left{{0.2, 0, 0}, {-1, 0, 0}}, far_left{{0, 0, 0}, {-1, 0, 0}};
  EXPECT_TRUE(has_common_point(box, std::vector{right, left})) << "no corner of the box is left";
  EXPECT_FALSE(has_common_point(box, std::vector{right, far_left}));
  FramePacket packet;
  packet.tubes.push_back({});
  packet.tubes[0].points = {Vec3(-1.0), Vec3(1.0)};
  packet.clip_planes = {right, far_left};
  EXPECT_TRUE(is_clipped_away(packet));
  packet.tubes[0].is_clipped = false;
  EXPECT_FALSE(is_clipped_away(packet));
}

}  // namespace catena::render::clipped_away_test
