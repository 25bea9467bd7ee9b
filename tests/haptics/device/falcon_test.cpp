// SPDX-License-Identifier: MIT
#include "haptics/device/usb/falcon.h"

#include <gtest/gtest.h>

#include <limits>

#include "engine/base/memory_limit.h"
#include "haptics/device/registry.h"
#include "tests/haptics/device/fake_falcon.h"
#include "tests/haptics/device/wait_until.h"
#include "tests/support/results.h"

namespace catena::haptics::usb::falcon_test {

using catena::test::wait_until;
using namespace std::chrono_literals;
constexpr FalconCounts kAt110{-516, -516, -516}, kAt175{1168, 1168, 1168};

std::atomic<std::int64_t> fake_now_ns{1};
std::int64_t fake_clock() { return fake_now_ns; }

struct FalconDevice : testing::Test {
  std::shared_ptr<test::FakeFalcon> fake = std::make_shared<test::FakeFalcon>();
  std::unique_ptr<Falcon> falcon;
  FalconOptions options;

  FalconDevice() {
    fake->firmware_is_running = true;
    fake->read_delay = 100us;
    fake->image = test::make_boot_image();
    options.reconnect_poll_ms = 2;
    options.clock = fake_clock;
  }
  std::string open() {
    auto opened = Falcon::open(std::make_unique<test::FakeSource>(fake), options);
    if (!opened) return opened.error().message;
    falcon = std::move(*opened);
    return "";
  }
  void set_frame(const FalconCounts& encoders, int homed) {
    fake->with_lock([&](test::FakeFalcon& f) { f.frame = {encoders, 0, static_cast<std::uint8_t>(homed), 'A'}; });
  }
  void plug(bool plugged) {
    fake->with_lock([&](test::FakeFalcon& f) { f.is_plugged = plugged; });
  }
  bool wait_for_cycles(std::uint64_t n) {
    const std::uint64_t from = falcon->stats().cycles;
    return wait_until([&] { return falcon->stats().cycles >= from + n; });
  }
  /// Waits for the force of a new command of 1 N.
  bool pushes() {
    falcon->write({{0, 0, 1}, Vec3(0.0)});
    return wait_until([&] { return fake->last().motors[0] < 0; });
  }
  void expect_zero_force() {
    ASSERT_TRUE(wait_for_cycles(3));
    EXPECT_EQ(fake->last().motors, FalconCounts{});
  }
  bool wait_for_state(FalconState state) {
    return wait_until([&] { return falcon->state() == state; });
  }
  void arm() {
    ASSERT_EQ(open(), "");
    set_frame(kAt175, 7);
    ASSERT_TRUE(wait_for_state(FalconState::ready));
    set_frame({400, 400, 400}, 7);
    ASSERT_TRUE(wait_for_cycles(3));
    set_frame(kAt110, 7);
    ASSERT_TRUE(wait_for_cycles(3));
  }
};

TEST_F(FalconDevice, HomesArmsAndInstructsTheUser) {
  set_frame(kAt110, 1);
  ASSERT_EQ(open(), "");
  ASSERT_TRUE(wait_for_cycles(3));
  EXPECT_EQ(falcon->read().status, DeviceStatus::starting);
  EXPECT_FALSE(falcon->read().forces_on);
  EXPECT_EQ(falcon->status_text(), "Falcon: pull the grip fully out, then push it in (homed: 1 of 3 axes)");
  set_frame(kAt110, 7);
  ASSERT_TRUE(wait_for_state(FalconState::arming));
  DeviceInput input = falcon->read();
  EXPECT_EQ(input.status, DeviceStatus::ready);
  EXPECT_FALSE(input.forces_on);
  EXPECT_NEAR(input.position_m.z, 0.110, 1e-4);
  EXPECT_NE(falcon->status_text().find("fully out once"), std::string::npos);
  set_frame(kAt175, 7);
  ASSERT_TRUE(wait_for_state(FalconState::ready));
  ASSERT_TRUE(wait_for_cycles(2));
  input = falcon->read();
  EXPECT_TRUE(input.forces_on);
  EXPECT_GT(input.position_m.z, 0.170);
  EXPECT_EQ(falcon->status_text(), "");
}

TEST_F(FalconDevice, ForceReachesTheMotorsAndStopsWithoutNewCommands) {
  arm();
  falcon->write({{0, 0, 1}, Vec3(0.0)});
  ASSERT_TRUE(wait_until([&] { return fake->last().motors[0] == -242 || fake->last().motors[0] == -241; }));
  EXPECT_EQ(fake->last().control, kFalconGreen);
  EXPECT_EQ(falcon->stats().stale_commands, 0u);
  // the servo's clock advances by less, then by more than the timeout of 20 ms
  fake_now_ns += 19000000;
  ASSERT_TRUE(wait_for_cycles(3));
  EXPECT_NE(fake->last().motors, FalconCounts{});
  fake_now_ns += 2000000;
  expect_zero_force();
  EXPECT_EQ(fake->last().control, kFalconBlue);
  EXPECT_EQ(falcon->stats().stale_commands, 1u);
}

TEST_F(FalconDevice, AnExpiredCommandIsReportedAsLostSoThatTheForceRampsIn) {
  arm();
  EXPECT_EQ(falcon->read().status, DeviceStatus::ready);
  falcon->write({{0, 0, 1}, Vec3(0.0)});
  fake_now_ns += 19000000;
  EXPECT_EQ(falcon->read().status, DeviceStatus::ready) << "the motors still have it";
  falcon->write({{0, 0, 1}, Vec3(0.0)});
  fake_now_ns += 25000000;
  expect_zero_force();
  EXPECT_EQ(falcon->read().status, DeviceStatus::lost) << "zero meanwhile: a force that comes back at once would be a kick";
  falcon->write({Vec3(0.0), Vec3(0.0)});
  ASSERT_TRUE(wait_for_cycles(3));
  EXPECT_EQ(falcon->read().status, DeviceStatus::ready);
}

TEST_F(FalconDevice, ASilentDeviceGetsZeroBeforeItsLineIsReset) {
  options.lost_after_cycles = 1000000;
  arm();
  ASSERT_TRUE(pushes());
  const auto requests = fake->with_lock([](test::FakeFalcon& f) { return f.controls.size(); });
  fake->with_lock([](test::FakeFalcon& f) { f.ignores_commands = true; });
  ASSERT_TRUE(wait_until([&] { return fake->with_lock([&](test::FakeFalcon& f) { return f.controls.size() > requests; }); }));
  EXPECT_EQ(fake->last().motors, FalconCounts{});
  EXPECT_EQ(falcon->read().status, DeviceStatus::lost) << "so that the force ramps in";
  ASSERT_TRUE(wait_for_cycles(5));
  EXPECT_EQ(fake->last().motors, FalconCounts{}) << "no frame, no force";
  fake->with_lock([](test::FakeFalcon& f) { f.ignores_commands = false; });
  EXPECT_TRUE(pushes());
  EXPECT_EQ(falcon->read().status, DeviceStatus::ready);
}

TEST_F(FalconDevice, TheDestructorDoesNotWaitForADeviceThatDoesNotBoot) {
  options.firmware = fake->image;
  arm();
  plug(false);
  ASSERT_TRUE(wait_for_state(FalconState::absent));
  fake->with_lock([](test::FakeFalcon& f) {
    f.firmware_is_running = false;
    f.ignored_handshakes = 1000000;
    f.read_delay = 2ms;
    f.is_plugged = true;
  });
  ASSERT_TRUE(wait_until([&] { return fake->with_lock([](test::FakeFalcon& f) { return f.handshake_count > 0; }); }));
  const int before = fake->with_lock([](test::FakeFalcon& f) { return f.handshake_count; });
  falcon.reset();
  EXPECT_LE(fake->handshake_count, before + 10) << "of a hundred";
}

TEST_F(FalconDevice, StopGivesZeroUntilANewCommandAfterResume) {
  arm();
  ASSERT_TRUE(pushes());
  std::thread([&] { falcon->stop(); }).join();
  expect_zero_force();
  falcon->write({{0, 0, 2}, Vec3(0.0)});
  expect_zero_force();
  EXPECT_NE(falcon->status_text().find("stopped"), std::string::npos);
  const std::size_t before = fake->with_lock([](test::FakeFalcon& f) { return f.commands.size(); });
  falcon->resume();
  ASSERT_TRUE(wait_for_cycles(3));
  fake->with_lock([&](test::FakeFalcon& f) {
    for (std::size_t i = before; i < f.commands.size(); ++i) EXPECT_EQ(f.commands[i].motors, FalconCounts{});
  });
  EXPECT_TRUE(pushes());
}

TEST(FalconTimeout, TheCommandTimeoutGrowsForASlowServo) {
  EXPECT_EQ(falcon_command_timeout_s(1000), 0.02);
  EXPECT_EQ(falcon_command_timeout_s(4000), 0.02);
  EXPECT_DOUBLE_EQ(falcon_command_timeout_s(100), 0.04);
}

TEST_F(FalconDevice, ANonFiniteForceGivesZero) {
  arm();
  falcon->write({Vec3(std::numeric_limits<double>::quiet_NaN()), Vec3(0.0)});
  expect_zero_force();
}

TEST_F(FalconDevice, TheDestructorSendsZeroWithTheLightsOff) {
  arm();
  ASSERT_TRUE(pushes());
  falcon.reset();
  EXPECT_EQ(fake->last().motors, FalconCounts{});
  EXPECT_EQ(fake->last().control, 0);
}

TEST_F(FalconDevice, AnUnpluggedDeviceIsLostAndReturnsAfterBootHomingAndArming) {
  options.firmware = fake->image;
  arm();
  plug(false);
  ASSERT_TRUE(wait_for_state(FalconState::absent));
  const DeviceInput held = falcon->read();
  EXPECT_EQ(held.status, DeviceStatus::lost);
  EXPECT_FALSE(held.forces_on);
  EXPECT_NEAR(held.position_m.z, 0.110, 1e-4);
  EXPECT_TRUE(wait_until([&] { return falcon->status_text().find("not on the USB bus") != std::string::npos; }));
  // the power was off, so that the firmware is lost
  fake->with_lock([](test::FakeFalcon& f) {
    f.firmware_is_running = false;
    f.frame = {kAt110, 0, 0, 'A'};
    f.is_plugged = true;
  });
  ASSERT_TRUE(wait_for_state(FalconState::homing));
  ASSERT_TRUE(wait_for_cycles(3));
  EXPECT_EQ(falcon->read().status, DeviceStatus::starting);
  EXPECT_EQ(falcon->stats().uploads, 1u);
  EXPECT_EQ(falcon->stats().disconnects, 1u);
  EXPECT_EQ(falcon->stats().reconnects, 1u);
  set_frame(kAt110, 7);
  ASSERT_TRUE(wait_for_state(FalconState::arming));
  falcon->write({{0, 0, 1}, Vec3(0.0)});
  expect_zero_force();
  set_frame(kAt175, 7);
  ASSERT_TRUE(wait_for_state(FalconState::ready));
  EXPECT_TRUE(pushes());
}

TEST_F(FalconDevice, ASilentDeviceIsLostAndReopened) {
  arm();
  fake->with_lock([](test::FakeFalcon& f) { f.ignores_commands = true; });
  ASSERT_TRUE(wait_until([&] { return falcon->stats().disconnects == 1; }));
  EXPECT_GE(falcon->stats().bad_cycles, 10u);
  fake->with_lock([](test::FakeFalcon& f) { f.ignores_commands = false; });
  ASSERT_TRUE(wait_for_state(FalconState::arming));
  EXPECT_GE(fake->with_lock([](test::FakeFalcon& f) { return f.open_count; }), 2);
}

TEST_F(FalconDevice, AnOldPoseIsReportedAsLost) {
  arm();
  EXPECT_EQ(falcon->read().status, DeviceStatus::ready);
  fake->block_reads = true;
  ASSERT_TRUE(wait_until([&] { return fake->is_blocked.load(); }));
  fake_now_ns += 90000000;
  EXPECT_NEAR(falcon->read().age_s, 0.09, 1e-9);
  EXPECT_EQ(falcon->read().status, DeviceStatus::ready);
  fake_now_ns += 20000000;
  EXPECT_EQ(falcon->read().status, DeviceStatus::lost);
  fake->block_reads = false;
}

TEST_F(FalconDevice, ReadAndWriteNeverAllocate) {
  arm();
  const AllocationCounter guard;
  for (int i = 0; i < 1000; ++i) {
    falcon->read();
    falcon->write({{0, 0, 1}, Vec3(0.0)});
  }
  falcon->stop();
  falcon->resume();
  EXPECT_EQ(guard.count(), 0u);
}

TEST_F(FalconDevice, OpeningErrorsNameTheRemedy) {
  fake->is_plugged = false;
  EXPECT_NE(open().find("not on the USB bus"), std::string::npos);
  fake->is_plugged = true;
  fake->firmware_is_running = false;
  EXPECT_NE(open().find("--firmware FILE"), std::string::npos);
  options.firmware = fake->image;
  EXPECT_EQ(open(), "");
  EXPECT_EQ(falcon->stats().uploads, 1u);
}

TEST_F(FalconDevice, ConcurrentReadsAndWritesDuringUnplugsAndReturns) {
  options.clock = now_ns;
  arm();
  std::atomic<bool> end{false};
  std::thread servo([&] {
    while (!end) {
      const DeviceInput input = falcon->read();
      EXPECT_TRUE(is_finite(input.position_m));
      falcon->write({{0, 0, input.forces_on ? 1.0 : 0.0}, Vec3(0.0)});
      std::this_thread::sleep_for(200us);
    }
  });
  for (int round = 0; round < 5; ++round) {
    plug(false);
    EXPECT_TRUE(wait_for_state(FalconState::absent));
    falcon->stop();
    plug(true);
    EXPECT_TRUE(wait_for_state(FalconState::arming));
    falcon->status_text();
  }
  end = true;
  servo.join();
  EXPECT_EQ(falcon->stats().reconnects, 5u);
}

TEST(FalconRegistry, IsListedAndRefusedWithAReason) {
  EXPECT_TRUE(is_device_type("falcon"));
  const DeviceCapabilities c = nominal_capabilities("falcon");
  EXPECT_EQ(c.name, "Novint Falcon");
  EXPECT_GT(c.max_force_n, 0);
  EXPECT_DOUBLE_EQ(c.workspace_center_m.z, 0.125);
  int listed = 0;
  for (const DeviceInfo& info : list_devices()) {
    listed += info.name.starts_with("falcon");
    EXPECT_TRUE(!info.name.starts_with("falcon") || !info.detail.empty());
  }
  EXPECT_GE(listed, 1);
  for (const char* name : {"falcon:x", "falcon:-1", "falcon:99"}) EXPECT_TRUE(catena::test::fails(open_device(name, {}), "expected"));
  DeviceSettings missing;
  missing.firmware = "/nowhere/falcon.bin";
  EXPECT_TRUE(catena::test::fails(open_device("falcon", missing), "/nowhere/falcon.bin"));
}

}  // namespace catena::haptics::usb::falcon_test
