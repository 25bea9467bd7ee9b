// SPDX-License-Identifier: MIT
/// Long run of servo, driver and the unmodified libusb within one process, with periodic faults: 20 000 ticks and frames, or
/// CATENA_SOAK_TICKS=1000000. Four threads: servo, driver, the bus's timer, test.
#include <cstdlib>

#include "tests/haptics/device/usbfs/ball_link.h"
#include "tests/haptics/device/usbfs/in_process_bus.h"
#include "tests/haptics/device/usbfs/servo_fixture.h"
#include "tests/haptics/device/usbfs/wrap_source.h"

namespace catena::haptics::tests::soak_test {

TEST(UsbSoak, StaysReadyUnderFaults) {
  const char* asked = std::getenv("CATENA_SOAK_TICKS");
  const std::uint64_t ticks = asked != nullptr ? std::strtoull(asked, nullptr, 10) : 20000;
  InProcessBus bus({.homed = true});
  auto falcon = open_wrapped_falcon(bus.fd());
  ServoRig catena(bus, *falcon, ball_link_program(), {.paced = false});
  ASSERT_TRUE(catena.start());
  EmulatedUser hand;
  const Vec3 top = kBallCenterM + Vec3(0, 0, kBallRadiusM);
  hand.path = {{0, top + Vec3(0, 0, 0.005), 0}, {1, top - Vec3(0, 0, 0.003), 1}, {2, top + Vec3(0.005, 0, 0.005), 0}};
  hand.repeat_from_s = 0;
  int largest = 0;
  std::uint64_t pushed = 0;
  bus.with([&](EmulatedFalcon& device) {
    device.mechanism().attach_user(hand);
    device.set_exchange_observer([&, device_ptr = &device](const EmulatedFalcon::Exchange& exchange) {
      for (const int motor : exchange.motors) largest = std::max(largest, std::abs(motor));
      pushed += exchange.motors != EmulatedMechanism::Counts{};
      using Kind = ReplyFault::Kind;
      constexpr Kind kinds[] = {Kind::split, Kind::join, Kind::garbage, Kind::truncate, Kind::drop};
      const std::uint64_t n = device_ptr->frames();
      if (n % 997 == 0) device_ptr->faults().replies.push_back({kinds[n / 997 % 5], n % 15 + 1});
      if (n % 5003 == 0) device_ptr->halt(n % 2 == 0 ? EmulatedFalcon::kEndpointIn : EmulatedFalcon::kEndpointOut);
    });
  });
  const std::uint64_t frames_before = frame_count(bus);
  HapticState tick;
  std::uint64_t last = 0;
  // limits only the time without progress
  while (frame_count(bus) < frames_before + ticks || tick.tick < ticks) {
    ASSERT_TRUE(wait_for_frames(bus, 1));
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
    catena.servo().receive(tick);
    EXPECT_GE(tick.tick, last);
    last = tick.tick;
  }
  catena.servo().stop();
  // the I/O thread is still running: remove the observer before its counts are read
  bus.with([](EmulatedFalcon& device) { device.set_exchange_observer(nullptr); });
  const usb::FalconStats stats = falcon->stats();
  EXPECT_EQ(falcon->state(), usb::FalconState::ready);
  EXPECT_EQ(stats.disconnects, 0u);
  EXPECT_EQ(stats.out_of_reach, 0u);
  EXPECT_GE(stats.stalls, ticks / 5003);
  EXPECT_GT(stats.resyncs, 0u);
  EXPECT_GT(pushed, ticks / 20);
  EXPECT_LE(largest, 4095);
  falcon.reset();
  bus.with([&](EmulatedFalcon& device) {
    EXPECT_EQ(device.last_exchange().motors, (EmulatedMechanism::Counts{})) << "the last packet is zero";
    EXPECT_EQ(bus.port().counts.submitted, bus.port().counts.reaped) << "every URB came home";
    EXPECT_EQ(device.bad_bytes(), 0u);
  });
  std::printf("soak: %llu ticks, %llu frames, %llu URBs, %llu stalls, %llu resyncs\n", static_cast<unsigned long long>(tick.tick),
              static_cast<unsigned long long>(stats.frames), static_cast<unsigned long long>(bus.port().counts.submitted),
              static_cast<unsigned long long>(stats.stalls), static_cast<unsigned long long>(stats.resyncs));
}

}  // namespace catena::haptics::tests::soak_test
