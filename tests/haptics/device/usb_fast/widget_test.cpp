// SPDX-License-Identifier: MIT
/// The cutting plane end to end: encoder counts and button bits over the unmodified libusb, the driver, the servo and the widget's
/// state machine; poses against closed forms of the grip's position.
#include "tests/haptics/device/usbfs/full_stack_program.h"
#include "tests/haptics/device/usbfs/in_process_bus.h"
#include "tests/haptics/device/usbfs/wrap_source.h"

namespace catena::haptics::tests::widget_test {

using Mode = WidgetMode;

/// A grip that is held at a position with some buttons pressed.
class Hand {
 public:
  Hand(InProcessBus& bus, Servo& servo) : bus_(bus), servo_(servo) {}

  /// Holds the grip at the encoder counts nearest to a world position; true once a tick has it.
  bool hold(const Vec3& world, unsigned buttons) {
    const Vec3 grip = snap_to_whole_counts(kBallCenterM + world * 0.04);
    place = to_world(grip);
    bus_.with([&](EmulatedFalcon& device) {
      device.mechanism().hold_buttons(buttons);
      device.mechanism().hold(grip);
    });
    std::uint64_t seen = 0;
    const bool there = wait_until([&] {
      servo_.receive(tick);
      return norm(tick.probe - place) < 1e-7 && tick.buttons == buttons;
    });
    seen = tick.tick;
    // two more ticks, so that the changes of this one are visible
    return there && wait_until([&] {
             servo_.receive(tick);
             return tick.tick > seen + 1;
           });
  }
  const WidgetReport& cut() const { return tick.widgets[0]; }

  Vec3 place{0.0};
  HapticState tick;

 private:
  InProcessBus& bus_;
  Servo& servo_;
};

TEST(WidgetOverUsb, ExploresTranslatesRotatesAndTurnsACuttingPlane) {
  InProcessBus bus({.homed = true});
  auto falcon = open_wrapped_falcon(bus.fd());
  ServoRig catena(bus, *falcon, widget_scene_program(), {.rate_hz = 2000});
  ASSERT_TRUE(catena.start());
  Hand hand(bus, catena.servo());

  // away from the plane, then on it
  ASSERT_TRUE(hand.hold({0.75, 0.1, 0.3}, 0));
  EXPECT_EQ(hand.cut().mode, Mode::idle);
  ASSERT_TRUE(hand.hold({0.75, 0.1, 0.05}, 0));
  EXPECT_EQ(hand.cut().mode, Mode::explore);
  EXPECT_NEAR(hand.tick.links[2].proxy.z, 0, 1e-12);
  EXPECT_NEAR(hand.tick.force_n.z, -200 * 0.04 * hand.place.z, 1e-6);

  // button pressed: a drag along x; y and z stay bit-identical
  ASSERT_TRUE(hand.hold({0.75, 0.1, 0.05}, 1));
  EXPECT_EQ(hand.cut().mode, Mode::translate);
  EXPECT_EQ(hand.cut().active_planes, 7);
  const Vec3 grab = hand.place;
  for (const double x : {0.7, 0.5, 0.3, 0.2}) {
    ASSERT_TRUE(hand.hold({x, 0.14, 0.02}, 1));
    const double moved = hand.place.x - grab.x, step = 0.08;
    EXPECT_NEAR(hand.cut().pose.points[0].x, moved < -step ? moved + step : 0, 1e-6);
    EXPECT_EQ(hand.cut().pose.points[0].y, 0);
    EXPECT_EQ(hand.cut().pose.points[0].z, 0);
  }
  const Vec3 centre = hand.cut().pose.points[0];
  EXPECT_LT(centre.x, -0.4);
  ASSERT_TRUE(hand.hold({0.2, 0.1, 0.02}, 0));
  EXPECT_EQ(hand.cut().pose.points[0], centre);

  // on the sphere, at the great circle perpendicular to y
  const auto on_circle = [&](double angle) { return centre + Vec3(0.48 * std::sin(angle), 0, 0.48 * std::cos(angle)); };
  ASSERT_TRUE(hand.hold(on_circle(0.9), 0));
  EXPECT_EQ(hand.cut().mode, Mode::rotate);
  EXPECT_EQ(hand.cut().active_planes, 2);
  ASSERT_TRUE(hand.hold(on_circle(0.9), 1));
  EXPECT_EQ(hand.cut().mode, Mode::turn);
  const Vec3 arm = hand.place - centre;
  for (const double angle : {1.0, 1.2, 1.4, 0.6}) {
    ASSERT_TRUE(hand.hold(on_circle(angle), 1));
    const Vec3 now = hand.place - centre, normal = rotate(hand.cut().pose.orientation, {0, 0, 1});
    const double turned = std::atan2(now.x, now.z) - std::atan2(arm.x, arm.z);
    EXPECT_LT(norm(normal - Vec3(std::sin(turned), 0, std::cos(turned))), 1e-5);
    EXPECT_LT(norm(rotate(hand.cut().pose.orientation, {0, 1, 0}) - Vec3(0, 1, 0)), 1e-12) << "the axis stays";
  }
  const Quat turned = hand.cut().pose.orientation;
  ASSERT_TRUE(hand.hold(on_circle(0.6), 0));
  EXPECT_EQ(hand.cut().mode, Mode::rotate);
  ASSERT_TRUE(hand.hold(centre + Vec3(0.2, 0.6, 0.5), 0));
  EXPECT_EQ(hand.cut().mode, Mode::idle);
  EXPECT_EQ(hand.cut().pose.orientation, turned);
  EXPECT_EQ(hand.cut().pose.points[0], centre);
}

}  // namespace catena::haptics::tests::widget_test
