// SPDX-License-Identifier: MIT
/// The Falcon driver over the unmodified libusb, on an emulated device on umockdev's bus: plug and unplug, stalls, timeouts,
/// damaged frames, homing. Asserts counts, order and states, never times.
#include "haptics/device/usb/falcon.h"

#include <gtest/gtest.h>

#include "haptics/device/registry.h"
#include "haptics/device/usb/libusb_transport.h"
#include "tests/haptics/device/emulator/boot_image.h"
#include "tests/haptics/device/usbfs/falcon_fixture.h"
#include "tests/haptics/device/usbfs/umockdev_bus.h"
#include "tests/support/results.h"

namespace catena::haptics::tests::falcon_test {

using usb::Falcon;
using usb::FalconState;

Result<std::unique_ptr<Falcon>> open_falcon(usb::FalconOptions options = patient_options()) {
  return Falcon::open(std::make_unique<usb::LibusbTransportSource>(usb::kFalconUsbId), std::move(options));
}

usb::FalconOptions with_firmware(std::vector<std::uint8_t> image = boot_image({300, 40})) {
  usb::FalconOptions options = patient_options();
  options.firmware = std::move(image);
  return options;
}

const EmulatedFalconOptions kHomed{.homed = true}, kCold{.firmware = false};

/// A device on the bus and the driver on it.
struct Opened {
  explicit Opened(const EmulatedFalconOptions& device = kHomed, usb::FalconOptions options = patient_options()) : bus(device) {
    bus.plug();
    falcon = test::value_of(open_falcon(std::move(options)));
  }
  EmulatedMechanism::Counts motors() {
    return bus.with([](EmulatedFalcon& device) { return device.last_exchange().motors; });
  }
  UmockdevBus bus;
  std::unique_ptr<Falcon> falcon;
};

TEST(FalconUsb, TheRegistryListsIt) {
  UmockdevBus bus;
  bus.plug();
  bool found = false;
  for (const DeviceInfo& info : list_devices()) found = found || (info.name == "falcon" && info.available);
  EXPECT_TRUE(found);
  EXPECT_TRUE(open_device("falcon", {}));
}

TEST(FalconUsb, IsAbsentUntilPlugged) {
  UmockdevBus bus;
  usb::LibusbTransportSource source(usb::kFalconUsbId);
  EXPECT_TRUE(source.has_hotplug());
  EXPECT_FALSE(source.open());
  EXPECT_FALSE(source.wait_for_arrival(5));
  bus.plug();
  EXPECT_TRUE(wait_until([&] { return source.wait_for_arrival(20); }));
  EXPECT_TRUE(source.open());
}

TEST(FalconUsb, ABusyDeviceIsReportedAsBusy) {
  UmockdevBus bus;
  bus.port().faults.claimed_by_another = true;
  bus.plug();
  EXPECT_TRUE(test::fails(open_falcon(), "another program"));
}

TEST(FalconUsb, OpeningClaimsOnceAndSetsUpTheLineBeforeTheFirstFrame) {
  UmockdevBus bus(kHomed);
  bus.plug();
  std::vector<UsbControl> before_frames;
  bus.with([&](EmulatedFalcon& device) {
    device.set_exchange_observer([&, seen = false](const EmulatedFalcon::Exchange&) mutable {
      if (!seen) before_frames = bus.port().device.controls();
      seen = true;
    });
  });
  auto falcon = test::value_of(open_falcon());
  ASSERT_TRUE(wait_for_frames(bus, 5));
  constexpr std::uint8_t kV = 0x40;
  EXPECT_EQ(before_frames, (std::vector<UsbControl>{{kV, 0, 1}, {kV, 0, 2}, {kV, 9, 1}, {kV, 3, 0x02}, {kV, 0, 1}, {kV, 0, 2}}));
  falcon.reset();
  EXPECT_EQ(bus.port().counts.claims, 1u);
  EXPECT_EQ(bus.port().counts.releases, 1u);
}

TEST(FalconUsb, EchoErrorsAreDetectedAndTheUploadRetried) {
  UmockdevBus bus(kCold);
  bus.port().device.boot_rom().faults().echo_errors = {100, 0, boot_image({300, 40}).size() - 1, EmulatedBootRom::npos};
  bus.plug();
  EXPECT_EQ(test::value_of(open_falcon(with_firmware()))->stats().uploads, 4u);
  bus.with([](EmulatedFalcon& device) { EXPECT_EQ(device.boot_rom().attempts(), 4); });
}

TEST(FalconUsb, AnUnplugDuringTheUploadIsAnErrorAndTheNextOpenSucceeds) {
  UmockdevBus bus(kCold);
  bus.port().device.faults().unplug_after_out_bytes = 500;
  bus.plug();
  EXPECT_TRUE(test::fails(open_falcon(with_firmware()), "unplugged"));
  bus.announce_removal();
  bus.plug();
  EXPECT_TRUE(open_falcon(with_firmware()));
}

TEST(FalconUsb, SplitJoinedTruncatedAndNoisyFramesGiveNoFalsePose) {
  using Kind = ReplyFault::Kind;
  auto [bus, falcon] = Opened();
  const Vec3 grip = snap_to_whole_counts({0.01, -0.01, 0.12});
  bus.with([&](EmulatedFalcon& device) { device.mechanism().hold(grip); });
  ASSERT_TRUE(wait_for_frames(bus, 8));
  bus.with([](EmulatedFalcon& device) {
    for (std::size_t n = 1; n < 16; ++n)
      for (const Kind kind : {Kind::split, Kind::none, Kind::truncate, Kind::none, Kind::garbage, Kind::join, Kind::none})
        device.faults().replies.push_back({kind, n});
  });
  ASSERT_TRUE(wait_until([&] {
    const DeviceInput input = falcon->read();
    EXPECT_LT(norm(input.position_m - grip), 1e-9);
    EXPECT_EQ(input.buttons, 0u);
    return bus.with([](EmulatedFalcon& device) { return device.faults().replies.empty(); });
  }));
  ASSERT_TRUE(wait_for_frames(bus, 4));
  EXPECT_EQ(falcon->read().status, DeviceStatus::ready);
  EXPECT_GT(falcon->stats().resyncs, 0u);
  EXPECT_GT(falcon->stats().dropped_bytes, 15u);
  EXPECT_EQ(falcon->stats().disconnects, 0u);
  EXPECT_EQ(falcon->stats().jumps, 0u);
}

TEST(FalconUsb, MissingRepliesTimeOutAndAreCounted) {
  auto [bus, falcon] = Opened();
  ASSERT_TRUE(wait_for_frames(bus, 5));
  bus.with([&](EmulatedFalcon& device) {
    bus.port().faults.idle_packets = false;
    for (int i = 0; i < 6; ++i) {
      device.faults().replies.push_back({ReplyFault::Kind::drop, 0});
      for (int k = 0; k < 3; ++k) device.faults().replies.push_back({});
    }
  });
  ASSERT_TRUE(wait_for_frames(bus, 40));
  EXPECT_GE(falcon->stats().timeouts, 6u);
  EXPECT_GE(falcon->stats().bad_cycles, 6u);
  EXPECT_EQ(falcon->stats().disconnects, 0u);
  EXPECT_GE(bus.port().counts.discarded, 6u);
}

TEST(FalconUsb, AStalledEndpointIsClearedAndReused) {
  auto [bus, falcon] = Opened();
  for (int i = 0; i < 5; ++i) {
    ASSERT_TRUE(wait_for_frames(bus, 5));
    bus.with([&](EmulatedFalcon& device) { device.halt(i % 2 == 0 ? EmulatedFalcon::kEndpointIn : EmulatedFalcon::kEndpointOut); });
  }
  ASSERT_TRUE(wait_for_frames(bus, 5));
  EXPECT_EQ(falcon->stats().stalls, 5u);
  EXPECT_EQ(bus.with([&](EmulatedFalcon&) { return bus.port().counts.clear_halts; }), 5u);
  EXPECT_EQ(falcon->stats().disconnects, 0u);
}

TEST(FalconUsb, SubmissionsRefusedByTheKernelAreCountedAndRetried) {
  auto [bus, falcon] = Opened();
  ASSERT_TRUE(wait_for_frames(bus, 5));
  bus.with([&](EmulatedFalcon&) { bus.port().faults.submit_errors = 3; });
  ASSERT_TRUE(wait_until([&] { return bus.with([&](EmulatedFalcon&) { return bus.port().faults.submit_errors == 0; }); }));
  ASSERT_TRUE(wait_for_frames(bus, 10));
  EXPECT_GE(falcon->stats().errors, 1u);
  EXPECT_EQ(falcon->stats().disconnects, 0u);
  EXPECT_EQ(falcon->read().status, DeviceStatus::ready);
}

TEST(FalconUsb, ASilentDeviceIsLostAndReturnsUnarmed) {
  Opened rig;
  auto& [bus, falcon] = rig;
  bus.with([](EmulatedFalcon& device) { device.mechanism().hold({0, 0, 0.175}); });
  falcon->write({.force_n = {0, 0, -2}});
  ASSERT_TRUE(wait_until([&] { return falcon->state() == FalconState::ready; }));
  bus.with([](EmulatedFalcon& device) {
    device.mechanism().hold({0, 0, 0.12});
    device.faults().silent = true;
  });
  ASSERT_TRUE(wait_until([&] { return falcon->state() == FalconState::absent; }));
  EXPECT_EQ(falcon->read().status, DeviceStatus::lost);
  EXPECT_FALSE(falcon->status_text().empty());
  bus.with([](EmulatedFalcon& device) { device.faults().silent = false; });
  ASSERT_TRUE(wait_until([&] { return falcon->state() == FalconState::arming; }));
  ASSERT_TRUE(wait_for_frames(bus, 6));
  EXPECT_FALSE(falcon->read().forces_on);
  EXPECT_EQ(rig.motors(), (EmulatedMechanism::Counts{}));
  EXPECT_EQ(falcon->stats().disconnects, 1u);
  EXPECT_EQ(falcon->stats().reconnects, 1u);
}

TEST(FalconUsb, AfterAnUnplugMidTransferItNeedsFirmwareHomingAndArming) {
  Opened rig(kCold, with_firmware(boot_image({20})));
  auto& [bus, falcon] = rig;
  ASSERT_TRUE(home_and_arm(bus, *falcon));
  falcon->write({.force_n = {0, 0, -2}});
  ASSERT_TRUE(move_grip(bus, {0.16, 0.15}));
  ASSERT_NE(rig.motors(), (EmulatedMechanism::Counts{}));

  // a read is pending while the device sends nothing
  bus.with([&](EmulatedFalcon& device) {
    bus.port().faults.idle_packets = false;
    device.faults().replies.push_back({ReplyFault::Kind::drop, 0});
  });
  ASSERT_TRUE(wait_for_frames(bus, 1));
  bus.unplug();
  ASSERT_TRUE(wait_until([&] { return falcon->state() == FalconState::absent; }));
  EXPECT_EQ(falcon->read().status, DeviceStatus::lost);
  bus.with([&](EmulatedFalcon&) {
    EXPECT_LE(bus.port().counts.shut_down, 1u);
    EXPECT_LE(bus.port().counts.after_unplug, 4u) << "it does not hammer a device that is gone";
    bus.port().faults.idle_packets = true;
  });

  bus.plug(false);
  ASSERT_TRUE(wait_until([&] { return falcon->state() == FalconState::homing; }));
  EXPECT_EQ(falcon->stats().uploads, 2u);
  EXPECT_EQ(falcon->stats().reconnects, 1u);
  ASSERT_TRUE(wait_for_frames(bus, 6));
  EXPECT_EQ(rig.motors(), (EmulatedMechanism::Counts{}));
  EXPECT_FALSE(falcon->read().forces_on);
  falcon->write({.force_n = {0, 0, -1}});
  ASSERT_TRUE(home_and_arm(bus, *falcon));
  ASSERT_TRUE(wait_for_frames(bus, 6));
  EXPECT_NE(rig.motors(), (EmulatedMechanism::Counts{}));
}

TEST(FalconUsb, AnUnplugAtAnyByteOfAFrameIsALossAndTheDeviceReturns) {
  auto [bus, falcon] = Opened();
  for (std::uint64_t byte = 1; byte <= 16; byte += 3) {
    ASSERT_TRUE(wait_for_frames(bus, 5));
    const std::uint64_t losses = falcon->stats().disconnects;
    bus.with([&](EmulatedFalcon& device) { device.faults().unplug_after_out_bytes = device.out_bytes() / 16 * 16 + 32 + byte; });
    ASSERT_TRUE(wait_until([&] { return falcon->stats().disconnects == losses + 1; }));
    bus.announce_removal();
    bus.plug(true);
    ASSERT_TRUE(wait_until([&] { return falcon->state() == FalconState::arming; }));
  }
  EXPECT_EQ(falcon->stats().reconnects, 6u);
}

TEST(FalconUsb, TheDriverClosesWhileOutTransfersArePending) {
  auto [bus, falcon] = Opened();
  bus.with([&](EmulatedFalcon&) { bus.port().faults.out_naks = true; });
  falcon.reset();
  EXPECT_EQ(bus.port().counts.releases, 1u);
}

}  // namespace catena::haptics::tests::falcon_test
