// SPDX-License-Identifier: MIT
#include "tests/haptics/chain/chain_driver.h"
#include "tests/haptics/constraints/friction_fixture.h"

namespace catena::haptics::tests::drag_test {

using catena::test::ChainDriver;

std::string drag(const std::string& threshold, const std::string& more = "") {
  return R"({"name": "a", "type": "drag", "threshold": )" + threshold + more + "}";
}

TEST(Drag, SticksExactlyAndSlidesAtTheThreshold) {
  for (const double size : {1e-9, 1.0, 1e6}) {
    const double tau = 0.05 * size;
    Rig rig(build(drag(to_json(tau))));
    Random random(4);
    Vec3 probe = random.box(size);
    EXPECT_TRUE(bitwise_equal(rig.tick(probe).proxy, probe));  // starts at the link's input
    int stuck = 0, slid = 0;
    for (int i = 0; i < 5000; ++i) {
      const Vec3 before = rig.state.proxy;
      probe = probe + random.unit() * (0.01 * size);
      EXPECT_EQ(rig.tick(probe).status, LinkStatus::ok);
      EXPECT_EQ(rig.state.limit, tau);
      EXPECT_EQ(rig.state.evaluations, 0);
      if (norm(probe - before) <= tau) {
        ASSERT_TRUE(bitwise_equal(rig.state.proxy, before));
        ++stuck;
      } else {
        ASSERT_NEAR(norm(probe - rig.state.proxy), tau, 1e-15 * std::max(norm(probe), tau));
        // towards the probe
        ASSERT_LE(norm(cross(rig.state.proxy - before, direction(probe - before))), 1e-15 * norm(probe));
        ++slid;
      }
    }
    EXPECT_GT(stuck, 100);
    EXPECT_GT(slid, 100);
  }
}

TEST(Drag, AZeroThresholdGivesNoDrag) {
  Rig rig(build(drag("0")));
  Random random(6);
  for (int i = 0; i < 100; ++i) {
    const Vec3 probe = random.box(3);
    EXPECT_TRUE(bitwise_equal(rig.tick(probe).proxy, probe));
  }
}

// 4 K tau (A - tau) per loop, in the whole tick
TEST(Drag, DissipatesTheWorkOfALoop) {
  constexpr double kTau = 0.02, kAmplitude = 0.1, kStiffness = 400;
  constexpr int kLoop = 20000;
  ChainDriver hand;
  hand.add(build(drag("0.02")), kStiffness);
  const Vec3 way = direction(Vec3(1, -2, 0.5));
  double work = 0;
  Vec3 last_probe(0.0), last_force(0.0);
  for (int k = 0; k <= 2 * kLoop; ++k) {
    const Vec3 probe = way * (kAmplitude * std::sin(2 * 3.14159265358979323846 * k / kLoop));
    hand.step(probe, 0, 1e-4);
    if (k > kLoop) work -= dot(probe - last_probe, hand.out.force_n + last_force) * 0.5;
    last_probe = probe;
    last_force = hand.out.force_n;
  }
  const double expected = 4 * kStiffness * kTau * (kAmplitude - kTau);
  EXPECT_NEAR(work, expected, 1e-4 * expected);
}

TEST(Drag, TheThresholdMayFollowAField) {
  Rig rig(build(drag(R"({"field": "r", "map": [[0, 0.1], [2, 0.3]]})"), scalars({{"r", analytic_field("sphere")}})));
  EXPECT_EQ(rig.tick({1, 0, 0}).limit, 0.2);
  EXPECT_NEAR(rig.tick({1.5, 0, 0}).proxy.x, 1.3, 1e-15);  // the threshold at the proxy before it moved
  EXPECT_NEAR(rig.tick({1.6, 0, 0}).limit, 0.23, 1e-15);
}

// on a surface: sticks exactly; where it slides, |x - p| = tau on the level
TEST(Drag, OnASurfaceSticksExactlyAndSlidesAtTheThreshold) {
  for (const auto& [field, level] : {std::pair{analytic_field("sphere"), 1.0},
                                     {analytic_field("torus"), 0.4},
                                     {sampled_field("sphere", 32), 1.0},
                                     {sampled_field("torus", 64), 0.4}}) {
    SCOPED_TRACE(fmt::format("level {}, grid {}", level, field->is_grid()));
    Rig rig(build(drag("0.03", R"(, "surface": "s", "level": )" + to_json(level)), scalars({{"s", field}})));
    const std::vector<Vec3> path = walk_on_surface(field, level, {1, 0.1, 0.2}, 0.004, 20000, 7);
    ASSERT_GT(path.size(), 15000u);
    int stuck = 0;
    for (const Vec3& probe : path) {
      const Vec3 before = rig.state.proxy;
      ASSERT_EQ(rig.tick(probe).status, LinkStatus::ok);
      ASSERT_LE(off_level(*field, level, rig.state.proxy), 4e-12);
      if (norm(probe - before) <= 0.03) {
        ASSERT_TRUE(bitwise_equal(rig.state.proxy, before));
        ++stuck;
      } else if (&probe != &path.front()) {
        ASSERT_LE(std::fabs(norm(probe - rig.state.proxy) - 0.03), 1e-12);
      }
    }
    EXPECT_GT(stuck, 500);
  }
}

TEST(Drag, OffTheSurfaceThereIsNoFriction) {
  Rig rig(build(drag("0.2", R"(, "surface": "s", "level": 1)"), scalars({{"s", analytic_field("sphere")}})));
  expect_steps(rig, {
                        {{0, 0, 1.2}, kFree, {0, 0, 1.2}},
                        {{0, 0, 1}, kOk},
                        {{0.1, 0, std::sqrt(0.99)}, kOk, {0, 0, 1}},  // sticks
                        {{0.1, 0, 1.1}, kFree, {0.1, 0, 1.1}},
                        {{0, 0.6, 0.8}, kOk}  // starts where the probe returns to the surface
                    });
  EXPECT_LE(norm(rig.state.proxy - Vec3(0, 0.6, 0.8)), 1e-15);
}

// two spheres without a surface between them to slide on
TEST(Drag, AJumpToAnotherSheetRestartsThere) {
  const auto two = cube_grid(41, [](const Vec3& p) { return std::min(norm(p - Vec3(1, 0, 0)), norm(p + Vec3(1, 0, 0))); });
  const Vec3 left = walk_on_surface(two, 0.5, {-1.5, 0.1, 0}, 0.001, 2, 1).back(),
             right = walk_on_surface(two, 0.5, {1.5, 0.1, 0}, 0.001, 2, 1).back();
  Rig rig(build(drag("0.8", R"(, "surface": "s", "level": 0.5)"), scalars({{"s", two}})));
  rig.tick(left);
  EXPECT_TRUE(is_finite(rig.tick(right).proxy));
  if (rig.state.status == LinkStatus::no_surface) {
    EXPECT_TRUE(bitwise_equal(rig.state.proxy, right));
  } else {
    EXPECT_LE(norm(right - rig.state.proxy), norm(right - left));
    EXPECT_LE(off_level(*two, 0.5, rig.state.proxy), 4e-9);
  }
}

TEST(Drag, RefusesBadKeys) {
  Fields fields = scalars({{"s", analytic_field("sphere")}});
  fields.named["v"].vector = field::make_analytic("circle")->vector;
  const std::pair<std::string, const char*> bad[] = {{R"({"name": "a", "type": "drag"})", "threshold"},
                                                     {drag("-1"), "threshold"},
                                                     {drag("1", R"(, "level": 1)"), "no \"surface\""},
                                                     {drag("1", R"(, "surface": "s")"), "no \"level\""},
                                                     {drag("1", R"(, "surface": "v", "level": 1)"), "vector field"},
                                                     {drag("1", R"(, "surface": "s", "level": -3)"), "not attained"},
                                                     {drag("1", R"(, "surfaces": "s")"), "unknown key"}};
  for (const auto& [text, what] : bad) expect_refused(text, 1, {what}, fields);
}

}  // namespace catena::haptics::tests::drag_test
