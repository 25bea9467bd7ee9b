// SPDX-License-Identifier: MIT
/// Tuning of the haptic tick: settings of links, interpolation of fields, and the edits of the scene's text.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "tests/engine/app/tuning_fixtures.h"
#include "tests/support/results.h"

namespace tuning_test {

TEST(TickTuning, TakesTheCheapestSettingForEachLink) {
  const TickTuning plan(two_link_curves(), parse_target("max_proxy_error=1e-3"));
  ASSERT_EQ(plan.links().size(), 2u);
  EXPECT_EQ(plan.links()[0].setting, "rk2");
  EXPECT_EQ(plan.links()[1].setting, "euler");
  EXPECT_DOUBLE_EQ(plan.expected_error(), 1e-3);
  EXPECT_DOUBLE_EQ(plan.expected_us(), 1e-3 * (400 + 400 + 200));
  EXPECT_FALSE(TickTuning(two_link_curves(), parse_target("max_proxy_error=1e-12")).meets_target());
}

TEST(TickTuning, SpendsTheTimeOnTheWorstLink) {
  const TickTuning plan(two_link_curves(), parse_target("max_tick_us=1.31"));
  EXPECT_EQ(plan.links()[0].setting, "rk2");
  EXPECT_EQ(plan.links()[1].setting, "rk2");
  const TickTuning poor(two_link_curves(), parse_target("max_tick_us=0.01"));
  EXPECT_FALSE(poor.meets_target());
  EXPECT_EQ(poor.links()[0].setting, "euler");
  const std::vector<double> stops = plan.error_breakpoints();
  EXPECT_TRUE(std::is_sorted(stops.rbegin(), stops.rend()));
  EXPECT_EQ(stops.size(), 5u);
}

TEST(TickTuning, ReportsErrorsFarAlongALine) {
  TickCurves curves = two_link_curves();
  for (LinkCurve& one : curves.links)
    for (Point& p : one.curve.points) p.extra_values = {0, 0, NAN};
  curves.links[0].curve.points[1].extra_values[2] = 0.5;  // with length 2 the error is 1 somewhere, where 2e-4 is expected
  const TickTuning near(curves, parse_target("max_proxy_error=1e-3"));
  EXPECT_EQ(near.links()[0].setting, "rk2");
  EXPECT_NEAR(near.expected_error(), 1e-3, 1e-12);  // the error of link b
  EXPECT_EQ(near.error_anywhere(), 1);
  EXPECT_NE(near.summary().find(
                "(link a: the error grows along the line, up to 1 far from the seed, so that max_proxy_error holds near the seed"),
            std::string::npos)
      << near.summary();
  curves.links[0].curve.points[1].extra_values[2] = 2e-4;  // nearly equal everywhere
  const TickTuning alike(curves, parse_target("max_proxy_error=1e-3"));
  EXPECT_EQ(alike.error_anywhere(), alike.expected_error());
  EXPECT_EQ(alike.summary().find("far from the seed"), std::string::npos) << alike.summary();
}

TEST(TickTuning, IsWrittenIntoTheTextExceptStatedSettings) {
  const TickTuning plan(two_link_curves(), parse_target("max_proxy_error=1e-3"));
  const auto text = test::value_of(plan.apply(R"({"chain": [{"name": "b", "method": "dp54"}, {"name": "c"}, {"name": "a"}]})", "s.json"));
  EXPECT_EQ(text, R"({"chain": [{"name": "b", "method": "dp54"}, {"name": "c"}, {"name": "a", "method": "rk2"}]})");
}

/// Two links on one field, measured with linear and with cubic cells, and a link on a field with stated interpolation.
TickCurves with_cells() {
  TickCurves curves = two_link_curves();
  for (LinkCurve& linear : curves.links) linear.field = "flow", linear.curve.discretization_error = 1e-4;
  for (std::size_t i = 0; i < 2; ++i) {
    LinkCurve cubic = curves.links[i];
    cubic.is_cubic = true;
    cubic.curve.discretization_error = 1e-6;
    for (Point& p : cubic.curve.points) p.time.median *= 3;
    curves.links.push_back(cubic);
  }
  LinkCurve other = curves.links[0];
  other.link = "c", other.field = "stated";
  curves.links.push_back(other);
  return curves;
}

TEST(TickTuning, CellsAreCubicOnlyBelowTheErrorOfLinearCells) {
  EXPECT_TRUE(TickTuning(with_cells(), parse_target("max_proxy_error=1e-3")).cubic_fields().empty());
  const TickTuning fine(with_cells(), parse_target("max_proxy_error=1e-5"));
  EXPECT_EQ(fine.cubic_fields(), std::vector<std::string>{"flow"});
  ASSERT_EQ(fine.links().size(), 3u);
  EXPECT_FALSE(fine.links()[0].at_floor);  // 1e-6 times the length is below the target
  EXPECT_TRUE(fine.links()[2].at_floor);   // the field with stated interpolation keeps it
  EXPECT_NE(fine.summary().find("field flow cubic"), std::string::npos) << fine.summary();
  // Noise: cubic cells have no smaller error.
  TickCurves noisy = with_cells();
  for (LinkCurve& link : noisy.links)
    if (link.is_cubic) link.curve.discretization_error = 0.8e-4;
  EXPECT_TRUE(TickTuning(noisy, parse_target("max_proxy_error=1e-5")).cubic_fields().empty());
  // A time limit that linear cells meet and cubic cells do not.
  EXPECT_TRUE(TickTuning(with_cells(), parse_target("max_tick_us=2.0")).cubic_fields().empty());
  EXPECT_FALSE(TickTuning(with_cells(), parse_target("max_tick_us=20")).cubic_fields().empty());
}

TEST(TickTuning, InterpolationIsWrittenIntoTheTextUnlessStated) {
  const TickTuning plan(with_cells(), parse_target("max_proxy_error=1e-5"));
  const auto open = test::value_of(plan.apply(R"({"fields": {"flow": {"file": "a.vdb"}}})", "s.json"));
  EXPECT_EQ(open, R"({"fields": {"flow": {"file": "a.vdb", "interpolation": "cubic"}}})");
  const std::string stated = R"({"fields": {"flow": {"file": "a.vdb", "interpolation": "linear"}}})";
  EXPECT_EQ(*plan.apply(stated, "s.json"), stated);
}

}  // namespace tuning_test
