// SPDX-License-Identifier: MIT
#include <limits>

#include "tests/haptics/constraints/friction_fixture.h"

namespace catena::haptics::tests::modulated_friction_test {

/// Fields of the sphere |x| = 1 with v = scale (cos(angle) n + sin(angle) tangent).
Fields at_angle(double angle, double scale = 1, double slope = 1) {
  Fields fields = scalars({{"s", analytic_field("sphere", slope)}});
  fields.named["v"].vector = lambda_field([angle, scale](const Vec3& p) {
    const Vec3 n = direction(p), t = direction(cross(n, Vec3(0.3, -0.2, 1)));
    return (n * std::cos(angle) + t * std::sin(angle)) * scale;
  });
  return fields;
}

std::string modulated(double tau_min, double tau_max, const std::string& more = "") {
  return R"({"name": "a", "type": "modulated_friction", "field": "v", "surface": "s", "tau_min": )" + to_json(tau_min) +
         R"(, "tau_max": )" + to_json(tau_max) + more + "}";
}

TEST(ModulatedFriction, TheThresholdFollowsTheAngle) {
  for (const double angle : {0.0, 0.3, 0.8, 1.5707963267948966, 2.0, 3.1, 3.141592653589793}) {
    const double u = std::cos(angle);
    for (const bool printed : {false, true}) {
      const double expected = printed ? u * 0.01 + (1 - u) * 0.1 : (1 - std::fabs(u)) * 0.01 + std::fabs(u) * 0.1;
      for (const char* level : {"", R"(, "level": 1)"}) {
        Rig rig(build(modulated(0.01, 0.1, std::string(level) + (printed ? R"(, "law": "as_published")" : "")), at_angle(angle)));
        const Vec3 a = direction(Vec3(1, 0.4, 0.2)), b = direction(Vec3(1, 0.4, 0.5));
        EXPECT_NEAR(rig.tick(a).limit, expected, 1e-12) << angle << level << printed;
        EXPECT_NEAR(rig.tick(b).limit, expected, 1e-12);
        EXPECT_NEAR(norm(b - rig.state.proxy), std::min(expected, norm(b - a)), 1e-12);
        EXPECT_TRUE(*level == 0 || std::fabs(norm(rig.state.proxy) - 1) <= 1e-11);
      }
    }
  }
}

// by the paper's text a field along the normal has the maximum threshold; by Eq. 7 as printed the minimum
TEST(ModulatedFriction, AFieldAlongTheNormalGivesTheMaximumThreshold) {
  const auto limit = [](double angle, const std::string& law) {
    Rig rig(build(modulated(0.01, 0.1, law), at_angle(angle)));
    return rig.tick({0, 0, 1}).limit;
  };
  for (const double angle : {0.0, 3.141592653589793}) EXPECT_NEAR(limit(angle, ""), 0.1, 1e-12) << angle;
  EXPECT_NEAR(limit(0, R"(, "law": "as_published")"), 0.01, 1e-12);
}

// the angle is evaluated before the proxy moves, so that the slide uses the threshold of the old position
TEST(ModulatedFriction, UsesTheThresholdAtTheProxyBeforeItMoves) {
  Fields fields = scalars({{"s", analytic_field("plane")}});
  fields.named["v"].vector = lambda_field([](const Vec3& p) { return Vec3(p.x < 0.5 ? 1 : 0, 0, p.x < 0.5 ? 0 : 1); });
  Rig rig(build(modulated(0.01, 0.1, R"(, "level": 0)"), fields));
  rig.tick({0.4, 0, 0});
  EXPECT_NEAR(rig.tick({0.7, 0, 0}).limit, 0.01, 1e-12);
  EXPECT_NEAR(rig.state.proxy.x, 0.69, 1e-12);
  EXPECT_NEAR(rig.tick({0.75, 0, 0}).limit, 0.1, 1e-12);
  EXPECT_NEAR(rig.state.proxy.x, 0.69, 1e-12);
}

// the threshold is equal for scales 1e-300..1e300 of both fields; zero, NaN and infinity give u = 0
TEST(ModulatedFriction, NormalizesSafelyAtAnyScale) {
  for (const double scale : {1e-300, 1e-160, 1.0, 1e160, 1e300})
    for (const double slope : {1e-300, 1.0, 1e300}) {
      Rig rig(build(modulated(0.01, 0.1), at_angle(0.5, scale, slope)));
      rig.tick({0, 0.6, 0.8});
      const double u = std::cos(0.5);
      EXPECT_NEAR(rig.state.limit, (1 - u) * 0.01 + u * 0.1, 1e-12) << scale << " " << slope;
    }
  for (const double bad : {0.0, std::nan(""), std::numeric_limits<double>::infinity()}) {
    Fields fields = scalars({{"s", analytic_field("sphere")}});
    fields.named["v"].vector = lambda_field([bad](const Vec3&) { return Vec3(bad); }, [bad](const Vec3&) { return std::isfinite(bad); });
    Rig safe(build(modulated(0.01, 0.1), fields)), printed(build(modulated(0.01, 0.1, R"(, "law": "as_published")"), fields));
    for (Rig* rig : {&safe, &printed}) {
      rig->tick({0, 0.6, 0.8});
      EXPECT_TRUE(is_finite(rig->tick({0.6, 0, 0.8}).proxy));
    }
    EXPECT_EQ(safe.state.limit, 0.01);
    EXPECT_EQ(printed.state.limit, 0.1);
  }
}

// Eq. 7 leaves the range for u < 0; the threshold must be finite and not negative
TEST(ModulatedFriction, ThePublishedLawIsNeverNegative) {
  Rig below(build(modulated(0.5, 0.1, R"(, "law": "as_published")"), at_angle(3.141592653589793)));
  EXPECT_EQ(below.tick({0, 0, 1}).limit, 0);
  EXPECT_LE(norm(below.tick({0, 0.6, 0.8}).proxy - Vec3(0, 0.6, 0.8)), 1e-15);
}

TEST(ModulatedFriction, LineFieldsAreSignInvariant) {
  for (const double angle : {0.4, 2.741592653589793}) {
    Rig rig(build(modulated(0.01, 0.1, R"(, "kind": "line", "law": "as_published")"), at_angle(angle)));
    EXPECT_NEAR(rig.tick({0, 0, 1}).limit, std::cos(0.4) * 0.01 + (1 - std::cos(0.4)) * 0.1, 1e-12);
  }
}

TEST(ModulatedFriction, SamplesTheFieldOnlyWhenTheProxyMoves) {
  Rig rig(build(modulated(0.05, 0.1, R"(, "level": 1)"), at_angle(0.7)));
  rig.tick({0, 0, 1});
  EXPECT_EQ(rig.tick({0, 0.01, std::sqrt(1 - 1e-4)}).evaluations, 1);  // one evaluation for the check that the probe is on the surface
  EXPECT_EQ(rig.tick({0, 0.01, std::sqrt(1 - 1e-4)}).evaluations, 0);
}

TEST(ModulatedFriction, RefusesBadKeys) {
  const std::pair<std::string, const char*> bad[] = {
      {R"({"name": "a", "type": "modulated_friction", "field": "v"})", "surface"},
      {R"({"name": "a", "type": "modulated_friction", "surface": "s"})", "field"},
      {R"({"name": "a", "type": "modulated_friction", "surface": "s", "field": "s"})", "scalar field"},
      {R"({"name": "a", "type": "modulated_friction", "surface": "v", "field": "v"})", "vector field"},
      {modulated(-1, 1), "tau_min"},
      {modulated(0, 1, R"(, "law": "paper")"), "law"},
      {modulated(0, 1, R"(, "level": -1)"), "not attained"}};
  for (const auto& [text, what] : bad) expect_refused(text, 1, {what}, at_angle(0));
}

}  // namespace catena::haptics::tests::modulated_friction_test
