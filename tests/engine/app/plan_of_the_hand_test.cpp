/// Plans of the hand: links, cells and their texts.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "tests/engine/app/plans.h"

namespace plan_test {

TEST(PlanOfTheHand, TakesForEachLinkTheCheapest) {
  const HandPlan plan(two_links(), wants("hand_error=1e-3"));
  ASSERT_EQ(plan.links().size(), 2u);
  EXPECT_EQ(plan.links()[0].setting, "rk2");
  EXPECT_EQ(plan.links()[1].setting, "euler");
  EXPECT_DOUBLE_EQ(plan.expected_error(), 1e-3);
  EXPECT_DOUBLE_EQ(plan.expected_us(), 1e-3 * (400 + 400 + 200));
  EXPECT_FALSE(HandPlan(two_links(), wants("hand_error=1e-12")).reached());
}

TEST(PlanOfTheHand, SpendsTheTimeOnTheWorstLink) {
  const HandPlan plan(two_links(), wants("hand_time=1.31"));
  EXPECT_EQ(plan.links()[0].setting, "rk2");
  EXPECT_EQ(plan.links()[1].setting, "rk2");
  const HandPlan poor(two_links(), wants("hand_time=0.01"));
  EXPECT_FALSE(poor.reached());
  EXPECT_EQ(poor.links()[0].setting, "euler");
  const std::vector<double> stops = plan.stops();
  EXPECT_TRUE(std::is_sorted(stops.rbegin(), stops.rend()));
  EXPECT_EQ(stops.size(), 5u);
}

TEST(PlanOfTheHand, SaysWhereALineIsFarOff) {
  HandCurves curves = two_links();
  for (LinkCurve& one : curves.links)
    for (Point& p : one.curve.points) p.more = {0, 0, NAN};
  curves.links[0].curve.points[1].more[2] = 0.5;  // L is 2: 1 somewhere, where 2e-4 is expected
  const HandPlan near(curves, wants("hand_error=1e-3"));
  EXPECT_EQ(near.links()[0].setting, "rk2");
  EXPECT_NEAR(near.expected_error(), 1e-3, 1e-12);  // of b
  EXPECT_EQ(near.error_anywhere(), 1);
  EXPECT_NE(
      near.sentence().find("(far along the line of a, small errors have grown: there up to 1, so that hand_error is kept near its seed"),
      std::string::npos)
      << near.sentence();
  curves.links[0].curve.points[1].more[2] = 2e-4;  // much the same everywhere
  const HandPlan alike(curves, wants("hand_error=1e-3"));
  EXPECT_EQ(alike.error_anywhere(), alike.expected_error());
  EXPECT_EQ(alike.sentence().find("far along"), std::string::npos) << alike.sentence();
}

TEST(PlanOfTheHand, GoesIntoTheTextAndLeavesWhatIsStated) {
  const HandPlan plan(two_links(), wants("hand_error=1e-3"));
  const auto text = plan.apply(R"({"chain": [{"name": "b", "method": "dp54"}, {"name": "c"}, {"name": "a"}]})", "s.json");
  ASSERT_TRUE(text) << text.error().message;
  EXPECT_EQ(*text, R"({"chain": [{"name": "b", "method": "dp54"}, {"name": "c"}, {"name": "a", "method": "rk2"}]})");
}

/// Two links on one field, with linear cells and with cubic ones, and one on another field that states its cells.
HandCurves with_cells() {
  HandCurves curves = two_links();
  for (LinkCurve& linear : curves.links) linear.field = "flow", linear.curve.floor = 1e-4;
  for (std::size_t i = 0; i < 2; ++i) {
    LinkCurve cubic = curves.links[i];
    cubic.cubic = true;
    cubic.curve.floor = 1e-6;
    for (Point& p : cubic.curve.points) p.time.median *= 3;
    curves.links.push_back(cubic);
  }
  LinkCurve other = curves.links[0];
  other.link = "c", other.field = "stated";
  curves.links.push_back(other);
  return curves;
}

TEST(PlanOfTheHand, CellsAreCubicOnlyBelowWhatLinearOnesHold) {
  EXPECT_TRUE(HandPlan(with_cells(), wants("hand_error=1e-3")).cubic_fields().empty());
  const HandPlan fine(with_cells(), wants("hand_error=1e-5"));
  EXPECT_EQ(fine.cubic_fields(), std::vector<std::string>{"flow"});
  ASSERT_EQ(fine.links().size(), 3u);
  EXPECT_FALSE(fine.links()[0].floored);  // 1e-6 L is below it
  EXPECT_TRUE(fine.links()[2].floored);   // the stated field's cells stay
  EXPECT_NE(fine.sentence().find("field flow cubic"), std::string::npos) << fine.sentence();
  // where cubic cells are no better: noise
  HandCurves noisy = with_cells();
  for (LinkCurve& link : noisy.links)
    if (link.cubic) link.curve.floor = 0.8e-4;
  EXPECT_TRUE(HandPlan(noisy, wants("hand_error=1e-5")).cubic_fields().empty());
  // a time that linear cells keep and cubic ones do not
  EXPECT_TRUE(HandPlan(with_cells(), wants("hand_time=2.0")).cubic_fields().empty());
  EXPECT_FALSE(HandPlan(with_cells(), wants("hand_time=20")).cubic_fields().empty());
}

TEST(PlanOfTheHand, CellsGoIntoTheTextUnlessTheyAreStated) {
  const HandPlan plan(with_cells(), wants("hand_error=1e-5"));
  const auto open = plan.apply(R"({"fields": {"flow": {"file": "a.vdb"}}})", "s.json");
  ASSERT_TRUE(open) << open.error().message;
  EXPECT_EQ(*open, R"({"fields": {"flow": {"file": "a.vdb", "interpolation": "cubic"}}})");
  const std::string stated = R"({"fields": {"flow": {"file": "a.vdb", "interpolation": "linear"}}})";
  EXPECT_EQ(*plan.apply(stated, "s.json"), stated);
}

}  // namespace plan_test
