// SPDX-License-Identifier: MIT
/// Device type "emulated-falcon": the real driver over the emulator, without libusb.
#include "haptics/device/emulator/emulated_transport.h"

#include <gtest/gtest.h>

#include "haptics/device/usb/falcon.h"
#include "tests/haptics/device/wait_until.h"

namespace catena::haptics::emulated_transport_test {

using test::wait_until;

TEST(EmulatedTransport, ErrorsMatchThoseOfAUsbBus) {
  auto shared = std::make_shared<SharedEmulatedFalcon>();
  EmulatedTransportSource source(shared, false);
  auto transport = std::move(*source.open());
  usb::UsbPacket packet;
  EXPECT_EQ(transport->control(77, 0), usb::UsbError::stall);
  EXPECT_EQ(transport->read(packet, 5).error, usb::UsbError::timeout) << "the chip speaks every 16 ms";
  EXPECT_EQ(transport->control(9, 1), usb::UsbError::none);
  EXPECT_EQ(transport->read(packet, 5).bytes, 2u);
  shared->device.halt(EmulatedFalcon::kEndpointIn);
  EXPECT_EQ(transport->read(packet, 5).error, usb::UsbError::stall);
  EXPECT_EQ(transport->clear_halt(usb::UsbEndpoint::in), usb::UsbError::none);
  EXPECT_EQ(transport->read(packet, 5).error, usb::UsbError::none);
  shared->device.unplug();
  EXPECT_EQ(transport->read(packet, 5).error, usb::UsbError::disconnected);
  EXPECT_FALSE(source.open());
  EXPECT_FALSE(source.wait_for_arrival(1));
  shared->device.plug(true);
  EXPECT_TRUE(source.wait_for_arrival(1));
}

TEST(EmulatedTransport, TheDefaultHandHomesArmsAndStaysInTheWorkspace) {
  auto shared = std::make_shared<SharedEmulatedFalcon>();
  shared->device.mechanism().attach_user(gentle_user());
  bool outside = false;
  int early = 0;
  shared->device.set_exchange_observer([&](const EmulatedFalcon::Exchange& exchange) {
    // forces start only after the grip was homed and pulled out
    if (exchange.position_m.z > 0.170 && exchange.homed == 7) outside = true;
    early += !outside && exchange.motors != EmulatedMechanism::Counts{};
  });
  usb::FalconOptions options;
  options.command_timeout_s = options.max_pose_age_s = 1e6;
  auto falcon = usb::Falcon::open(std::make_unique<EmulatedTransportSource>(shared, false), options);
  ASSERT_TRUE(falcon) << falcon.error().message;
  (*falcon)->write({.force_n = {0, 0, 0.5}});
  ASSERT_TRUE(wait_until([&] { return (*falcon)->state() == usb::FalconState::ready; }));
  const auto frames = [&] {
    const std::scoped_lock lock(shared->mutex);
    return shared->device.frames();
  };
  const std::uint64_t from = frames();
  ASSERT_TRUE(wait_until([&] { return frames() > from + 20000; }));
  EXPECT_EQ(early, 0);
  EXPECT_TRUE(outside);
  EXPECT_EQ((*falcon)->stats().out_of_reach, 0u);
  EXPECT_EQ((*falcon)->stats().disconnects, 0u);
  // the path covers the cube of the workspace
  const DeviceInput input = (*falcon)->read();
  EXPECT_EQ(input.status, DeviceStatus::ready);
  EXPECT_LT(std::fabs(input.position_m.x), 0.03);
  EXPECT_GT(input.position_m.z, 0.09);
  EXPECT_LT(input.position_m.z, 0.14);
}

TEST(EmulatedTransport, TheRegistryOpensItAndTheEmulatedHandMoves) {
  EXPECT_TRUE(is_device_type("emulated-falcon"));
  EXPECT_FALSE(open_device("emulated-falcon:2", {}));
  auto device = open_device("emulated-falcon", {});
  ASSERT_TRUE(device) << device.error().message;
  EXPECT_EQ((*device)->capabilities().name, "Novint Falcon");
  EXPECT_GT((*device)->capabilities().max_force_n, 0);
  EXPECT_TRUE(wait_until([&] { return (*device)->read().status == DeviceStatus::starting; }));
}

}  // namespace catena::haptics::emulated_transport_test
