// SPDX-License-Identifier: MIT
// Seed, rake, box, isolevel and ruler on scripted paths, against closed forms.
#include "tests/haptics/chain/plane_links.h"
#include "tests/haptics/chain/widget_probe.h"

namespace catena::haptics::widget_handles_test {

using test::distance_between;
using test::make_widget_program;
using test::make_widget_spec;
using test::WidgetProbe;
using widget::Kind;
using widget::Spec;

constexpr double kStep = 0.08;

/// Hovers over a handle and grabs it.
void take(WidgetProbe& hand, const Vec3& at, int handle) {
  hand.step(at);
  ASSERT_EQ(hand.mode_name(), "hover");
  hand.step(at, 1);
  ASSERT_EQ(hand.mode_name(), "drag");
  ASSERT_EQ(hand.report().handle, handle);
}
WidgetProbe dragged_plane() {
  WidgetProbe hand({make_widget_spec(Kind::cutting_plane)});
  hand.grab({1, 0, 0.01});
  hand.step({1.3, 0, 0.01}, 1);
  return hand;
}

TEST(WidgetHandles, AHandleAttractsTheProbeAndIsDraggedOnThePlanes) {
  const Vec3 at(0.3, -0.2, 0.1);
  WidgetProbe hand({make_widget_spec(Kind::seed, at)});
  const Vec3 grab = at + Vec3(0.05, 0.03, 0);
  hand.expect({1, 0, 0}, 0, "away", "");
  EXPECT_EQ(hand.report().handle, -1);
  hand.expect(grab, 0, "hover", "widget_sphere");
  EXPECT_EQ(hand.report().handle, 0);
  EXPECT_EQ(hand.link(3).proxy, at);
  EXPECT_LE(distance_between(hand.out.force_n, Vec3(0.05, 0.03, 0) * -500.0), 1e-12);
  hand.expect(grab, 1, "drag", "widget_x widget_y widget_z");
  EXPECT_EQ(hand.widget_position(), at);
  for (int k = 1; k <= 100; ++k) {
    const double u = 0.01 * k;
    ASSERT_EQ(hand.step(grab + Vec3(-u, 0.9 * kStep, -0.9 * kStep), 1).pose.points[0].y, at.y);
    ASSERT_EQ(hand.widget_position().z, at.z);
    ASSERT_NEAR(hand.widget_position().x, at.x - (u > kStep ? u - kStep : 0), 1e-15);
  }
  hand.step(grab + Vec3(0.4, 0.5, -0.6), 1);
  EXPECT_LE(distance_between(hand.widget_position(), at + Vec3(0.4 - kStep, 0.5 - kStep, -0.6 + kStep)), 1e-15);
  const Vec3 left = hand.widget_position();
  EXPECT_EQ(hand.step(grab + Vec3(0.4, 0.5, -0.6), 0).pose.points[0], left);
}

TEST(WidgetHandles, ARakeIsDraggedByItsEndsAndItsMiddle) {
  const Vec3 from(0, 0, 0), to(1, 0, 0.5), move(0.3, 0.01, -0.4), moved(0.3 - kStep, 0, -0.4 + kStep);
  for (int handle = 0; handle < 3; ++handle) {
    WidgetProbe hand({make_widget_spec(Kind::rake, from, to)});
    const Vec3 at = handle == 0 ? from : handle == 1 ? to : (from + to) * 0.5;
    take(hand, at, handle);
    hand.move_to(at + move, 1);
    const auto& points = hand.report().pose.points;
    EXPECT_LE(distance_between(points[0], handle == 1 ? from : from + moved), 1e-15);
    EXPECT_LE(distance_between(points[1], handle == 0 ? to : to + moved), 1e-15);
    EXPECT_EQ(points[0].y, 0);
    EXPECT_EQ(points[1].y, 0);
    hand.step(at + move, 0);
    EXPECT_EQ(hand.step({3, 3, 3}, 0).handle, -1);
  }
}

TEST(WidgetHandles, EveryFaceOfABoxMovesAlongItsNormalAndStopsBeforeTheOppositeFace) {
  const Vec3 lo(-0.5, -0.4, -0.3), hi(0.5, 0.4, 0.7);
  for (int face = 0; face < 6; ++face) {
    const int axis = face / 2;
    const double out = face % 2 == 0 ? -1 : 1;
    WidgetProbe hand({make_widget_spec(Kind::box, lo, hi)});
    Vec3 at = (lo + hi) * 0.5;
    at[axis] = face % 2 == 0 ? lo[axis] : hi[axis];
    take(hand, at, face);
    EXPECT_EQ(hand.report().active_planes, 7 & ~(1 << axis));
    const auto drag = [&](double by) {
      Vec3 probe = at + Vec3(0.3, -0.2, 0.25);  // off the axis: the planes hold at any distance
      probe[axis] = at[axis] + by;
      const auto& points = hand.step(probe, 1).pose.points;
      for (int a = 0; a < 3; ++a) EXPECT_TRUE(a == axis || (points[0][a] == lo[a] && points[1][a] == hi[a]));
      const int side = face % 2;
      EXPECT_EQ(points[static_cast<std::size_t>(1 - side)][axis], side == 0 ? hi[axis] : lo[axis]);
      return points[static_cast<std::size_t>(side)][axis];
    };
    EXPECT_NEAR(drag(0.37 * out), at[axis] + 0.37 * out, 1e-15);
    EXPECT_NEAR(drag(-0.2 * out), at[axis] - 0.2 * out, 1e-15);
    const double stop = face % 2 == 0 ? hi[axis] - kStep : lo[axis] + kStep;
    EXPECT_EQ(drag(-5 * out), stop);
    EXPECT_NEAR(drag(0.1 * out), at[axis] + 0.1 * out, 1e-15) << "it follows again from where the hand is";
  }
}

TEST(WidgetHandles, TheCentreOfABoxMovesTheWholeBox) {
  const Vec3 lo(-0.5, -0.4, -0.3), hi(0.5, 0.4, 0.7);
  WidgetProbe hand({make_widget_spec(Kind::box, lo, hi)});
  take(hand, (lo + hi) * 0.5, 6);
  hand.move_to((lo + hi) * 0.5 + Vec3(0, 0.5, 0), 1);
  EXPECT_LE(distance_between(hand.report().pose.points[0], lo + Vec3(0, 0.5 - kStep, 0)), 1e-15);
  EXPECT_LE(distance_between(hand.report().pose.points[1], hi + Vec3(0, 0.5 - kStep, 0)), 1e-15);
}

TEST(WidgetHandles, AThinBoxIsNotMadeThicker) {
  WidgetProbe hand({make_widget_spec(Kind::box, {0, -1, -1}, {0.01, 1, 1})});
  take(hand, {0.11, 0, 0}, 1);
  EXPECT_EQ(hand.report().pose.points[1].x, 0.01);
  EXPECT_EQ(hand.step({-1, 0, 0}, 1).pose.points[1].x, 0.01);
}

/// s = a . x + b |x|^2 / 2, within |x_i| <= 2.
class Bowl final : public field::ScalarField {
 public:
  Bowl(const Vec3& a, double b) : a_(a), b_(b) {}
  field::ScalarSample sample(const Vec3& x, field::Cursor&) const noexcept override {
    return {dot(a_, x) + 0.5 * b_ * dot(x, x), a_ + x * b_, max_abs(x) <= 2};
  }
  double min_value() const noexcept override { return -100; }
  double max_value() const noexcept override { return 100; }

 private:
  Vec3 a_;
  double b_;
};

TEST(WidgetHandles, AnIsolevelMovesAlongTheGradientAndReportsTheValue) {
  const Vec3 at(0.3, -0.2, 0.1), a(1, 2, -0.5);
  Spec spec = make_widget_spec(Kind::isolevel, at);
  spec.field = std::make_shared<Bowl>(a, 0.7);
  const auto value = [&](const Vec3& x) { return dot(a, x) + 0.35 * dot(x, x); };
  WidgetProbe hand({spec});
  EXPECT_EQ(hand.step({1, 1, 1}).value, value(at));
  take(hand, at + Vec3(0.02, 0.01, 0), 0);
  EXPECT_EQ(hand.report().active_planes, 3);
  EXPECT_EQ(hand.link_order(), "widget_x widget_y");
  EXPECT_EQ(hand.widget_position(), at);
  const Vec3 n = direction(a + at * 0.7), aside = direction(cross(n, {0, 0, 1}));
  for (int k = -50; k <= 50; ++k) {
    const double u = 0.01 * k;
    ASSERT_LE(distance_between(hand.step(at + Vec3(0.02, 0.01, 0) + n * u + aside * (0.3 * u), 1).pose.points[0], at + n * u), 1e-14) << k;
    ASSERT_EQ(hand.report().value, value(hand.widget_position()));
  }
  // outside the field the last value is kept
  const double last = hand.report().value;
  EXPECT_EQ(hand.step(at + n * 30.0, 1).value, last);
}

TEST(WidgetHandles, AnIsolevelWithoutAGradientMovesLikeASeed) {
  Spec spec = make_widget_spec(Kind::isolevel, {0.3, -0.2, 0.1});
  spec.field = std::make_shared<Bowl>(Vec3(0.0), 0);
  WidgetProbe hand({spec});
  take(hand, {0.3, -0.2, 0.1}, 0);
  EXPECT_EQ(hand.report().active_planes, 7);
  EXPECT_LE(distance_between(hand.step({0.3, 0.3, 0.1}, 1).pose.points[0], {0.3, 0.3 - kStep, 0.1}), 1e-15);
}

TEST(WidgetHandles, ARulersEndFollowsTheProxyOfItsLinks) {
  Spec spec = make_widget_spec(Kind::ruler, {0, 0, 0}, {1, 0, 0});
  spec.along_links = {1, 0};
  WidgetProbe hand(make_widget_program({spec}, {test::hold_plane("a", {1, 0.2, 0}, 0.9), test::hold_plane("b", {0.3, 1, 0.1}, -0.2)}));
  take(hand, {1, 0, 0}, 1);
  EXPECT_EQ(hand.link_order(), "b a");
  for (int k = 0; k < 20; ++k) {
    hand.step({1, 0.1 * k, 0.05 * k}, 1);
    ASSERT_EQ(hand.report().pose.points[1], hand.link(0).proxy);
    ASSERT_EQ(hand.report().pose.points[0], Vec3(0.0));
  }
  // a link that is switched off is skipped
  hand.program.links[0].active_when.button = 5;
  hand.step({1, 0, 0}, 1);
  EXPECT_EQ(hand.link_order(), "b");
  EXPECT_EQ(hand.report().pose.points[1], hand.link(1).proxy);
  // the middle handle moves freely
  hand.step({9, 9, 9});
  const auto points = hand.report().pose.points;
  take(hand, (points[0] + points[1]) * 0.5, 2);
  EXPECT_EQ(hand.link_order(), "widget_x widget_y widget_z");
}

TEST(WidgetGrab, AGrabIsHeldWithoutAProbeAndContinuesWithoutAJump) {
  for (const TickCondition condition : {TickCondition::normal, TickCondition::no_device, TickCondition::watchdog}) {
    WidgetProbe hand = dragged_plane();
    const auto before = hand.report();
    const double lost = condition == TickCondition::normal ? NAN : 0;
    for (int k = 0; k < 5; ++k) {
      hand.at(hand.t + 1e-3, Vec3(lost), k % 2 ? 1u : 0u, kIdentityRotation, condition);
      ASSERT_EQ(hand.report().pose, before.pose);
      ASSERT_EQ(hand.mode_name(), "translate");
      ASSERT_EQ(hand.out.force_n, Vec3(0.0));
    }
    // the probe returns elsewhere with the button down: the drag continues relative to the new position
    hand.step({-2, 1, 3}, 1);
    EXPECT_EQ(hand.mode_name(), "translate");
    EXPECT_LE(distance_between(hand.widget_position(), before.pose.points[0]), 1e-15);
    hand.step(Vec3(-2, 1, 3) + Vec3(0.2, 0, 0), 1);
    EXPECT_LE(distance_between(hand.widget_position(), before.pose.points[0] + Vec3(0.2, 0, 0)), 1e-14);
  }
}

TEST(WidgetGrab, AGrabEndsIfTheProbeReturnsWithoutTheButton) {
  WidgetProbe hand = dragged_plane();
  const Vec3 before = hand.widget_position();
  hand.step({NAN, 0, 0}, 1);
  hand.step({-2, 1, 0}, 0);
  EXPECT_EQ(hand.mode_name(), "explore");
  EXPECT_EQ(hand.widget_position(), before);
  // a press while the probe was lost does not count
  hand.step({NAN, 0, 0}, 0);
  hand.step({-2, 1, 0}, 1);
  EXPECT_EQ(hand.mode_name(), "explore");
}

TEST(WidgetGrab, ATurnContinuesWithoutAJump) {
  for (const widget::RotationMode turning : {widget::RotationMode::free, widget::RotationMode::axis}) {
    Spec spec = make_widget_spec(Kind::cutting_plane);
    spec.rotation = turning;
    WidgetProbe hand({spec});
    hand.grab({0.4, 0.26, 0});
    hand.step({0.3, 0.4, 0}, 1);
    const Quat before = hand.report().pose.orientation;
    const auto angle = [&] { return norm(rotation_vector(normalized(hand.report().pose.orientation * glm::conjugate(before)))); };
    EXPECT_GT(distance_between(rotate(before, {1, 0, 0}), {1, 0, 0}), 0.1);
    hand.step({NAN, 0, 0}, 1);
    hand.step({-0.4, 0.2, 0}, 1);
    EXPECT_EQ(hand.mode_name(), "turn");
    EXPECT_LE(angle(), 1e-15);
    hand.step({-0.2, -0.4, 0}, 1);
    EXPECT_NEAR(angle(), std::acos(0.0), 1e-12);
  }
}

TEST(WidgetGrab, ARulersEndOnLinksIsReleased) {
  Spec spec = make_widget_spec(Kind::ruler, {0, 0, 0}, {1, 0, 0});
  spec.along_links = {0};
  WidgetProbe hand(make_widget_program({spec}, {test::hold_plane("a", {1, 0.2, 0}, 0.9)}));
  take(hand, {1, 0, 0}, 1);
  const auto before = hand.report().pose;
  hand.step({NAN, 0, 0}, 1);
  hand.step({-2, 1, 3}, 1);
  EXPECT_EQ(hand.mode_name(), "away");
  EXPECT_EQ(hand.report().pose, before);
}

TEST(WidgetRebind, KeepsThePoseByHandUnlessANewerOneWasSet) {
  WidgetProbe hand(make_widget_program({make_widget_spec(Kind::seed, {5, 5, 5}), make_widget_spec(Kind::cutting_plane)}, {}, 0.05));
  hand.grab({1, 0, 0.01});
  hand.step({1.3, 0, 0.01}, 1);
  const auto before = hand.report(1);
  // widgets are matched by name under another order and with another link before theirs
  HapticProgram next = make_widget_program({make_widget_spec(Kind::cutting_plane), make_widget_spec(Kind::seed, {7, 7, 7})},
                                           {test::hold_plane("a", {0, 1, 0}, 0)}, 0.05);
  next.widget_names = {"w1", "w0"};
  const auto replace = [&] {
    hand.replace(next);
    hand.step({1.3, 0, 0.01}, 1);
  };
  replace();
  EXPECT_EQ(hand.mode_name(0), "translate");
  EXPECT_EQ(hand.report(0).pose, before.pose);
  EXPECT_EQ(hand.widget_position(1), Vec3(5, 5, 5)) << "the revision is the same";
  EXPECT_EQ(hand.link_order(), "widget_y widget_z");
  // a newer pose set by the scene
  next.widgets[0].revision = 1;
  next.widgets[0].pose.points[0] = {0.5, 0.5, 3};
  replace();
  EXPECT_EQ(hand.mode_name(0), "away");
  EXPECT_EQ(hand.widget_position(0), Vec3(0.5, 0.5, 3));
  EXPECT_EQ(hand.report(0).revision, 1u);
  // an older revision is ignored
  next.widgets[0].revision = 0;
  next.widgets[0].pose.points[0] = {9, 9, 9};
  replace();
  EXPECT_EQ(hand.widget_position(0), Vec3(0.5, 0.5, 3));
  // a widget of another kind with the same name is another widget
  next.widgets[0] = make_widget_spec(Kind::seed, {2, 2, 2});
  replace();
  EXPECT_EQ(hand.widget_position(0), Vec3(2, 2, 2));
}

TEST(WidgetRebind, ReportsThePosesWithoutAValidProbe) {
  WidgetProbe hand({make_widget_spec(Kind::seed, {1, 2, 3})});
  hand.step({NAN, 0, 0});
  EXPECT_EQ(hand.out.widget_count, 1);
  EXPECT_EQ(hand.widget_position(), Vec3(1, 2, 3));
}

}  // namespace catena::haptics::widget_handles_test
