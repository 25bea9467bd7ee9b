// SPDX-License-Identifier: MIT
/// The emulated bus, with a small libusb client instead of the driver: bulk and control transfers, stalls, timeouts, hotplug and
/// unplugs through umockdev and the URB queues.
#include "tests/haptics/device/usbfs/raw_client.h"

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>

#include "tests/haptics/device/usbfs/umockdev_bus.h"

namespace catena::haptics::tests {
namespace raw_client_test {

struct Context {
  Context() { EXPECT_EQ(libusb_init(&context), 0); }
  ~Context() { libusb_exit(context); }
  libusb_device_handle* open() { return libusb_open_device_with_vid_pid(context, EmulatedFalcon::kVendor, EmulatedFalcon::kProduct); }
  libusb_context* context = nullptr;
};

class RawUsb : public testing::Test {
 protected:
  void SetUp() override { ASSERT_TRUE(UmockdevBus::available()) << "run this program through umockdev-wrapper"; }
};

TEST_F(RawUsb, TheDeviceIsEnumeratedWithItsName) {
  UmockdevBus bus;
  bus.plug();
  Context usb;
  RawClient client(usb.open());
  ASSERT_NE(client.get(), nullptr);
  libusb_device_descriptor descriptor;
  ASSERT_EQ(libusb_get_device_descriptor(libusb_get_device(client.get()), &descriptor), 0);
  unsigned char name[64];
  ASSERT_GT(libusb_get_string_descriptor_ascii(client.get(), descriptor.iProduct, name, sizeof name), 0);
  EXPECT_STREQ(reinterpret_cast<char*>(name), "FALCON HAPTIC");
  EXPECT_EQ(libusb_get_max_packet_size(libusb_get_device(client.get()), 0x81), 64);
}

TEST_F(RawUsb, AFrameIsSentAndItsReplyReceived) {
  UmockdevBus bus;
  bus.plug();
  Context usb;
  RawClient client(usb.open());
  ASSERT_NE(client.get(), nullptr);
  EXPECT_EQ(client.control(3, kBaudRunning), 0);
  EXPECT_EQ(client.control(9, 1), 0);
  EXPECT_EQ(client.control(77, 1), LIBUSB_ERROR_PIPE);
  std::vector<std::uint8_t> reply;
  for (int i = 0; i < 50; ++i) {
    ASSERT_EQ(client.write_text(kRestFrame), 0);
    ASSERT_EQ(client.read(reply), 0);
    ASSERT_EQ(reply.size(), 16u);
  }
  EXPECT_EQ(bus.with([](EmulatedFalcon& device) { return device.frames(); }), 50u);
}

TEST_F(RawUsb, AnIdleChipSendsTwoBytes) {
  UmockdevBus bus;
  bus.plug();
  Context usb;
  RawClient client(usb.open());
  ASSERT_NE(client.get(), nullptr);
  std::uint8_t packet[64];
  int n = 0;
  EXPECT_EQ(libusb_bulk_transfer(client.get(), 0x81, packet, 64, &n, 1000), 0);
  EXPECT_EQ(n, 2);
}

TEST_F(RawUsb, AReadWithoutDataIsCancelledAfterItsTimeout) {
  UmockdevBus bus;
  bus.port().faults.idle_packets = false;
  bus.plug();
  Context usb;
  RawClient client(usb.open());
  ASSERT_NE(client.get(), nullptr);
  std::vector<std::uint8_t> reply;
  EXPECT_EQ(client.read(reply, 20), LIBUSB_ERROR_TIMEOUT);
  bus.with([&](EmulatedFalcon&) {
    EXPECT_EQ(bus.port().counts.discarded, 1u);
    bus.port().faults.out_naks = true;
  });
  EXPECT_EQ(client.write({1, 2, 3}, 20), LIBUSB_ERROR_TIMEOUT);
  bus.with([&](EmulatedFalcon& device) {
    EXPECT_EQ(device.out_bytes(), 0u);
    bus.port().faults.out_naks = false;
  });
  EXPECT_EQ(client.write({1, 2, 3}), 0);
}

TEST_F(RawUsb, AHaltedEndpointStallsUntilItIsCleared) {
  UmockdevBus bus;
  bus.plug();
  Context usb;
  RawClient client(usb.open());
  ASSERT_NE(client.get(), nullptr);
  client.control(3, kBaudRunning);
  bus.with([](EmulatedFalcon& device) {
    device.halt(EmulatedFalcon::kEndpointIn);
    device.halt(EmulatedFalcon::kEndpointOut);
  });
  std::vector<std::uint8_t> reply;
  EXPECT_EQ(client.read(reply), LIBUSB_ERROR_PIPE);
  EXPECT_EQ(client.write_text(kRestFrame), LIBUSB_ERROR_PIPE);
  EXPECT_EQ(libusb_clear_halt(client.get(), 0x02), 0);
  EXPECT_EQ(client.write_text(kRestFrame), 0);
  EXPECT_EQ(client.read(reply), LIBUSB_ERROR_PIPE);
  EXPECT_EQ(libusb_clear_halt(client.get(), 0x81), 0);
  EXPECT_EQ(client.read(reply), 0);
  EXPECT_EQ(reply.size(), 16u);
}

struct Seen {
  std::atomic<int> arrived{0}, left{0};
  static int LIBUSB_CALL on_event(libusb_context*, libusb_device*, libusb_hotplug_event event, void* self) {
    ++(event == LIBUSB_HOTPLUG_EVENT_DEVICE_ARRIVED ? static_cast<Seen*>(self)->arrived : static_cast<Seen*>(self)->left);
    return 0;
  }
};

template <class F>
bool eventually(Context& usb, F&& condition) {
  for (int i = 0; i < 500 && !condition(); ++i) {
    timeval step{0, 10000};
    libusb_handle_events_timeout(usb.context, &step);
  }
  return condition();
}

TEST_F(RawUsb, HotplugEventsAreReportedAndEachPlugIsANewDevice) {
  UmockdevBus bus;
  Context usb;
  Seen seen;
  libusb_hotplug_callback_handle callback;
  ASSERT_EQ(libusb_hotplug_register_callback(usb.context, LIBUSB_HOTPLUG_EVENT_DEVICE_ARRIVED | LIBUSB_HOTPLUG_EVENT_DEVICE_LEFT,
                                             LIBUSB_HOTPLUG_NO_FLAGS, EmulatedFalcon::kVendor, EmulatedFalcon::kProduct,
                                             LIBUSB_HOTPLUG_MATCH_ANY, &Seen::on_event, &seen, &callback),
            0);
  EXPECT_EQ(usb.open(), nullptr);
  for (int round = 1; round <= 3; ++round) {
    bus.plug(true);
    EXPECT_TRUE(eventually(usb, [&] { return seen.arrived == round; }));
    RawClient client(usb.open());
    ASSERT_NE(client.get(), nullptr);
    EXPECT_EQ(client.control(3, kBaudRunning), 0);
    bus.unplug();
    EXPECT_TRUE(eventually(usb, [&] { return seen.left == round; }));
    EXPECT_EQ(client.write_text(kRestFrame), LIBUSB_ERROR_NO_DEVICE);
    EXPECT_EQ(client.control(3, kBaudRunning), LIBUSB_ERROR_NO_DEVICE);
  }
}

struct Flight {
  std::uint8_t packet[64];
  std::atomic<int> status{-1};
  libusb_transfer* transfer = libusb_alloc_transfer(0);
  ~Flight() { libusb_free_transfer(transfer); }
  static void LIBUSB_CALL done(libusb_transfer* transfer) { static_cast<Flight*>(transfer->user_data)->status = transfer->status; }
  int submit(libusb_device_handle* handle, std::uint8_t endpoint) {
    libusb_fill_bulk_transfer(transfer, handle, endpoint, packet, 64, &Flight::done, this, 0);
    return libusb_submit_transfer(transfer);
  }
};

TEST_F(RawUsb, UnpluggingEndsTransfersInFlight) {
  UmockdevBus bus;
  bus.port().faults.idle_packets = false;
  bus.plug();
  Context usb;
  RawClient client(usb.open());
  ASSERT_NE(client.get(), nullptr);
  Flight in, out;
  bus.with([&](EmulatedFalcon&) { bus.port().faults.out_naks = true; });
  ASSERT_EQ(in.submit(client.get(), 0x81), 0);
  ASSERT_EQ(out.submit(client.get(), 0x02), 0);
  bus.unplug();
  EXPECT_TRUE(eventually(usb, [&] { return in.status >= 0 && out.status >= 0; }));
  EXPECT_EQ(in.status, LIBUSB_TRANSFER_NO_DEVICE);
  EXPECT_EQ(out.status, LIBUSB_TRANSFER_NO_DEVICE);
  EXPECT_EQ(bus.port().counts.shut_down, 2u);
}

TEST_F(RawUsb, AnUnplugMidTransferEndsTheTransfer) {
  UmockdevBus bus;
  bus.port().device.faults().unplug_after_out_bytes = 8;
  bus.plug();
  Context usb;
  RawClient client(usb.open());
  ASSERT_NE(client.get(), nullptr);
  EXPECT_EQ(client.write_text(kRestFrame), LIBUSB_ERROR_NO_DEVICE);
  bus.announce_removal();
  EXPECT_EQ(client.write_text(kRestFrame), LIBUSB_ERROR_NO_DEVICE);
}

}  // namespace raw_client_test
}  // namespace catena::haptics::tests
