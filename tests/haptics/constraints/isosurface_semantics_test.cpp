// SPDX-License-Identifier: MIT
// Exact behaviour of an isosurface link: sides, release, thin sheets, the domain's boundary, invalid voxels.
#include "tests/haptics/constraints/constraint_fixture.h"

namespace catena::haptics::tests {
namespace isosurface_semantics_test {

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
  EXPECT_EQ(rig.tick({0, 0, 1.5}).status, LinkStatus::free);
  EXPECT_EQ(rig.tick({0, 0.1, 0.5}).status, LinkStatus::ok);  // a jump to the held side
  EXPECT_NEAR(norm(rig.state.proxy), 1, slack());
  EXPECT_GT(rig.state.proxy.z, 0.9);
  EXPECT_EQ(rig.tick({0, 0, 1.5}).status, LinkStatus::free);
  EXPECT_TRUE(bitwise_equal(rig.state.proxy, Vec3(0, 0, 1.5)));
}

TEST_P(Sphere, OneSidedReArmsOnTheFreeSide) {
  Rig rig(make(kAbove + R"(, "release": 0.2)"));
  EXPECT_EQ(rig.tick({0, 0, 1.1}).status, LinkStatus::free);
  EXPECT_EQ(rig.tick({0, 0, 0.85}).status, LinkStatus::ok);
  EXPECT_EQ(rig.tick({0, 0, 0.79}).status, LinkStatus::released);
  EXPECT_TRUE(bitwise_equal(rig.state.proxy, Vec3(0, 0, 0.79)));
  EXPECT_FALSE(rig.state.active());
  EXPECT_EQ(rig.tick({0, 0, 0.99}).status, LinkStatus::released);
  EXPECT_EQ(rig.tick({0, 0, 1.01}).status, LinkStatus::free);
  EXPECT_TRUE(rig.state.active());
  EXPECT_EQ(rig.tick({0, 0, 0.95}).status, LinkStatus::ok);
}

TEST_P(Sphere, TwoSidedReArmsNearOrAcrossTheLevel) {
  Rig rig(make(R"(, "release": 0.2)"));
  EXPECT_EQ(rig.tick({0, 0, 1.1}).status, LinkStatus::ok);
  EXPECT_EQ(rig.tick({0, 0, 1.21}).status, LinkStatus::released);
  EXPECT_EQ(rig.tick({0, 0, 1.03}).status, LinkStatus::released);
  EXPECT_EQ(rig.tick({0, 0, 1.018}).status, LinkStatus::ok);  // within a tenth of release
  EXPECT_EQ(rig.tick({0, 0, 1.3}).status, LinkStatus::released);
  EXPECT_EQ(rig.tick({0, 0, 0.9}).status, LinkStatus::ok);  // crosses the level in one tick
  EXPECT_NEAR(rig.state.proxy.z, 1, slack());
  EXPECT_EQ(rig.tick({0, 0, 0.7}).status, LinkStatus::released);
  EXPECT_EQ(rig.tick({0, 0, 0.97}).status, LinkStatus::released);
  EXPECT_EQ(rig.tick({0, 0, 0.985}).status, LinkStatus::ok);
  EXPECT_EQ(rig.tick({0, 0, 0.7}).status, LinkStatus::released);
  EXPECT_EQ(rig.tick({0, 0, 1.5}).status, LinkStatus::released);  // crosses beyond the release distance: stays released
}

TEST_P(Sphere, FirstProbeDeeperThanReleaseStartsReleased) {
  Rig deep(make(kAbove + R"(, "release": 0.2)"));
  EXPECT_EQ(deep.tick({0.1, 0, 0.7}).status, LinkStatus::released);
  EXPECT_TRUE(bitwise_equal(deep.state.proxy, Vec3(0.1, 0, 0.7)));
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
    if (i != 0 && std::fabs(norm(probe) - 1) > slack()) {
      ASSERT_EQ(sided.state.status, LinkStatus::free) << i;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(BothKinds, Sphere, testing::Bool(), [](const auto& test) { return test.param ? "Grid" : "Formula"; });

TEST(IsosurfaceSemantics, AFastHandDoesNotTunnelThroughAThinSheet) {
  // |z| on a fine grid: a sheet 0.02 thick, free above, crossed by steps of 0.05
  const auto grid =
      sample_scalar_grid(field::Mapping::from_linear(Mat3(0.0625), Vec3(-2.0)), {65, 65, 65}, [](const Vec3& p) { return std::fabs(p.z); });
  Rig rig(isosurface(grid, 0.01, kAbove));
  EXPECT_EQ(rig.tick({0.3, 0.2, 0.04}).status, LinkStatus::free);
  EXPECT_EQ(rig.tick({0.3, 0.2, -0.03}).status, LinkStatus::ok);
  EXPECT_NEAR(rig.state.proxy.z, 0.01, 1e-6);
  EXPECT_EQ(rig.tick({0.3, 0.25, -0.04}).status, LinkStatus::ok);  // slides along the sheet
  EXPECT_NEAR(rig.state.proxy.y, 0.25, 1e-6);
  EXPECT_EQ(rig.tick({0.3, 0.25, 0.03}).status, LinkStatus::free);
  // a jump is not a hand's motion: free by the field's value
  EXPECT_EQ(rig.tick({0.3, 0.2, -1.5}).status, LinkStatus::free);
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
  for (int k = 0; k < 3 && (k == 0 || rig.state.status == LinkStatus::budget); ++k) {
    rig.tick({0.1, 0.2, 0.3});
    EXPECT_TRUE(bitwise_equal(rig.state.proxy, Vec3(0.1, 0.2, 0.3)));
  }
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

TEST(IsosurfaceSemantics, TheProxyStopsAtTheDomainBoundary) {
  // z = 0.1 x on [-2, 2]^3: pulled out through x = 2 the proxy slides on the wall
  const auto grid =
      sample_scalar_grid(field::Mapping::from_linear(Mat3(0.25), Vec3(-2.0)), {17, 17, 17}, [](const Vec3& p) { return p.z - 0.1 * p.x; });
  Rig rig(isosurface(grid, 0));
  for (double x = 0; x < 3; x += 0.01) {
    rig.tick({x, 0.33, 0.5});
    ASSERT_TRUE(is_finite(rig.state.proxy));
    ASSERT_LE(rig.state.proxy.x, 2 + 1e-12);
  }
  EXPECT_EQ(rig.state.status, LinkStatus::boundary);
  EXPECT_NEAR(rig.state.proxy.x, 2, 1e-12);
  EXPECT_NEAR(rig.state.proxy.y, 0.33, 1e-6);
  EXPECT_NEAR(rig.state.proxy.z, 0.2, 1e-6);
  rig.tick({3, -0.7, 0.5});
  EXPECT_NEAR(rig.state.proxy.y, -0.7, 1e-6);
  EXPECT_EQ(rig.tick({1, 0, 0}).status, LinkStatus::ok);  // returns from the boundary
}

TEST(IsosurfaceSemantics, TheMaskIsAWall) {
  std::vector<std::uint8_t> valid;
  for (int z = 0; z < 17; ++z)
    for (int y = 0; y < 17; ++y)
      for (int x = 0; x < 17; ++x) valid.push_back(x <= 10);
  const auto grid = sample_scalar_grid(
      field::Mapping::from_linear(Mat3(0.25), Vec3(-2.0)), {17, 17, 17}, [](const Vec3& p) { return p.z - 0.1 * p.x; }, valid);
  Rig rig(isosurface(grid, 0));
  for (double x = -1; x < 1.5; x += 0.01) {
    rig.tick({x, 0.1, 0.3});
    ASSERT_LE(rig.state.proxy.x, 0.5 + 1e-12);
  }
  EXPECT_EQ(rig.state.status, LinkStatus::boundary);
  EXPECT_NEAR(rig.state.proxy.x, 0.5, 1e-9);
  // a start in the masked part finds the surface in the valid part
  Rig outside(isosurface(grid, 0));
  outside.tick({1.7, 0.1, 0.3});
  outside.tick({1.7, 0.1, 0.3});
  EXPECT_TRUE(is_finite(outside.state.proxy));
  if (outside.state.status != LinkStatus::no_surface) {
    EXPECT_LE(outside.state.proxy.x, 0.5 + 1e-9);
  }
}

TEST(IsosurfaceSemantics, InvalidVoxelsNeverReachTheOutput) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const auto grid = sample_scalar_grid(field::Mapping::from_linear(Mat3(0.25), Vec3(-2.0)), {17, 17, 17},
                                       [&](const Vec3& p) { return p.x > 0.4 && p.x < 0.9 ? nan : static_cast<float>(p.z - 0.1 * p.x); });
  for (const std::string& side : {std::string(), kAbove, kBelow}) {
    Rig rig(isosurface(grid, 0, side));
    int walls = 0;
    for (double x = -1; x < 2; x += 0.01) {
      for (const double z : {0.3, -0.3}) {
        rig.tick({x, 0.1, z});
        ASSERT_TRUE(is_finite(rig.state.proxy)) << x;
        ASSERT_TRUE(std::isfinite(rig.state.residual));
        const bool wall = rig.state.status == LinkStatus::boundary || rig.state.status == LinkStatus::critical;
        walls += wall;
        if (wall && x < 1.5) {
          EXPECT_EQ(rig.state.reason, SampleStatus::not_finite) << "there is no mask: " << x << " " << z << side;
        }
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
      other.tick(probe);
      ASSERT_LE(norm(one.state.proxy - other.state.proxy), 1e-7) << scale;
      ASSERT_EQ(other.state.status, LinkStatus::ok);
    }
  }
}

TEST(IsosurfaceSemantics, KeysAreChecked) {
  Fields fields;
  fields.named["s"].scalar = analytic_field("sphere");
  fields.named["g"].scalar = sampled_field("sphere", 9);
  fields.named["v"].vector = field::make_analytic("circle")->vector;
  const auto message = [&](const std::string& rest) {
    const auto made = try_build("{\"name\": \"a\", \"type\": \"isosurface\",\n" + rest + "}", fields);
    EXPECT_FALSE(made) << rest;
    return made ? std::string() : made.error().message;
  };
  EXPECT_TRUE(try_build(R"({"name": "a", "type": "isosurface", "field": "s", "level": 1})", fields));
  for (const char* rest : {R"("level": 1)", R"("field": "s")", R"("field": "none", "level": 1)", R"("field": "s", "level": -1)",
                           R"("field": "g", "level": 99)", R"("field": "s", "level": "1")", R"("field": "s", "level": 1, "free": "inside")",
                           R"("field": "s", "level": 1, "release": 0)", R"("field": "s", "level": 1, "release": -0.1)",
                           R"("field": "s", "level": 1e999)", R"("field": "s", "level": 1, "relase": 1)"}) {
    const std::string text = message(rest);
    EXPECT_EQ(text.rfind("scene.json:", 0), 0u) << text;
    EXPECT_EQ(text.find('\n'), std::string::npos) << text;
  }
  EXPECT_NE(message(R"("field": "v", "level": 1)").find("vector"), std::string::npos);
  const std::string level = message("\"field\": \"g\",\n\"level\": 99");
  EXPECT_EQ(level.rfind("scene.json:3:", 0), 0u) << level;
  EXPECT_NE(level.find("99"), std::string::npos);
}

}  // namespace isosurface_semantics_test
}  // namespace catena::haptics::tests
