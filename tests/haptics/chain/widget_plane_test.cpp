// The cutting plane by scripted paths, against closed forms (paper, section 6.2).
#include <random>

#include "tests/haptics/chain/widget_hand.h"

namespace catena::haptics {
namespace widget_plane_test {

using test::off;
using test::widget_spec;
using test::WidgetHand;
using widget::Kind;
using widget::Spec;
using widget::Turning;

constexpr double kStep = 0.08, kPi = 3.14159265358979323846;

Spec plane(const Vec3& center = {0.1, -0.2, 0.3}, const Quat& orientation = kNoRotation) {
  Spec spec = widget_spec(Kind::cutting_plane, center);
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
  WidgetHand hand({plane({0, 0, 0})});
  hand.step({1, 0, 1});
  EXPECT_EQ(hand.mode(), "away");
  EXPECT_EQ(hand.order(), "");
  hand.step({1, 0, 0.05});
  EXPECT_EQ(hand.mode(), "explore");
  EXPECT_EQ(hand.order(), "widget_z");
  EXPECT_EQ(hand.report().held, 4);
  EXPECT_EQ(hand.out.links[2].proxy, Vec3(1, 0, 0));
  hand.step({1, 0, 0.05}, 1);
  EXPECT_EQ(hand.mode(), "translate");
  EXPECT_EQ(hand.order(), "widget_x widget_y widget_z");
  EXPECT_EQ(hand.report().held, 7);
  hand.step({1.2, 0, 0.05}, 1);
  EXPECT_EQ(hand.order(), "widget_y widget_z");
  hand.step({1.2, 0.3, -0.3}, 1);
  EXPECT_EQ(hand.order(), "");
  hand.step({1.2, 0, 0.05}, 1);
  hand.step({1.2, 0, 0.05}, 0);
  EXPECT_EQ(hand.mode(), "explore");
  hand.step({0.12 + 0.48 * 0.8, 0, 0.48 * 0.6}, 0);
  EXPECT_EQ(hand.mode(), "rotate");
  EXPECT_EQ(hand.order(), "widget_y widget_sphere");
  EXPECT_NEAR(hand.out.links[3].proxy.y, 0, 1e-15);
  hand.step({0.12 + 0.48 * 0.8, 0, 0.48 * 0.6}, 1);
  EXPECT_EQ(hand.mode(), "turn");
  EXPECT_EQ(hand.order(), "widget_y widget_sphere");
  EXPECT_EQ(hand.report().held, 2);
  hand.step({0.12 + 0.48 * 0.8, 0.09, 0.48 * 0.6}, 1);  // the plane lets go
  EXPECT_EQ(hand.order(), "widget_sphere");
  hand.step({0.12 + 0.48 * 0.8, 0, 0.48 * 0.6}, 1);  // until the hand does
  EXPECT_EQ(hand.order(), "widget_sphere");
  hand.step({5, 5, 5}, 0);
  EXPECT_EQ(hand.mode(), "away");
}

TEST(WidgetPlane, TwoGreatCirclesAtAPole) {
  WidgetHand hand({plane({0, 0, 0})});
  hand.step({0.02, -0.03, 0.5});
  EXPECT_EQ(hand.order(), "widget_x widget_y widget_sphere");
  EXPECT_EQ(hand.report().held, 3);
  EXPECT_LE(off(hand.out.links[3].proxy, {0, 0, 0.48}), 1e-15);
}

// A drag along x by a hand that trembles: y and z stay to the bit, x follows the closed form.
TEST(WidgetPlane, ADragAlongXLeavesYAndZ) {
  std::mt19937_64 random(1);
  std::uniform_real_distribution<double> jitter(-0.99 * kStep, 0.99 * kStep);
  const Vec3 center{0.1, -0.2, 0.3};
  WidgetHand hand({plane(center)});
  const Vec3 grab = center + Vec3(0.9, 0.4, 0.03);
  hand.step(grab);
  hand.step(grab, 1);
  ASSERT_EQ(hand.mode(), "translate");
  for (int k = 1; k <= 2000; ++k) {
    const double x = 1.5 * k / 2000 - 0.3;
    const auto& report = hand.step(grab + Vec3(x, jitter(random), jitter(random)), 1);
    const double moved = x > kStep ? x - kStep : x < -kStep ? x + kStep : 0;
    ASSERT_EQ(report.pose.points[0].y, center.y);
    ASSERT_EQ(report.pose.points[0].z, center.z);
    ASSERT_NEAR(report.pose.points[0].x, center.x + moved, 1e-15);
    ASSERT_EQ(report.pose.orientation, kNoRotation);
    ASSERT_EQ(report.held & 6, 6);
  }
  EXPECT_NEAR(hand.place().x, center.x + 1.2 - kStep, 1e-15);
}

TEST(WidgetPlane, ADragInATurnedFrameStaysOnItsAxis) {
  std::mt19937_64 random(2);
  std::uniform_real_distribution<double> jitter(-0.99 * kStep, 0.99 * kStep);
  for (int axis = 0; axis < 3; ++axis) {
    const Frame frame{{0.1, -0.2, 0.3}, test::kTilted};
    WidgetHand hand({plane(frame.center, frame.q)});
    const Vec3 grab = frame.world({0.9, 0.4, 0.03});
    hand.step(grab);
    hand.step(grab, 1);
    ASSERT_EQ(hand.mode(), "translate");
    for (int k = 1; k <= 500; ++k) {
      Vec3 local(jitter(random), jitter(random), jitter(random));
      local[axis] = -1.5 * k / 500;
      const Vec3 probe = grab + frame.axis(0) * local.x + frame.axis(1) * local.y + frame.axis(2) * local.z;
      const Vec3 moved = hand.step(probe, 1).pose.points[0] - frame.center;
      for (int i = 0; i < 3; ++i) {
        const double expected = i != axis ? 0 : local[i] < -kStep ? local[i] + kStep : 0;
        ASSERT_NEAR(dot(frame.axis(i), moved), expected, 1e-12) << axis << " " << k;
      }
    }
  }
}

TEST(WidgetPlane, MotionAlongTwoAndThreeAxes) {
  const Vec3 center{0.1, -0.2, 0.3}, grab = center + Vec3(0.9, 0.4, 0.03);
  WidgetHand hand({plane(center)});
  hand.step(grab);
  hand.step(grab, 1);
  hand.go(grab + Vec3(0.5, 0.01, -0.6), 1);
  EXPECT_LE(off(hand.place(), center + Vec3(0.5 - kStep, 0, -0.6 + kStep)), 1e-15);
  EXPECT_EQ(hand.place().y, center.y);
  hand.go(grab + Vec3(0.5, 0.7, -0.6), 1);
  EXPECT_LE(off(hand.place(), center + Vec3(0.5 - kStep, 0.7 - kStep, -0.6 + kStep)), 1e-15);
}

// The pose depends on where the hand is, not on how it came there; back within the step an axis is where it was.
TEST(WidgetPlane, TranslationIsIndependentOfThePath) {
  const Frame frame{{0.1, -0.2, 0.3}, test::kTilted};
  const Vec3 grab = frame.world({0.9, 0.4, 0.03}), end = grab + Vec3(0.31, -0.22, 0.17);
  std::mt19937_64 random(3);
  std::uniform_real_distribution<double> anywhere(-2, 2);
  WidgetHand straight({plane(frame.center, frame.q)}), wandering({plane(frame.center, frame.q)});
  for (WidgetHand* hand : {&straight, &wandering}) {
    hand->step(grab);
    hand->step(grab, 1);
  }
  straight.step(end, 1);
  for (int k = 0; k < 300; ++k) wandering.step(grab + Vec3(anywhere(random), anywhere(random), anywhere(random)), 1);
  wandering.step(end, 1);
  EXPECT_EQ(straight.place(), wandering.place());
  wandering.step(grab, 1);
  EXPECT_EQ(wandering.place(), frame.center);
}

TEST(WidgetPlane, GrabbingAndLettingGoDoNotMoveIt) {
  const Frame frame{{0.1, -0.2, 0.3}, test::kTilted};
  WidgetHand hand({plane(frame.center, frame.q)});
  for (int k = 0; k < 20; ++k) {
    hand.step(frame.world({0.9, 0.4, 0.07}), 0);
    hand.step(frame.world({0.9, 0.4, 0.19}), static_cast<std::uint32_t>(k % 2));
  }
  hand.step(frame.world({0.48, 0, 0}), 0);
  for (int k = 0; k < 20; ++k) hand.step(frame.world({0.3, 0.374, 0.01}), static_cast<std::uint32_t>(k % 2));
  EXPECT_EQ(hand.place(), frame.center);
  EXPECT_LE(off(rotate(hand.report().pose.orientation, {1, 0, 0}), frame.axis(0)), 1e-14);
}

/// A point of the great circle across `axis`, `angle` from the next axis, at `radius`, `aside` off its plane.
Vec3 on_circle(const Frame& frame, int axis, double angle, double radius, double aside = 0) {
  return frame.center + frame.axis((axis + 1) % 3) * (radius * std::cos(angle)) + frame.axis((axis + 2) % 3) * (radius * std::sin(angle)) +
         frame.axis(axis) * aside;
}

// Many laps by a hand that trembles off the plane and off the sphere: the axis stays, the angle is that of the hand.
TEST(WidgetPlane, AxisRotationKeepsItsAxisAndTurnsByTheHandsAngle) {
  std::mt19937_64 random(4);
  std::uniform_real_distribution<double> jitter(-0.99 * kStep, 0.99 * kStep), radius(0.2, 0.9);
  for (const Quat& q : {kNoRotation, test::kTilted})
    for (int axis = 0; axis < 3; ++axis) {
      const Frame frame{{0.1, -0.2, 0.3}, q};
      WidgetHand hand({plane(frame.center, frame.q)});
      const double from = 0.7;
      hand.step(on_circle(frame, axis, from, 0.5));
      ASSERT_EQ(hand.mode(), "rotate");
      hand.step(on_circle(frame, axis, from, 0.5), 1);
      ASSERT_EQ(hand.mode(), "turn");
      ASSERT_EQ(hand.report().held, 1 << axis);
      for (int k = 1; k <= 3000; ++k) {
        const double angle = 0.05 * k;  // 24 laps
        const auto& report = hand.step(on_circle(frame, axis, from + angle, radius(random), jitter(random)), 1);
        const Frame now{frame.center, report.pose.orientation};
        ASSERT_LE(off(now.axis(axis), frame.axis(axis)), 1e-12);
        const Vec3 expected = frame.axis((axis + 1) % 3) * std::cos(angle) + frame.axis((axis + 2) % 3) * std::sin(angle);
        ASSERT_LE(off(now.axis((axis + 1) % 3), expected), 1e-12) << axis << " " << k;
        ASSERT_EQ(report.pose.points[0], frame.center);
      }
    }
}

// The vector part of the quaternion lies on the axis to the bit, where the widget began unturned.
TEST(WidgetPlane, AnAxisOfTheWorldStaysToTheBit) {
  const Frame frame{{0, 0, 0}, kNoRotation};
  WidgetHand hand({plane(frame.center)});
  hand.step(on_circle(frame, 2, 0.7, 0.48));
  hand.step(on_circle(frame, 2, 0.7, 0.48), 1);
  for (int k = 0; k < 1000; ++k) {
    const Quat& q = hand.step(on_circle(frame, 2, 0.7 + 0.3 * k, 0.5), 1).pose.orientation;
    ASSERT_EQ(q.x, 0);
    ASSERT_EQ(q.y, 0);
  }
}

TEST(WidgetPlane, FreeRotationAlongAGreatCircleIsTheRotationInIt) {
  Spec spec = plane({0.1, -0.2, 0.3}, test::kTilted);
  spec.turning = Turning::free;
  const Frame frame{spec.pose.points[0], spec.pose.orientation};
  // some circle that is none of the three
  const Frame circle{frame.center, normalised(Quat(0.5, 0.5, 0.1, -0.6))};
  WidgetHand hand({spec});
  hand.step(on_circle(circle, 2, 0.2, 0.48));
  EXPECT_EQ(hand.order(), "widget_sphere");
  hand.step(on_circle(circle, 2, 0.2, 0.48), 1);
  EXPECT_EQ(hand.report().held, 0);
  for (int k = 1; k <= 2000; ++k) {
    const double angle = 0.01 * k;
    const auto& report = hand.step(on_circle(circle, 2, 0.2 + angle, 0.3 + 0.1 * (k % 7)), 1);
    const Quat turned = normalised(rotation_of(circle.axis(2) * angle) * frame.q);
    const Frame now{frame.center, report.pose.orientation};
    ASSERT_LE(off(now.axis(0), rotate(turned, {1, 0, 0})), 1e-11) << k;
    ASSERT_LE(off(now.axis(2), rotate(turned, {0, 0, 1})), 1e-11) << k;
  }
}

TEST(WidgetPlane, AnyTurnsFreelyOnceThePlaneLetsGoWithoutAJump) {
  const Frame frame{{0, 0, 0}, test::kTilted};
  WidgetHand hand({plane(frame.center, frame.q)});
  hand.step(on_circle(frame, 0, 0.3, 0.48));
  hand.step(on_circle(frame, 0, 0.3, 0.48), 1);
  Quat before = hand.report().pose.orientation;
  bool free = false;
  for (int k = 1; k <= 400; ++k) {
    const auto& report = hand.step(on_circle(frame, 0, 0.3 + 0.002 * k, 0.48, 0.0005 * k), 1);
    // never more than the hand itself has turned
    ASSERT_LE(norm(rotation_vector(report.pose.orientation * glm::conjugate(before))), 0.005) << k;
    ASSERT_EQ(report.held, 0.0005 * k <= kStep ? 1 : 0);
    before = report.pose.orientation;
    free = free || report.held == 0;
  }
  EXPECT_TRUE(free);
  EXPECT_GT(off(rotate(before, {1, 0, 0}), frame.axis(0)), 1e-3);  // it has left the axis
}

TEST(WidgetPlane, AxisNeverLetsGoAndTakesTheNearest) {
  Spec spec = plane({0, 0, 0});
  spec.turning = Turning::axis;
  const Frame frame{{0, 0, 0}, kNoRotation};
  WidgetHand hand({spec});
  // nearest to the great circle across y, but not within `near` of any
  const Vec3 place = Vec3(0.7, 0.35, 0.6) * (0.48 / norm(Vec3(0.7, 0.35, 0.6)));
  hand.step(place);
  EXPECT_EQ(hand.order(), "widget_sphere");
  hand.step(place, 1);
  EXPECT_EQ(hand.order(), "widget_y widget_sphere");
  EXPECT_EQ(hand.report().pose.orientation, kNoRotation);
  const double from = std::atan2(0.7, 0.6);
  for (int k = 1; k <= 300; ++k) {
    const auto& report = hand.step(on_circle(frame, 1, from + 0.02 * k, 0.4, 0.35), 1);
    const Frame now{frame.center, report.pose.orientation};
    ASSERT_LE(off(now.axis(1), {0, 1, 0}), 1e-12);
    ASSERT_LE(off(now.axis(2), Vec3(std::sin(0.02 * k), 0, std::cos(0.02 * k))), 1e-12);
  }
}

TEST(WidgetPlane, ATouchTurnsWithoutTheButton) {
  Spec spec = plane({0, 0, 0});
  spec.touch = true;
  const Frame frame{{0, 0, 0}, kNoRotation};
  WidgetHand hand({spec});
  hand.step({5, 5, 5});
  hand.step(on_circle(frame, 0, 0.4, 0.5));
  EXPECT_EQ(hand.mode(), "turn");
  EXPECT_EQ(hand.order(), "widget_x widget_sphere");
  for (int k = 1; k <= 100; ++k) hand.step(on_circle(frame, 0, 0.4 + 0.01 * k, 0.5));
  const Frame turned{frame.center, hand.report().pose.orientation};
  EXPECT_LE(off(turned.axis(1), {0, std::cos(1), std::sin(1)}), 1e-12);
  // off the sphere it lets go; a press holds it
  hand.step(on_circle(frame, 0, 1.4, 0.6));
  EXPECT_NE(hand.mode(), "turn");
  hand.step(on_circle(frame, 0, 1.4, 0.5));
  hand.step(on_circle(frame, 0, 1.4, 0.5), 1);
  hand.step(on_circle(frame, 0, 1.4, 0.9), 1);
  EXPECT_EQ(hand.mode(), "turn");
  hand.step(on_circle(frame, 0, 1.4, 0.9), 0);
  EXPECT_NE(hand.mode(), "turn");
}

TEST(WidgetPlane, TheSphereTurnsAboutTheAxesThatItHasTurned) {
  const Frame start{{0, 0, 0}, kNoRotation};
  WidgetHand hand({plane({0, 0, 0})});
  Frame now = start;
  for (const int axis : {0, 1, 2, 1}) {
    hand.step({5, 5, 5});
    hand.step(on_circle(now, axis, 0.6, 0.48));
    hand.step(on_circle(now, axis, 0.6, 0.48), 1);
    const Vec3 kept = now.axis(axis);
    for (int k = 1; k <= 50; ++k) hand.step(on_circle(now, axis, 0.6 + 0.02 * k, 0.48), 1);
    const Quat expected = normalised(rotation_of(kept) * now.q);
    now.q = hand.report().pose.orientation;
    EXPECT_LE(off(now.axis(axis), kept), 1e-12);
    EXPECT_LE(norm(rotation_vector(normalised(now.q * glm::conjugate(expected)))), 1e-12);
  }
}

}  // namespace widget_plane_test
}  // namespace catena::haptics
