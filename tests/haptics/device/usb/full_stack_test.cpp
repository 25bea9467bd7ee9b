// SPDX-License-Identifier: MIT
/// The full haptic stack through umockdev, with libusb's own enumeration and events.
#include "tests/haptics/device/usbfs/full_stack_program.h"

#include "haptics/device/usb/libusb_transport.h"
#include "tests/haptics/device/usbfs/umockdev_bus.h"

namespace catena::haptics::tests {
namespace full_stack_test {

TEST(FullStackUsb, TheMotorForceMatchesTheTicksWithinHalfACount) {
  ASSERT_TRUE(UmockdevBus::available()) << "run this program through umockdev-wrapper";
  UmockdevBus bus({.homed = true});
  bus.plug();
  auto falcon = usb::Falcon::open(std::make_unique<usb::LibusbTransportSource>(usb::kFalconUsbId), patient_options());
  ASSERT_TRUE(falcon) << falcon.error().message;
  ServoRig catena(bus, **falcon, ball_program(), {.rate_hz = 1000});
  ASSERT_TRUE(catena.start());
  GripWalk walk;
  for (int i = 0; i < 60; ++i) catena.check(walk.next());
  EXPECT_GT(catena.held, 15);
  EXPECT_GT(catena.free, 15);
  EXPECT_EQ((*falcon)->stats().disconnects, 0u);
}

}  // namespace full_stack_test
}  // namespace catena::haptics::tests
