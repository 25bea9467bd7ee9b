// SPDX-License-Identifier: MIT
// Exact behaviour of an isosurface link: sides, release, thin sheets, the domain's boundary, invalid voxels.
#include "tests/haptics/constraints/constraint_fixture.h"

namespace catena::haptics::tests::isosurface_semantics_test {

const std::string kAbove = R"(, "free": "above")", kBelow = R"(, "free": "below")";

/// The sphere |x| = 1 as a formula and as a grid; the grid's error is far below the tolerances.
class Sphere : public testing::TestWithParam<bool> {
 protected:
  field::ScalarFieldPtr field() const { return GetParam() ? sampled_field("sphere", 81) : analytic_field("sphere"); }
  ConstraintPtr make(const std::string& more) const { return isosurface(field(), 1, more); }
  double slack() const { return GetParam() ? 2e-3 : 1e-11; }
};

TEST_P(Sphere, ProxyIsTheProbeBitForBitOnTheFreeSide) {
  for (const auto& [side, sign] : {std::pair{kAbove, 1.0}, std::pair{kBelow, -1.0}}) {
    Rig rig(make(side));
    Random random(3);
    Vec3 probe = Vec3(0.3, 0.4, 0.5) * (sign > 0 ? 2.0 : 0.5);
    for (int i = 0; i < 2000; ++i) {
      probe = probe + random.unit() * 0.01;
      if (norm(probe) > 1.7) probe = probe * 0.98;
      rig.tick(probe);
      const bool free = sign * (norm(probe) - 1) > 0;
      if (std::fabs(norm(probe) - 1) < slack()) continue;
      EXPECT_TRUE(rig.state.active());
      if (free) {
        ASSERT_EQ(rig.state.status, LinkStatus::free) << i;
        ASSERT_TRUE(bitwise_equal(rig.state.proxy, probe));
        ASSERT_LE(rig.state.evaluations, 12);
      } else {
        ASSERT_EQ(rig.state.status, LinkStatus::ok) << i;
        ASSERT_NEAR(norm(rig.state.proxy), 1, slack());
        ASSERT_LE(norm(rig.state.proxy - direction(probe)), 20 * slack() + 4e-6);
      }
    }
  }
}

TEST_P(Sphere, ACrossingIsDecidedWithinTheTick) {
  Rig rig(make(kAbove));
  expect_steps(rig, {
                        {{0, 0, 1.5}, kFree}, {{0, 0.1, 0.5}, kOk}  // a jump to the held side
                    });
  EXPECT_NEAR(norm(rig.state.proxy), 1, slack());
  EXPECT_GT(rig.state.proxy.z, 0.9);
  expect_steps(rig, {{{0, 0, 1.5}, kFree, {0, 0, 1.5}}});
}

TEST_P(Sphere, OneSidedReArmsOnTheFreeSide) {
  Rig rig(make(kAbove + R"(, "release": 0.2)"));
  expect_steps(rig, {{{0, 0, 1.1}, kFree}, {{0, 0, 0.85}, kOk}, {{0, 0, 0.79}, kReleased, {0, 0, 0.79}}});
  EXPECT_FALSE(rig.state.active());
  expect_steps(rig, {{{0, 0, 0.99}, kReleased}, {{0, 0, 1.01}, kFree}});
  EXPECT_TRUE(rig.state.active());
  EXPECT_EQ(rig.tick({0, 0, 0.95}).status, LinkStatus::ok);
}

TEST_P(Sphere, TwoSidedReArmsNearOrAcrossTheLevel) {
  Rig rig(make(R"(, "release": 0.2)"));
  expect_steps(rig, {
                        {{0, 0, 1.1}, kOk},
                        {{0, 0, 1.21}, kReleased},
                        {{0, 0, 1.03}, kReleased},
                        {{0, 0, 1.018}, kOk},  // within a tenth of release
                        {{0, 0, 1.3}, kReleased},
                        {{0, 0, 0.9}, kOk}  // crosses the level in one tick
                    });
  EXPECT_NEAR(rig.state.proxy.z, 1, slack());
  expect_steps(rig, {
                        {{0, 0, 0.7}, kReleased},
                        {{0, 0, 0.97}, kReleased},
                        {{0, 0, 0.985}, kOk},
                        {{0, 0, 0.7}, kReleased},
                        {{0, 0, 1.5}, kReleased}  // crosses beyond the release distance: stays released
                    });
}

TEST_P(Sphere, FirstProbeDeeperThanReleaseStartsReleased) {
  Rig deep(make(kAbove + R"(, "release": 0.2)"));
  expect_steps(deep, {{{0.1, 0, 0.7}, kReleased, {0.1, 0, 0.7}}});
  Rig shallow(make(kAbove + R"(, "release": 0.2)"));
  EXPECT_EQ(shallow.tick({0, 0, 0.85}).status, LinkStatus::ok);
  Rig free(make(kBelow + R"(, "release": 0.2)"));
  EXPECT_EQ(free.tick({0, 0, 0.1}).status, LinkStatus::free);
}

TEST_P(Sphere, TheCentreDoesNotTrapTheProxy) {
  Rig rig(make(""));
  EXPECT_EQ(rig.tick(Vec3(0.0)).status, LinkStatus::ok);
  EXPECT_NEAR(norm(rig.state.proxy), 1, 0.01);
  rig.tick({1e-9, 0, 0});
  for (int i = 0; i < 20; ++i) rig.tick({0.01, 0, 0});
  EXPECT_EQ(rig.state.status, LinkStatus::ok);
  EXPECT_NEAR(norm(rig.state.proxy), 1, 0.01);
}

TEST_P(Sphere, ATangentialPathStaysOnTheSurface) {
  Rig rig(make(""));
  Rig sided(make(kAbove));
  for (int i = -500; i <= 500; ++i) {
    const Vec3 probe(i * 2e-3, 0, 1);  // tangent to the sphere at i = 0
    rig.tick(probe);
    sided.tick(probe);
    ASSERT_EQ(rig.state.status, LinkStatus::ok) << i;
    ASSERT_NEAR(norm(rig.state.proxy), 1, slack());
    ASSERT_LE(norm(rig.state.proxy - direction(probe)), 20 * slack() + 4e-6);
    ASSERT_TRUE(i == 0 || std::fabs(norm(probe) - 1) <= slack() || sided.state.status == kFree) << i;
  }
}

INSTANTIATE_TEST_SUITE_P(BothKinds, Sphere, testing::Bool(), [](const auto& test) { return test.param ? "Grid" : "Formula"; });

TEST(IsosurfaceSemantics, AFastHandDoesNotTunnelThroughAThinSheet) {
  // |z| on a fine grid: a sheet 0.02 thick, free above, crossed by steps of 0.05
  Rig rig(isosurface(cube_grid(65, [](const Vec3& p) { return std::fabs(p.z); }), 0.01, kAbove));
  expect_steps(rig, {{{0.3, 0.2, 0.04}, kFree}, {{0.3, 0.2, -0.03}, kOk}});
  EXPECT_NEAR(rig.state.proxy.z, 0.01, 1e-6);
  EXPECT_EQ(rig.tick({0.3, 0.25, -0.04}).status, LinkStatus::ok);  // slides along the sheet
  EXPECT_NEAR(rig.state.proxy.y, 0.25, 1e-6);
  expect_steps(rig, {{{0.3, 0.25, 0.03}, kFree},
                     // a jump is not a hand's motion: free by the field's value
                     {{0.3, 0.2, -1.5}, kFree}});
}

TEST(IsosurfaceSemantics, AChordThroughAShallowCapIsFree) {
  // a fast chord from outside to outside through a shallow cap of the sphere
  Rig rig(isosurface(analytic_field("sphere"), 1, kAbove));
  rig.tick({-0.035, 0, 0.99999});
  EXPECT_EQ(rig.tick({0.035, 0, 0.99999}).status, LinkStatus::free);
}

TEST(IsosurfaceSemantics, WithoutASurfaceTheProbePassesThrough) {
  Rig rig(isosurface(analytic_field("constant"), 1));
  // the search covers the whole domain and may take several ticks
  EXPECT_TRUE(bitwise_equal(rig.tick({0.1, 0.2, 0.3}).proxy, Vec3(0.1, 0.2, 0.3)));
  rig.arrive({0.1, 0.2, 0.3}, 1);
  EXPECT_EQ(rig.state.status, LinkStatus::no_surface);
  EXPECT_TRUE(bitwise_equal(rig.state.proxy, Vec3(0.1, 0.2, 0.3)));
  EXPECT_LE(rig.state.evaluations, kMaxEvaluations);
}

TEST(IsosurfaceSemantics, FarStartsEndOnTheLevel) {
  for (const double d : {3.0, 6.0, -5.0}) {
    Rig rig(isosurface(analytic_field("sphere"), 1));
    EXPECT_EQ(rig.tick({0, d, 0}).status, LinkStatus::ok) << d;
    EXPECT_NEAR(std::fabs(rig.state.proxy.y), 1, 1e-11);
  }
  Rig grid(isosurface(sampled_field("sphere", 33), 1));
  EXPECT_EQ(grid.tick({0, 50, 0}).status, LinkStatus::ok);
  EXPECT_NEAR(grid.state.proxy.y, 1, 0.01);
}

TEST(IsosurfaceSemantics, InvalidVoxelsNeverReachTheOutput) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const auto grid = cube_grid(17, [&](const Vec3& p) { return p.x > 0.4 && p.x < 0.9 ? nan : static_cast<float>(p.z - 0.1 * p.x); });
  for (const std::string& side : {std::string(), kAbove, kBelow}) {
    Rig rig(isosurface(grid, 0, side));
    int walls = 0;
    for (double x = -1; x < 2; x += 0.01) {
      for (const double z : {0.3, -0.3}) {
        ASSERT_TRUE(is_finite(rig.tick({x, 0.1, z}).proxy)) << x;
        ASSERT_TRUE(std::isfinite(rig.state.residual));
        const bool wall = rig.state.status == LinkStatus::boundary || rig.state.status == LinkStatus::critical;
        walls += wall;
        EXPECT_TRUE(!wall || x >= 1.5 || rig.state.reason == SampleStatus::not_finite) << "there is no mask: " << x << " " << z << side;
      }
    }
    EXPECT_GT(walls, 0) << side;
  }
}

TEST(IsosurfaceSemantics, RotatedAndShearedGridsAreExactInWorldCoordinates) {
  Random random(5);
  for (int i = 0; i < 20; ++i) {
    Mat3 j(0.0);
    for (int a = 0; a < 3; ++a) j[a] = random.unit() * 0.1;
    if (std::fabs(dot(j[0], cross(j[1], j[2]))) < 3e-4) continue;
    const auto mapping = field::Mapping::from_linear(j, j * Vec3(-20.0));
    // trilinear cells of any shape reproduce a plane exactly
    const Vec3 n = random.unit();
    const auto grid = sample_scalar_grid(mapping, {41, 41, 41}, [&](const Vec3& p) { return dot(n, p); });
    Rig rig(isosurface(grid, 0.01));
    for (int k = 0; k < 50; ++k) {
      const Vec3 probe = random.box(0.15);
      rig.tick(probe);
      const Vec3 e = probe - rig.state.proxy;
      if (rig.state.status != LinkStatus::ok) continue;
      EXPECT_LE(norm(e - n * dot(n, e)), 1e-6) << i;  // the values are floats
      EXPECT_NEAR(dot(n, rig.state.proxy), 0.01, 1e-7);
    }
    EXPECT_EQ(rig.state.status, LinkStatus::ok);
  }
}

TEST(IsosurfaceSemantics, TheSurfaceOfASliceIsACurve) {
  // a grid of one voxel layer: the surface is a circle in the slice
  const auto grid = sample_scalar_grid(field::Mapping::from_linear(Mat3(0.1), Vec3(-2, -2, 0.5)), {41, 41, 1},
                                       [](const Vec3& p) { return std::sqrt(p.x * p.x + p.y * p.y); });
  Rig rig(isosurface(grid, 1));
  for (double a = 0; a < 6; a += 0.1) {
    rig.tick({1.3 * std::cos(a), 1.3 * std::sin(a), 0.7});
    EXPECT_EQ(rig.state.status, LinkStatus::ok) << a << " work " << rig.state.work() << " ev " << rig.state.evaluations;
    EXPECT_NEAR(rig.state.proxy.z, 0.5, 1e-12);
    EXPECT_NEAR(std::sqrt(rig.state.proxy.x * rig.state.proxy.x + rig.state.proxy.y * rig.state.proxy.y), 1, 3e-3);
  }
}

TEST(IsosurfaceSemantics, ProxiesAreInvariantUnderScalingOfTheField) {
  for (const double scale : {1e-300, 1e-30, -2.0, 1e30, 1e300}) {
    Rig one(isosurface(analytic_field("sphere"), 1)), other(isosurface(analytic_field("sphere", scale), scale));
    Random random(6);
    for (int i = 0; i < 200; ++i) {
      const Vec3 probe = random.box(1.5);
      one.tick(probe);
      ASSERT_LE(norm(one.state.proxy - other.tick(probe).proxy), 1e-7) << scale;
      ASSERT_EQ(other.state.status, LinkStatus::ok);
    }
  }
}

TEST(IsosurfaceSemantics, KeysAreChecked) {
  Fields fields = scalars({{"s", analytic_field("sphere")}, {"g", sampled_field("sphere", 9)}});
  fields.named["v"].vector = field::make_analytic("circle")->vector;
  const std::string head = "{\"name\": \"a\", \"type\": \"isosurface\",\n";
  EXPECT_TRUE(try_build(head + R"("field": "s", "level": 1})", fields));
  for (const char* missing : {R"("level": 1})", R"("field": "s"})"}) expect_refused(head + missing, 1, {}, fields);
  for (const char* rest :
       {R"("field": "none", "level": 1})", R"("field": "s", "level": -1})", R"("field": "g", "level": 99})",
        R"("field": "s", "level": "1"})", R"("field": "s", "level": 1, "free": "inside"})", R"("field": "s", "level": 1, "release": 0})",
        R"("field": "s", "level": 1, "release": -0.1})", R"("field": "s", "level": 1e999})", R"("field": "s", "level": 1, "relase": 1})"})
    expect_refused(head + rest, 2, {}, fields);
  expect_refused(head + R"("field": "v", "level": 1})", 2, {"vector"}, fields);
  expect_refused(head + "\"field\": \"g\",\n\"level\": 99}", 3, {"99"}, fields);
}

}  // namespace catena::haptics::tests::isosurface_semantics_test
