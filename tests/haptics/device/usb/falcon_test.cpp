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

namespace catena::haptics::tests {
namespace falcon_test {

using usb::Falcon;
using usb::FalconState;
using Controls = std::vector<UsbControl>;
constexpr std::uint8_t kV = 0x40;

std::unique_ptr<Falcon> open_falcon(usb::FalconOptions options = patient_options()) {
  auto falcon = Falcon::open(std::make_unique<usb::LibusbTransportSource>(usb::kFalconUsbId), std::move(options));
  if (falcon) return std::move(*falcon);
  ADD_FAILURE() << falcon.error().message;
  return nullptr;
}

usb::FalconOptions with_firmware(std::vector<std::uint8_t> image = boot_image({300, 40})) {
  usb::FalconOptions options = patient_options();
  options.firmware = std::move(image);
  return options;
}

class FalconUsb : public testing::Test {
 protected:
  void SetUp() override { ASSERT_TRUE(UmockdevBus::available()) << "run this program through umockdev-wrapper"; }
};

const EmulatedFalconOptions kHomed{.homed = true}, kCold{.firmware = false};

// ---- plug and open ----

TEST_F(FalconUsb, TheRegistryListsIt) {
  UmockdevBus bus;
  bus.plug();
  bool found = false;
  for (const DeviceInfo& info : list_devices()) found = found || (info.name == "falcon" && info.available);
  EXPECT_TRUE(found);
  EXPECT_TRUE(open_device("falcon", {}));
}

TEST_F(FalconUsb, IsAbsentUntilPlugged) {
  UmockdevBus bus;
  usb::LibusbTransportSource source(usb::kFalconUsbId);
  EXPECT_TRUE(source.has_hotplug());
  EXPECT_FALSE(source.open());
  EXPECT_FALSE(source.wait_for_arrival(5));
  bus.plug();
  EXPECT_TRUE(wait_until([&] { return source.wait_for_arrival(20); }));
  EXPECT_TRUE(source.open());
}

TEST_F(FalconUsb, ABusyDeviceIsReportedAsBusy) {
  UmockdevBus bus;
  bus.port().faults.claimed_by_another = true;
  bus.plug();
  const auto opened = Falcon::open(std::make_unique<usb::LibusbTransportSource>(usb::kFalconUsbId), patient_options());
  ASSERT_FALSE(opened);
  EXPECT_NE(opened.error().message.find("another program"), std::string::npos) << opened.error().message;
}

TEST_F(FalconUsb, OpeningClaimsOnceAndSetsUpTheLineBeforeTheFirstFrame) {
  UmockdevBus bus(kHomed);
  bus.plug();
  Controls before_frames;
  bus.with([&](EmulatedFalcon& device) {
    device.set_exchange_observer([&, seen = false](const EmulatedFalcon::Exchange&) mutable {
      if (!seen) before_frames = bus.port().device.controls();
      seen = true;
    });
  });
  auto falcon = open_falcon();
  ASSERT_NE(falcon, nullptr);
  ASSERT_TRUE(wait_for_frames(bus, 5));
  EXPECT_EQ(before_frames, (Controls{{kV, 0, 1}, {kV, 0, 2}, {kV, 9, 1}, {kV, 3, 0x02}, {kV, 0, 1}, {kV, 0, 2}}));
  falcon.reset();
  EXPECT_EQ(bus.port().counts.claims, 1u);
  EXPECT_EQ(bus.port().counts.releases, 1u);
}

// ---- firmware ----

TEST_F(FalconUsb, FirmwareIsUploadedInTheExpectedOrder) {
  UmockdevBus bus(kCold);
  bus.plug();
  auto falcon = open_falcon(with_firmware());
  ASSERT_NE(falcon, nullptr);
  EXPECT_EQ(falcon->stats().uploads, 1u);
  bus.with([](EmulatedFalcon& device) {
    EXPECT_TRUE(device.running());
    EXPECT_EQ(device.boot_rom().attempts(), 1);
    EXPECT_EQ(device.boot_rom().image_bytes(), boot_image({300, 40}).size());
    // checks for running firmware, boots, then sets the line to the firmware's settings
    const Controls running{{kV, 0, 1}, {kV, 0, 2}, {kV, 9, 1}, {kV, 3, 0x02}, {kV, 0, 1}, {kV, 0, 2}};
    Controls expected = running;
    expected.insert(expected.end(), {{kV, 0, 1},
                                     {kV, 0, 2},
                                     {kV, 9, 16},
                                     {kV, 3, 0x4138},
                                     {kV, 4, 8},
                                     {kV, 2, 0},
                                     {kV, 1, 0x0200},
                                     {kV, 1, 0x0100},
                                     {kV, 1, 0x0101},
                                     {kV, 1, 0x0100},
                                     {kV, 3, 0x15}});
    expected.insert(expected.end(), running.begin(), running.end());
    EXPECT_EQ(device.controls(), expected);
  });
}

TEST_F(FalconUsb, EchoErrorsAreDetectedAndTheUploadRetried) {
  UmockdevBus bus(kCold);
  bus.port().device.boot_rom().faults().echo_errors = {100, 0, boot_image({300, 40}).size() - 1, EmulatedBootRom::npos};
  bus.plug();
  auto falcon = open_falcon(with_firmware());
  ASSERT_NE(falcon, nullptr);
  EXPECT_EQ(falcon->stats().uploads, 4u);
  bus.with([](EmulatedFalcon& device) { EXPECT_EQ(device.boot_rom().attempts(), 4); });
}

TEST_F(FalconUsb, TenDamagedUploadsAreAnError) {
  UmockdevBus bus(kCold);
  bus.port().device.boot_rom().faults().echo_errors = std::deque<std::size_t>(20, 30);
  bus.plug();
  const auto opened = Falcon::open(std::make_unique<usb::LibusbTransportSource>(usb::kFalconUsbId), with_firmware(boot_image({20})));
  ASSERT_FALSE(opened);
  EXPECT_NE(opened.error().message.find("byte 30"), std::string::npos) << opened.error().message;
  bus.with([](EmulatedFalcon& device) { EXPECT_EQ(device.boot_rom().attempts(), 10); });
}

TEST_F(FalconUsb, IgnoredHandshakesAndALeadingZeroAreTolerated) {
  UmockdevBus bus(kCold);
  bus.port().device.boot_rom().faults() = {.ignored_handshakes = 3, .leading_zero = true, .echo_errors = {}};
  bus.plug();
  auto falcon = open_falcon(with_firmware(boot_image({20})));
  ASSERT_NE(falcon, nullptr);
  EXPECT_EQ(falcon->stats().uploads, 1u);
}

TEST_F(FalconUsb, WithoutFirmwareTheErrorNamesTheOption) {
  UmockdevBus bus(kCold);
  bus.plug();
  const auto opened = Falcon::open(std::make_unique<usb::LibusbTransportSource>(usb::kFalconUsbId), patient_options());
  ASSERT_FALSE(opened);
  EXPECT_NE(opened.error().message.find("--firmware"), std::string::npos) << opened.error().message;
}

TEST_F(FalconUsb, AnUnplugDuringTheUploadIsAnErrorAndTheNextOpenSucceeds) {
  UmockdevBus bus(kCold);
  bus.port().device.faults().unplug_after_out_bytes = 500;
  bus.plug();
  const auto opened = Falcon::open(std::make_unique<usb::LibusbTransportSource>(usb::kFalconUsbId), with_firmware());
  ASSERT_FALSE(opened);
  EXPECT_NE(opened.error().message.find("unplugged"), std::string::npos) << opened.error().message;
  bus.announce_removal();
  bus.plug();
  EXPECT_NE(open_falcon(with_firmware()), nullptr);
}

// ---- homing ----

TEST_F(FalconUsb, NoForceIsSentBeforeHomingAndPullingOut) {
  UmockdevBus bus;
  bus.plug();
  bus.with([](EmulatedFalcon& device) { device.mechanism().hold({0, 0, 0.12}); });
  auto falcon = open_falcon();
  ASSERT_NE(falcon, nullptr);
  falcon->write({.force_n = {1, -2, 3}});
  ASSERT_TRUE(wait_for_frames(bus, 10));
  const auto last = [&] { return bus.with([](EmulatedFalcon& device) { return device.last_exchange(); }); };
  EXPECT_EQ(falcon->state(), FalconState::homing);
  EXPECT_EQ(falcon->read().status, DeviceStatus::starting);
  EXPECT_EQ(last().control, 1u | 8u) << "homing, red";
  EXPECT_EQ(last().motors, (EmulatedMechanism::Counts{}));

  for (const double z : {0.14, 0.165, 0.175, 0.165, 0.15, 0.14}) ASSERT_TRUE(hold_grip_at(bus, {0, 0, z}));
  ASSERT_TRUE(wait_until([&] { return falcon->state() == FalconState::arming; }));
  ASSERT_TRUE(wait_for_frames(bus, 6));
  EXPECT_FALSE(falcon->read().forces_on);
  EXPECT_NEAR(falcon->read().position_m.z, 0.14, 30e-6);
  EXPECT_EQ(last().control, 4u) << "blue";
  EXPECT_EQ(last().motors, (EmulatedMechanism::Counts{}));
  ASSERT_TRUE(hold_grip_at(bus, {0, 0, 0.169}));
  EXPECT_EQ(falcon->state(), FalconState::arming);

  ASSERT_TRUE(hold_grip_at(bus, {0, 0, 0.171}));
  ASSERT_TRUE(wait_until([&] { return falcon->state() == FalconState::ready; }));
  ASSERT_TRUE(wait_for_frames(bus, 6));
  EXPECT_TRUE(falcon->read().forces_on);
  EXPECT_EQ(last().control, 2u) << "green";
  EXPECT_NE(last().motors, (EmulatedMechanism::Counts{}));
  falcon->stop();
  ASSERT_TRUE(wait_for_frames(bus, 3));
  EXPECT_EQ(last().motors, (EmulatedMechanism::Counts{}));
  // the last packet has zero motors and no light
  falcon.reset();
  EXPECT_EQ(last().control, 0u);
}

TEST_F(FalconUsb, ButtonsAreReported) {
  UmockdevBus bus(kHomed);
  bus.plug();
  auto falcon = open_falcon();
  ASSERT_NE(falcon, nullptr);
  for (const unsigned buttons : {1u, 2u, 4u, 8u, 15u, 0u}) {
    bus.with([&](EmulatedFalcon& device) { device.mechanism().hold_buttons(buttons); });
    ASSERT_TRUE(wait_for_frames(bus, 4));
    EXPECT_EQ(falcon->read().buttons, buttons);
  }
}

// ---- frames ----

TEST_F(FalconUsb, SplitJoinedTruncatedAndNoisyFramesGiveNoFalsePose) {
  using Kind = ReplyFault::Kind;
  UmockdevBus bus(kHomed);
  bus.plug();
  const Vec3 grip = snap_to_whole_counts({0.01, -0.01, 0.12});
  bus.with([&](EmulatedFalcon& device) { device.mechanism().hold(grip); });
  auto falcon = open_falcon();
  ASSERT_NE(falcon, nullptr);
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

TEST_F(FalconUsb, MissingRepliesTimeOutAndAreCounted) {
  UmockdevBus bus(kHomed);
  bus.port().faults.idle_packets = false;
  bus.plug();
  auto falcon = open_falcon();
  ASSERT_NE(falcon, nullptr);
  ASSERT_TRUE(wait_for_frames(bus, 5));
  bus.with([](EmulatedFalcon& device) {
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

TEST_F(FalconUsb, AStalledEndpointIsClearedAndReused) {
  UmockdevBus bus(kHomed);
  bus.plug();
  auto falcon = open_falcon();
  ASSERT_NE(falcon, nullptr);
  for (int i = 0; i < 5; ++i) {
    ASSERT_TRUE(wait_for_frames(bus, 5));
    bus.with([&](EmulatedFalcon& device) { device.halt(i % 2 == 0 ? EmulatedFalcon::kEndpointIn : EmulatedFalcon::kEndpointOut); });
  }
  ASSERT_TRUE(wait_for_frames(bus, 5));
  EXPECT_EQ(falcon->stats().stalls, 5u);
  EXPECT_EQ(bus.with([&](EmulatedFalcon&) { return bus.port().counts.clear_halts; }), 5u);
  EXPECT_EQ(falcon->stats().disconnects, 0u);
}

TEST_F(FalconUsb, SubmissionsRefusedByTheKernelAreCountedAndRetried) {
  UmockdevBus bus(kHomed);
  bus.plug();
  auto falcon = open_falcon();
  ASSERT_NE(falcon, nullptr);
  ASSERT_TRUE(wait_for_frames(bus, 5));
  bus.with([&](EmulatedFalcon&) { bus.port().faults.submit_errors = 3; });
  ASSERT_TRUE(wait_until([&] { return bus.with([&](EmulatedFalcon&) { return bus.port().faults.submit_errors == 0; }); }));
  ASSERT_TRUE(wait_for_frames(bus, 10));
  EXPECT_GE(falcon->stats().errors, 1u);
  EXPECT_EQ(falcon->stats().disconnects, 0u);
  EXPECT_EQ(falcon->read().status, DeviceStatus::ready);
}

// ---- loss and unplug ----

TEST_F(FalconUsb, ASilentDeviceIsLostAndReturnsUnarmed) {
  UmockdevBus bus(kHomed);
  bus.plug();
  bus.with([](EmulatedFalcon& device) { device.mechanism().hold({0, 0, 0.175}); });
  auto falcon = open_falcon();
  ASSERT_NE(falcon, nullptr);
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
  EXPECT_EQ(bus.with([](EmulatedFalcon& device) { return device.last_exchange().motors; }), (EmulatedMechanism::Counts{}));
  EXPECT_EQ(falcon->stats().disconnects, 1u);
  EXPECT_EQ(falcon->stats().reconnects, 1u);
}

TEST_F(FalconUsb, AfterAnUnplugMidTransferItNeedsFirmwareHomingAndArming) {
  UmockdevBus bus(kCold);
  bus.plug();
  auto falcon = open_falcon(with_firmware(boot_image({20})));
  ASSERT_NE(falcon, nullptr);
  ASSERT_TRUE(home_and_arm(bus, *falcon));
  falcon->write({.force_n = {0, 0, -2}});
  ASSERT_TRUE(hold_grip_at(bus, {0, 0, 0.16}));
  ASSERT_TRUE(hold_grip_at(bus, {0, 0, 0.15}));
  ASSERT_NE(bus.with([](EmulatedFalcon& device) { return device.last_exchange().motors; }), (EmulatedMechanism::Counts{}));

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
  EXPECT_EQ(bus.with([](EmulatedFalcon& device) { return device.last_exchange().motors; }), (EmulatedMechanism::Counts{}));
  EXPECT_FALSE(falcon->read().forces_on);
  falcon->write({.force_n = {0, 0, -1}});
  ASSERT_TRUE(home_and_arm(bus, *falcon));
  ASSERT_TRUE(wait_for_frames(bus, 6));
  EXPECT_NE(bus.with([](EmulatedFalcon& device) { return device.last_exchange().motors; }), (EmulatedMechanism::Counts{}));
}

TEST_F(FalconUsb, AnUnplugAtAnyByteOfAFrameIsALossAndTheDeviceReturns) {
  UmockdevBus bus(kHomed);
  bus.plug();
  auto falcon = open_falcon();
  ASSERT_NE(falcon, nullptr);
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

TEST_F(FalconUsb, TheDriverClosesWhileOutTransfersArePending) {
  UmockdevBus bus(kHomed);
  bus.plug();
  auto falcon = open_falcon();
  ASSERT_NE(falcon, nullptr);
  bus.with([&](EmulatedFalcon&) { bus.port().faults.out_naks = true; });
  falcon.reset();
  EXPECT_EQ(bus.port().counts.releases, 1u);
}

}  // namespace falcon_test
}  // namespace catena::haptics::tests
