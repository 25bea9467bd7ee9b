// SPDX-License-Identifier: MIT
/// The in-process bus between libusb and the emulated device, with a small libusb client.
#include "tests/haptics/device/usbfs/raw_client.h"

#include <gtest/gtest.h>

#include "tests/haptics/device/usbfs/in_process_bus.h"

namespace catena::haptics::tests {
namespace raw_client_test {

struct Wrapped {
  explicit Wrapped(InProcessBus& bus) {
    EXPECT_EQ(libusb_set_option(nullptr, LIBUSB_OPTION_NO_DEVICE_DISCOVERY), 0);
    EXPECT_EQ(libusb_init(&context), 0);
    EXPECT_EQ(libusb_wrap_sys_device(context, bus.fd(), &handle), 0);
  }
  ~Wrapped() { libusb_exit(context); }
  libusb_context* context = nullptr;
  libusb_device_handle* handle = nullptr;
};

TEST(InProcessUsb, TheDescriptorIsTheFalcons) {
  InProcessBus bus;
  Wrapped usb(bus);
  RawClient client(usb.handle);
  ASSERT_NE(client.get(), nullptr);
  libusb_device_descriptor descriptor;
  ASSERT_EQ(libusb_get_device_descriptor(libusb_get_device(client.get()), &descriptor), 0);
  EXPECT_EQ(descriptor.idVendor, EmulatedFalcon::kVendor);
  EXPECT_EQ(descriptor.idProduct, EmulatedFalcon::kProduct);
}

TEST(InProcessUsb, TenThousandFramesAreReturned) {
  InProcessBus bus;
  Wrapped usb(bus);
  RawClient client(usb.handle);
  ASSERT_NE(client.get(), nullptr);
  ASSERT_EQ(client.control(3, kBaudRunning), 0);
  ASSERT_EQ(client.control(9, 1), 0);
  std::vector<std::uint8_t> reply;
  for (int i = 0; i < 10000; ++i) {
    ASSERT_EQ(client.write_text(kRestFrame), 0);
    ASSERT_EQ(client.read(reply), 0);
    ASSERT_EQ(reply.size(), 16u);
  }
  EXPECT_EQ(bus.with([](EmulatedFalcon& device) { return device.frames(); }), 10000u);
}

TEST(InProcessUsb, StallsTimeoutsAndUnplugsAreReported) {
  InProcessBus bus;
  Wrapped usb(bus);
  RawClient client(usb.handle);
  ASSERT_NE(client.get(), nullptr);
  std::vector<std::uint8_t> reply;
  bus.with([](EmulatedFalcon& device) { device.halt(EmulatedFalcon::kEndpointIn); });
  EXPECT_EQ(client.read(reply), LIBUSB_ERROR_PIPE);
  EXPECT_EQ(libusb_clear_halt(client.get(), 0x81), 0);
  bus.with([&](EmulatedFalcon&) { bus.port().faults.idle_packets = false; });
  EXPECT_EQ(client.read(reply, 20), LIBUSB_ERROR_TIMEOUT);
  bus.unplug();
  EXPECT_EQ(client.write_text(kRestFrame), LIBUSB_ERROR_NO_DEVICE);
}

}  // namespace raw_client_test
}  // namespace catena::haptics::tests
