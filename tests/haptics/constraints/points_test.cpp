// SPDX-License-Identifier: MIT
#include "tests/haptics/constraints/examples.h"

namespace catena::haptics::tests::points_test {

curves::PointSetPtr cloud(int count, unsigned seed) {
  Random random(seed);
  auto set = std::make_shared<curves::PointSet>();
  for (int i = 0; i < count; ++i) set->points.emplace_back(random.box(1));
  set->min_corner = Vec3(-1.0);
  set->max_corner = Vec3(1.0);
  set->version = 1000000 + seed;
  return set;
}

double distance_to(const curves::PointSet& set, const Vec3& x) {
  double minimum = 1e300;
  for (const glm::vec3& p : set.points) minimum = std::min(minimum, norm(x - Vec3(p)));
  return minimum;
}

TEST(PointsLink, HoldsTheClosestPoint) {
  Random random(1);
  for (const int count : {1, 2, 9, 3000, 100000}) {
    Fields fields;
    fields.points["cloud"] = cloud(count, static_cast<unsigned>(count));
    const auto made = build(R"({"name": "a", "type": "points", "points": "cloud"})", fields);
    for (int i = 0; i < 20; ++i) {
      Rig rig(made);
      const Vec3 probe = random.box(1.5);
      rig.arrive(probe, 19);
      ASSERT_EQ(norm(probe - rig.state.proxy), distance_to(*fields.points["cloud"], probe)) << count;
      ASSERT_LE(rig.state.work(), kMaxWork);
    }
  }
}

TEST(PointsLink, HoldsItsPointUntilReleaseAndSnapsToTheNext) {
  Fields fields;
  auto set = std::make_shared<curves::PointSet>();
  set->points = {{0, 0, 0}, {1, 0, 0}};
  set->max_corner = Vec3(1, 0, 0);
  set->version = 999;
  fields.points["two"] = set;
  Rig rig(build(R"({"name": "a", "type": "points", "points": "two", "snap": 0.2, "release": 0.75})", fields));
  expect_steps(rig, {{{0.3, 0, 0}, kReleased},
                     {{0.15, 0, 0}, kOk, {0, 0, 0}},
                     {{0.6, 0, 0}, kOk, {0, 0, 0}},
                     {{0.74, 0, 0}, kOk, {0, 0, 0}},
                     {{0.77, 0, 0}, kReleased},
                     {{0.85, 0, 0}, kOk, {1, 0, 0}}});
}

TEST(PointsLink, AMillionPointsFitTheWorkLimitOfATick) {
  Fields fields;
  fields.points["cloud"] = cloud(1000000, 77);
  Rig rig(build(R"({"name": "a", "type": "points", "points": "cloud", "snap": 0.05, "release": 0.06})", fields));
  Random random(3);
  int held = 0, maximum = 0;
  for (int hop = 0; hop < 20; ++hop) {
    const Vec3 from = random.box(0.9), way = random.box(0.3);
    for (int k = 0; k < 200; ++k) {
      rig.tick(from + way * (0.005 * k));
      maximum = std::max(maximum, rig.state.work());
      held += rig.state.released ? 0 : 1;
    }
  }
  EXPECT_LE(maximum, kMaxWork);
  EXPECT_GT(held, 3500);
}

}  // namespace catena::haptics::tests::points_test
