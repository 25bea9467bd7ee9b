// SPDX-License-Identifier: MIT
// The cutting plane on scripted paths, against closed forms (paper, section 6.2).
#include <random>

#include "tests/haptics/chain/widget_probe.h"

namespace catena::haptics::widget_plane_test {

using test::distance_between;
using test::make_widget_spec;
using test::WidgetProbe;
using widget::Kind;
using widget::RotationMode;
using widget::Spec;

constexpr double kStep = 0.08, kPi = 3.14159265358979323846;

Spec plane(const Vec3& center = {0.1, -0.2, 0.3}, const Quat& orientation = kIdentityRotation) {
  Spec spec = make_widget_spec(Kind::cutting_plane, center);
  spec.pose.orientation = orientation;
  return spec;
}

struct Frame {
  Vec3 center;
  Quat q;
  Vec3 axis(int i) const { return rotate(q, {i == 0 ? 1.0 : 0.0, i == 1 ? 1.0 : 0.0, i == 2 ? 1.0 : 0.0}); }
  Vec3 world(const Vec3& local) const { return center + axis(0) * local.x + axis(1) * local.y + axis(2) * local.z; }
};

TEST(WidgetPlane, ModesAndTheirChainsInOrder) {
  const Vec3 place(0.12 + 0.48 * 0.8, 0, 0.48 * 0.6);
  WidgetProbe hand({plane({0, 0, 0})});
  hand.expect({1, 0, 1}, 0, "away", "");
  hand.expect({1, 0, 0.05}, 0, "explore", "widget_z");
  EXPECT_EQ(hand.report().active_planes, 4);
  EXPECT_EQ(hand.link(2).proxy, Vec3(1, 0, 0));
  hand.expect({1, 0, 0.05}, 1, "translate", "widget_x widget_y widget_z");
  EXPECT_EQ(hand.report().active_planes, 7);
  hand.expect({1.2, 0, 0.05}, 1, "translate", "widget_y widget_z");
  hand.expect({1.2, 0.3, -0.3}, 1, "translate", "");
  hand.step({1.2, 0, 0.05}, 1);
  hand.expect({1.2, 0, 0.05}, 0, "explore", "widget_z");
  hand.expect(place, 0, "rotate", "widget_y widget_sphere");
  EXPECT_NEAR(hand.link(3).proxy.y, 0, 1e-15);
  hand.expect(place, 1, "turn", "widget_y widget_sphere");
  EXPECT_EQ(hand.report().active_planes, 2);
  hand.expect(place + Vec3(0, 0.09, 0), 1, "turn", "widget_sphere");  // the plane of the great circle releases
  hand.expect(place, 1, "turn", "widget_sphere");                     // it stays released until the button is
  hand.expect({5, 5, 5}, 0, "away", "");
}

TEST(WidgetPlane, AtAPoleTwoGreatCirclesAreActive) {
  WidgetProbe hand({plane({0, 0, 0})});
  hand.expect({0.02, -0.03, 0.5}, 0, "rotate", "widget_x widget_y widget_sphere");
  EXPECT_EQ(hand.report().active_planes, 3);
  EXPECT_LE(distance_between(hand.out.links[3].proxy, {0, 0, 0.48}), 1e-15);
}

// A trembling drag along x: y and z stay bit-identical, x follows the closed form.
TEST(WidgetPlane, ADragAlongXKeepsYAndZBitForBit) {
  std::mt19937_64 random(1);
  std::uniform_real_distribution<double> jitter(-0.99 * kStep, 0.99 * kStep);
  const Vec3 center{0.1, -0.2, 0.3};
  WidgetProbe hand({plane(center)});
  const Vec3 grab = center + Vec3(0.9, 0.4, 0.03);
  hand.grab(grab);
  ASSERT_EQ(hand.mode_name(), "translate");
  for (int k = 1; k <= 2000; ++k) {
    const double x = 1.5 * k / 2000 - 0.3;
    const auto& report = hand.step(grab + Vec3(x, jitter(random), jitter(random)), 1);
    const double moved = x > kStep ? x - kStep : x < -kStep ? x + kStep : 0;
    ASSERT_EQ(report.pose.points[0].y, center.y);
    ASSERT_EQ(report.pose.points[0].z, center.z);
    ASSERT_NEAR(report.pose.points[0].x, center.x + moved, 1e-15);
    ASSERT_EQ(report.pose.orientation, kIdentityRotation);
    ASSERT_EQ(report.active_planes & 6, 6);
  }
  EXPECT_NEAR(hand.widget_position().x, center.x + 1.2 - kStep, 1e-15);
}

TEST(WidgetPlane, ADragInARotatedFrameStaysOnItsAxis) {
  std::mt19937_64 random(2);
  std::uniform_real_distribution<double> jitter(-0.99 * kStep, 0.99 * kStep);
  for (int axis = 0; axis < 3; ++axis) {
    const Frame frame{{0.1, -0.2, 0.3}, test::kTilted};
    WidgetProbe hand({plane(frame.center, frame.q)});
    const Vec3 grab = frame.world({0.9, 0.4, 0.03});
    hand.grab(grab);
    ASSERT_EQ(hand.mode_name(), "translate");
    for (int k = 1; k <= 500; ++k) {
      Vec3 local(jitter(random), jitter(random), jitter(random));
      local[axis] = -1.5 * k / 500;
      const Vec3 moved = hand.step(grab + frame.world(local) - frame.center, 1).pose.points[0] - frame.center;
      for (int i = 0; i < 3; ++i) {
        const double expected = i != axis ? 0 : local[i] < -kStep ? local[i] + kStep : 0;
        ASSERT_NEAR(dot(frame.axis(i), moved), expected, 1e-12) << axis << " " << k;
      }
    }
  }
}

TEST(WidgetPlane, MotionAlongTwoAndThreeAxes) {
  const Vec3 center{0.1, -0.2, 0.3}, grab = center + Vec3(0.9, 0.4, 0.03);
  WidgetProbe hand({plane(center)});
  hand.grab(grab);
  hand.move_to(grab + Vec3(0.5, 0.01, -0.6), 1);
  EXPECT_LE(distance_between(hand.widget_position(), center + Vec3(0.5 - kStep, 0, -0.6 + kStep)), 1e-15);
  EXPECT_EQ(hand.widget_position().y, center.y);
  hand.move_to(grab + Vec3(0.5, 0.7, -0.6), 1);
  EXPECT_LE(distance_between(hand.widget_position(), center + Vec3(0.5 - kStep, 0.7 - kStep, -0.6 + kStep)), 1e-15);
}

// The position depends only on the probe's position, not its path; back within the step an axis is at its start.
TEST(WidgetPlane, TranslationIsIndependentOfThePath) {
  const Frame frame{{0.1, -0.2, 0.3}, test::kTilted};
  const Vec3 grab = frame.world({0.9, 0.4, 0.03}), end = grab + Vec3(0.31, -0.22, 0.17);
  std::mt19937_64 random(3);
  std::uniform_real_distribution<double> anywhere(-2, 2);
  WidgetProbe straight({plane(frame.center, frame.q)}), wandering({plane(frame.center, frame.q)});
  for (WidgetProbe* hand : {&straight, &wandering}) {
    hand->grab(grab);
  }
  straight.step(end, 1);
  for (int k = 0; k < 300; ++k) wandering.step(grab + Vec3(anywhere(random), anywhere(random), anywhere(random)), 1);
  EXPECT_EQ(straight.widget_position(), wandering.step(end, 1).pose.points[0]);
  EXPECT_EQ(wandering.step(grab, 1).pose.points[0], frame.center);
}

TEST(WidgetPlane, GrabbingAndReleasingDoNotMoveThePlane) {
  const Frame frame{{0.1, -0.2, 0.3}, test::kTilted};
  WidgetProbe hand({plane(frame.center, frame.q)});
  for (int k = 0; k < 20; ++k) {
    hand.step(frame.world({0.9, 0.4, 0.07}), 0);
    hand.step(frame.world({0.9, 0.4, 0.19}), static_cast<std::uint32_t>(k % 2));
  }
  hand.step(frame.world({0.48, 0, 0}), 0);
  for (int k = 0; k < 20; ++k) hand.step(frame.world({0.3, 0.374, 0.01}), static_cast<std::uint32_t>(k % 2));
  EXPECT_EQ(hand.widget_position(), frame.center);
  EXPECT_LE(distance_between(rotate(hand.report().pose.orientation, {1, 0, 0}), frame.axis(0)), 1e-14);
}

/// A point on the great circle perpendicular to `axis`, at `angle` from the next axis and `radius`, `aside` off its plane.
Vec3 on_circle(const Frame& frame, int axis, double angle, double radius, double aside = 0) {
  return frame.center + frame.axis((axis + 1) % 3) * (radius * std::cos(angle)) + frame.axis((axis + 2) % 3) * (radius * std::sin(angle)) +
         frame.axis(axis) * aside;
}

// Many laps of a hand that trembles off the plane and off the sphere: the axis stays fixed, the angle is the hand's.
TEST(WidgetPlane, AxisRotationKeepsTheAxisAndRotatesByTheHandsAngle) {
  std::mt19937_64 random(4);
  std::uniform_real_distribution<double> jitter(-0.99 * kStep, 0.99 * kStep), radius(0.2, 0.9);
  for (const Quat& q : {kIdentityRotation, test::kTilted})
    for (int axis = 0; axis < 3; ++axis) {
      const Frame frame{{0.1, -0.2, 0.3}, q};
      WidgetProbe hand({plane(frame.center, frame.q)});
      const double from = 0.7;
      hand.step(on_circle(frame, axis, from, 0.5));
      ASSERT_EQ(hand.mode_name(), "rotate");
      hand.step(on_circle(frame, axis, from, 0.5), 1);
      ASSERT_EQ(hand.mode_name(), "turn");
      ASSERT_EQ(hand.report().active_planes, 1 << axis);
      for (int k = 1; k <= 3000; ++k) {
        const double angle = 0.05 * k;  // 24 laps
        const auto& report = hand.step(on_circle(frame, axis, from + angle, radius(random), jitter(random)), 1);
        const Frame now{frame.center, report.pose.orientation};
        ASSERT_LE(distance_between(now.axis(axis), frame.axis(axis)), 1e-12);
        const Vec3 expected = frame.axis((axis + 1) % 3) * std::cos(angle) + frame.axis((axis + 2) % 3) * std::sin(angle);
        ASSERT_LE(distance_between(now.axis((axis + 1) % 3), expected), 1e-12) << axis << " " << k;
        ASSERT_EQ(report.pose.points[0], frame.center);
      }
    }
}

// For a widget that starts unrotated, the vector part of the quaternion lies exactly on the axis.
TEST(WidgetPlane, AWorldAxisStaysFixedBitForBit) {
  const Frame frame{{0, 0, 0}, kIdentityRotation};
  WidgetProbe hand({plane(frame.center)});
  hand.grab(on_circle(frame, 2, 0.7, 0.48));
  for (int k = 0; k < 1000; ++k) {
    const Quat& q = hand.step(on_circle(frame, 2, 0.7 + 0.3 * k, 0.5), 1).pose.orientation;
    ASSERT_EQ(q.x, 0);
    ASSERT_EQ(q.y, 0);
  }
}

TEST(WidgetPlane, FreeRotationAlongAGreatCircleIsARotationInItsPlane) {
  Spec spec = plane({0.1, -0.2, 0.3}, test::kTilted);
  spec.rotation = RotationMode::free;
  const Frame frame{spec.pose.points[0], spec.pose.orientation};
  // a great circle other than the three of the axes
  const Frame circle{frame.center, normalized(Quat(0.5, 0.5, 0.1, -0.6))};
  WidgetProbe hand({spec});
  hand.step(on_circle(circle, 2, 0.2, 0.48));
  EXPECT_EQ(hand.link_order(), "widget_sphere");
  EXPECT_EQ(hand.step(on_circle(circle, 2, 0.2, 0.48), 1).active_planes, 0);
  for (int k = 1; k <= 2000; ++k) {
    const double angle = 0.01 * k;
    const auto& report = hand.step(on_circle(circle, 2, 0.2 + angle, 0.3 + 0.1 * (k % 7)), 1);
    const Quat turned = normalized(rotation_from_vector(circle.axis(2) * angle) * frame.q);
    const Frame now{frame.center, report.pose.orientation};
    ASSERT_LE(distance_between(now.axis(0), rotate(turned, {1, 0, 0})), 1e-11) << k;
    ASSERT_LE(distance_between(now.axis(2), rotate(turned, {0, 0, 1})), 1e-11) << k;
  }
}

TEST(WidgetPlane, InModeAnyTheRotationBecomesFreeWithoutAJump) {
  const Frame frame{{0, 0, 0}, test::kTilted};
  WidgetProbe hand({plane(frame.center, frame.q)});
  hand.grab(on_circle(frame, 0, 0.3, 0.48));
  Quat before = hand.report().pose.orientation;
  bool free = false;
  for (int k = 1; k <= 400; ++k) {
    const auto& report = hand.step(on_circle(frame, 0, 0.3 + 0.002 * k, 0.48, 0.0005 * k), 1);
    // never more than the hand's own rotation
    ASSERT_LE(norm(rotation_vector(report.pose.orientation * glm::conjugate(before))), 0.005) << k;
    ASSERT_EQ(report.active_planes, 0.0005 * k <= kStep ? 1 : 0);
    before = report.pose.orientation;
    free = free || report.active_planes == 0;
  }
  EXPECT_TRUE(free);
  EXPECT_GT(distance_between(rotate(before, {1, 0, 0}), frame.axis(0)), 1e-3);  // the rotation has left the axis
}

TEST(WidgetPlane, InModeAxisTheNearestGreatCircleHoldsAtAnyDistance) {
  Spec spec = plane({0, 0, 0});
  spec.rotation = RotationMode::axis;
  const Frame frame{{0, 0, 0}, kIdentityRotation};
  WidgetProbe hand({spec});
  // nearest to the great circle perpendicular to y, but within the snap distance of none
  const Vec3 place = Vec3(0.7, 0.35, 0.6) * (0.48 / norm(Vec3(0.7, 0.35, 0.6)));
  hand.expect(place, 0, "rotate", "widget_sphere");
  hand.expect(place, 1, "turn", "widget_y widget_sphere");
  EXPECT_EQ(hand.report().pose.orientation, kIdentityRotation);
  const double from = std::atan2(0.7, 0.6);
  for (int k = 1; k <= 300; ++k) {
    const auto& report = hand.step(on_circle(frame, 1, from + 0.02 * k, 0.4, 0.35), 1);
    const Frame now{frame.center, report.pose.orientation};
    ASSERT_LE(distance_between(now.axis(1), {0, 1, 0}), 1e-12);
    ASSERT_LE(distance_between(now.axis(2), Vec3(std::sin(0.02 * k), 0, std::cos(0.02 * k))), 1e-12);
  }
}

TEST(WidgetPlane, RotateOnContactTurnsWithoutTheButton) {
  Spec spec = plane({0, 0, 0});
  spec.rotate_on_contact = true;
  const Frame frame{{0, 0, 0}, kIdentityRotation};
  WidgetProbe hand({spec});
  hand.step({5, 5, 5});
  hand.expect(on_circle(frame, 0, 0.4, 0.5), 0, "turn", "widget_x widget_sphere");
  for (int k = 1; k <= 100; ++k) hand.step(on_circle(frame, 0, 0.4 + 0.01 * k, 0.5));
  const Frame turned{frame.center, hand.report().pose.orientation};
  EXPECT_LE(distance_between(turned.axis(1), {0, std::cos(1), std::sin(1)}), 1e-12);
  // leaving the sphere releases it, unless the button is held
  hand.step(on_circle(frame, 0, 1.4, 0.6));
  EXPECT_NE(hand.mode_name(), "turn");
  hand.grab(on_circle(frame, 0, 1.4, 0.5));
  hand.step(on_circle(frame, 0, 1.4, 0.9), 1);
  EXPECT_EQ(hand.mode_name(), "turn");
  hand.step(on_circle(frame, 0, 1.4, 0.9), 0);
  EXPECT_NE(hand.mode_name(), "turn");
}

TEST(WidgetPlane, ConsecutiveTurnsUseTheRotatedAxes) {
  const Frame start{{0, 0, 0}, kIdentityRotation};
  WidgetProbe hand({plane({0, 0, 0})});
  Frame now = start;
  for (const int axis : {0, 1, 2, 1}) {
    hand.step({5, 5, 5});
    hand.grab(on_circle(now, axis, 0.6, 0.48));
    const Vec3 held_axis = now.axis(axis);
    for (int k = 1; k <= 50; ++k) hand.step(on_circle(now, axis, 0.6 + 0.02 * k, 0.48), 1);
    const Quat expected = normalized(rotation_from_vector(held_axis) * now.q);
    now.q = hand.report().pose.orientation;
    EXPECT_LE(distance_between(now.axis(axis), held_axis), 1e-12);
    EXPECT_LE(norm(rotation_vector(normalized(now.q * glm::conjugate(expected)))), 1e-12);
  }
}

}  // namespace catena::haptics::widget_plane_test
