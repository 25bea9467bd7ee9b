// SPDX-License-Identifier: MIT
#include "tests/haptics/constraints/constraint_fixture.h"

namespace catena::haptics::tests::viscosity_test {

Rig viscous(const std::string& keys, double dt, double stiffness = 0, const Fields& fields = {}) {
  Rig rig(build(R"({"name": "a", "type": "viscosity", )" + keys + "}", fields));
  rig.state.dt_s = dt;
  rig.state.stiffness_n_per_m = stiffness;
  return rig;
}

TEST(Viscosity, SteadyMotionLagsByVelocityTimesTime) {
  for (const double dt : {1e-3, 1e-4, 0.02})
    for (const double time : {0.0, 1e-3, 0.05, 0.4}) {
      Rig rig = viscous("\"time\": " + std::to_string(time), dt);
      const Vec3 v(0.3, -0.1, 0.2);
      const int ticks = static_cast<int>(50 * (time + dt) / dt);
      for (int i = 0; i <= ticks; ++i) rig.tick(v * (dt * i));
      EXPECT_LE(norm(v * (dt * ticks) - rig.state.proxy - v * time), 1e-12) << dt << " " << time;
      EXPECT_EQ(rig.state.status, LinkStatus::ok);
      EXPECT_EQ(rig.state.evaluations, 0);
    }
}

TEST(Viscosity, ACoefficientIsTheDampingOverTheStiffness) {
  // b = 6 N s/m at k = 200 N/m: T = 0.03 s; force k (x - p) = b v
  Rig rig = viscous("\"coefficient\": 6", 1e-3, 200);
  for (int i = 0; i <= 3000; ++i) rig.tick({0.5e-3 * i, 0, 0});
  EXPECT_NEAR(200 * (1.5 - rig.state.proxy.x), 6 * 0.5, 1e-10);
  Rig limp = viscous("\"coefficient\": 6", 1e-3, 0);
  limp.tick({0, 0, 0});
  EXPECT_TRUE(bitwise_equal(limp.tick({1, 0, 0}).proxy, Vec3(1, 0, 0)));
}

TEST(Viscosity, ConvergesToTheProbeExactly) {
  for (const double dt : {1e-3, 1.0, 1e6}) {
    Rig rig = viscous("\"time\": 0.01", dt);
    rig.tick({0, 0, 0});
    const Vec3 probe(0.3, 1.7, -1e-9);
    double last = norm(probe);
    int ticks = 0;
    for (; ticks < 2000 && !bitwise_equal(rig.state.proxy, probe); ++ticks) {
      ASSERT_LE(norm(probe - rig.tick(probe).proxy), last);  // never overshoots
      last = norm(probe - rig.state.proxy);
    }
    EXPECT_LT(ticks, 2000) << dt;
    for (int i = 0; i < 10; ++i) {
      EXPECT_TRUE(bitwise_equal(rig.tick(probe).proxy, probe));
    }
  }
}

TEST(Viscosity, AZeroTimeStepHoldsTheProxyAndExtremesStayFinite) {
  Rig rig = viscous("\"time\": 0.01", 0);
  rig.tick({0, 0, 0});
  EXPECT_TRUE(bitwise_equal(rig.tick({1, 2, 3}).proxy, Vec3(0.0)));
  for (const double dt : {1e-300, 1e-3, 1e300, std::numeric_limits<double>::infinity(), -1.0})
    for (const char* time : {"1e-300", "1", "1e300"}) {
      Rig far = viscous(std::string("\"time\": ") + time, dt);
      for (const double x : {1.7e308, -1.7e308, 0.0, 1e-320, -1.7e308, 1.0}) {
        ASSERT_TRUE(is_finite(far.tick({x, -x, 1}).proxy)) << dt << " " << time << " " << x;
      }
    }
}

TEST(Viscosity, TheTimeMayFollowAField) {
  Rig rig = viscous(R"("time": {"field": "f", "map": [[0, 0.01], [1, 0.03]]})", 1e-3, 0, scalars({{"f", analytic_field("plane")}}));
  const double v = 0.2;
  for (int i = 0; i <= 4000; ++i) rig.tick({v * 1e-3 * i, 0, 0.5});
  EXPECT_NEAR(v * 4 - rig.state.proxy.x, v * 0.02, 1e-12);
  EXPECT_EQ(rig.state.evaluations, 1);
}

TEST(Viscosity, RefusesBadKeys) {
  const std::string head = "{\"name\": \"a\",\n\"type\": \"viscosity\"";
  expect_refused(head + "}", 1, {"neither"});
  expect_refused(head + ", \"time\": 1, \"coefficient\": 1}", 1, {"both"});
  expect_refused(head + ", \"time\": -1}", 2, {">= 0"});
  expect_refused(head + ", \"coefficient\": \"x\"}", 2, {"coefficient"});
}

}  // namespace catena::haptics::tests::viscosity_test
