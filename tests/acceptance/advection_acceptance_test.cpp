// SPDX-License-Identifier: MIT
// Acceptance tests of the advection function: drift, order, reversibility and grid errors, also as seen by the hand.
#include <random>

#include "engine/geometry/flow/curve.h"
#include "tests/acceptance/chain_fixture.h"
#include "tests/acceptance/reference_numerics.h"
#include "tests/engine/geometry/flow/advection_reference.h"
#include "tests/engine/geometry/flow/lambda_field.h"

namespace catena::acceptance::advection_acceptance_test {

using catena::test::analytic_vector;
using catena::test::lambda_field;
using flow::Method;

ChainRig circle_by(const std::string& method) {
  return ChainRig(make_program(R"({"fields": {"v": {"analytic": "circle"}}, "chain": [{"name": "c", "type": "streamline", "field": "v",
                               "seed": [0.05, 0, 0], "method": ")" +
                               method + R"("}]})"));
}

/// Drift in mm after one lap of the circle of R = 50 mm at 1 kHz.
double drift_of_a_lap(const std::string& method, double speed) {
  const double radius = 0.05, step = speed * 1e-3;
  ChainRig chain = circle_by(method);
  double worst = 0;
  const int ticks = static_cast<int>(std::ceil(2 * M_PI * radius / step));
  for (int i = 0; i <= ticks; ++i) {
    const double angle = std::min(step * i / radius, 2 * M_PI);
    chain.step_to({radius * std::cos(angle), radius * std::sin(angle), 0});
    EXPECT_EQ(chain.status(), LinkStatus::ok) << method << " tick " << i;
    worst = std::max(worst, std::fabs(norm(chain.proxy()) - radius));
  }
  return 1e3 * worst;
}

TEST(AdvectionDrift, CircleDriftPerLap) {
  const double euler = drift_of_a_lap("euler", 0.2), linear = drift_of_a_lap("linear", 0.2);
  record_results("0.2 m/s, mm a lap, ", {{"Euler", euler}, {"Eqs. 1-2 as printed", linear}});
  EXPECT_NEAR(euler, 0.63, 0.02);
  EXPECT_NEAR(linear, 0.63, 0.02);
  for (const auto& [method, bound] : {std::pair{"rk3", 2e-6}, {"rkf34", 5e-7}, {"dp54", 5e-7}})
    expect_at_most(std::string("0.2 m/s, mm a lap, ") + method, drift_of_a_lap(method, 0.2), bound);
}

TEST(AdvectionDrift, EulerDriftsByPiTimesTheStep) {
  for (const auto& [speed, drift] : {std::pair{0.05, 0.157}, std::pair{1.0, 3.24}}) {
    const double euler = drift_of_a_lap("euler", speed);
    record_result("Euler, " + std::to_string(speed) + " m/s, mm a lap", euler);
    EXPECT_NEAR(euler, drift, 0.03 * drift);
  }
}

// paper, figure 2: under a still hand with 1 mm of tremor Euler drifts away, the paper's method does not
TEST(AdvectionDrift, NoDriftUnderAMinuteOfTremor) {
  for (const char* method : {"euler", "rkf34"}) {
    ChainRig chain = circle_by(method);
    double worst = 0;
    for (int i = 0; i < 60000; ++i) {
      const double angle = 1e-3 / 0.05 * std::sin(2 * M_PI * 9 * 1e-3 * i);
      chain.step_to({0.05 * std::cos(angle), 0.05 * std::sin(angle), 0});
      worst = std::max(worst, 1e3 * std::fabs(norm(chain.proxy()) - 0.05));
    }
    record_result(std::string(method) + ", mm after a minute of tremor", worst);
    if (std::string(method) == "euler")
      EXPECT_GT(worst, 0.5);
    else
      EXPECT_LE(worst, 5e-6);
  }
}

TEST(IntegrationOrder, ObservedOrdersOnAbc) {
  const auto field = analytic_vector("abc");
  const flow::Flow flow{field.get()};
  const Vec3 start(0.3, -0.7, 0.4);
  const Vec3 exact = integrate_rk4(abc_flow, Real3(start), 1, 20000).rounded();
  const struct {
    Method method;
    int order, steps;
  } cases[] = {{Method::euler, 1, 4000}, {Method::rk2, 2, 400}, {Method::rk3, 3, 160},
               {Method::rkf34, 3, 160},  {Method::rk4, 4, 80},  {Method::dp54, 5, 40}};
  for (const auto& c : cases) {
    const auto error = [&](int steps) {
      Vec3 p = start;
      field::Cursor cursor;
      for (int i = 0; i < steps; ++i)
        p += flow::advect(flow, p, 1.0 / steps, c.method, std::numeric_limits<double>::infinity(), cursor).displacement;
      return norm(p - exact);
    };
    const double order = std::log2(error(c.steps) / error(2 * c.steps));
    record_result(std::string("observed order of ") + flow::to_string(c.method), order);
    EXPECT_NEAR(order, c.order, 0.1) << flow::to_string(c.method);
  }
}

TEST(AdvectionReversibility, ForwardAndBackwardOnAbc) {
  const auto field = lambda_field([](const Vec3& p) { return unit_direction(abc_flow(Real3(p))).rounded(); });
  const flow::Flow flow{field.get()};
  std::mt19937_64 random(3);
  std::uniform_real_distribution<double> place(-M_PI, M_PI);
  double rkf34 = 0, dp54 = 0;
  for (int i = 0; i < 500; ++i) {
    const Vec3 p(place(random), place(random), place(random));
    for (const auto& [method, worst] : {std::pair{Method::rkf34, &rkf34}, std::pair{Method::dp54, &dp54}}) {
      field::Cursor cursor;
      const Vec3 there = p + flow::advect(flow, p, 1, method, 1e-9, cursor).displacement;
      const Vec3 back = there + flow::advect(flow, there, -1, method, 1e-9, cursor).displacement;
      *worst = std::max(*worst, norm(back - p));
    }
  }
  expect_at_most("RKF3(4), tolerance 1e-9, worst of 500", rkf34, 1e-6);
  expect_at_most("DP5(4), tolerance 1e-9, worst of 500", dp54, 2e-8);
}

/// Hill's vortex with `nodes` per axis on [-1.2, 1.2]^3, followed over length 3.2 from (0.5, 0, 0). By the symmetry of the vortex the
/// line closes after 1.77, on the grid as in the formula: the second lap repeats the first.
void expect_grid_floor(int nodes, double floor) {
  const auto grid = field::sample_on_grid(*analytic_vector("hill"), nodes, -1.2, 1.2);
  const Vec3 seed(0.5, 0, 0);

  // the selected line
  flow::TraceOptions options;
  options.length = 3.2;
  const auto curve = flow::trace({grid.get()}, seed, options);
  ASSERT_TRUE(curve);
  ASSERT_TRUE((*curve)->is_closed() || (*curve)->knots().back().s >= 3.2 - 1e-9);
  double selected = 0;
  for (int i = 0; i <= 3200; ++i) selected = std::max(selected, hill_streamline_distance((*curve)->position(1e-3 * i), 0.5L));

  // a hand that leads the proxy along the line, integrated online
  ChainRig chain(make_program({streamline(grid, seed, R"(, "follow": "online")")}));
  double online = 0;
  for (int i = 0; i <= 1600; ++i) {
    chain.step_to((*curve)->position(2e-3 * i));
    ASSERT_EQ(chain.status(), LinkStatus::ok);
    online = std::max(online, hill_streamline_distance(chain.proxy(), 0.5L));
  }
  record_result("selected, cross-track error / 3.2, nodes " + std::to_string(nodes), selected / 3.2);
  record_result("on line, cross-track error / 3.2, nodes " + std::to_string(nodes), online / 3.2);
  EXPECT_NEAR(selected / 3.2, floor, 0.2 * floor);
  EXPECT_NEAR(online / 3.2, floor, 0.2 * floor);
}

TEST(GridDiscretizationError, GridFloorOfHillsVortex32) { expect_grid_floor(32, 1.2e-3); }
TEST(GridDiscretizationError, GridFloorOfHillsVortex64) { expect_grid_floor(64, 2.8e-4); }
TEST(GridDiscretizationError, GridFloorOfHillsVortex128) { expect_grid_floor(128, 7.1e-5); }
TEST(GridDiscretizationError, GridFloorOfHillsVortex256) { expect_grid_floor(256, 1.8e-5); }

}  // namespace catena::acceptance::advection_acceptance_test
