// SPDX-License-Identifier: MIT
#include "haptics/device/usb/falcon_session.h"

#include <gtest/gtest.h>

#include "tests/haptics/device/fake_falcon.h"

namespace catena::haptics::usb::falcon_session_test {

using Cycle = FalconSession::Cycle;
constexpr FalconCounts kAt110{-516, -516, -516}, kAt175{1168, 1168, 1168};  // approximate height on the axis in mm

std::int64_t test_clock() {
  static std::int64_t now = 0;
  return now += 1000000;
}

struct FalconSessionTest : testing::Test {
  std::shared_ptr<test::FakeFalcon> fake = std::make_shared<test::FakeFalcon>();
  test::FakeTransport transport{fake};
  FalconCounters counters;
  Ftdi ftdi{transport, counters.ftdi};
  FalconSession session{ftdi, counters, 1e4, test_clock};

  FalconSessionTest() {
    fake->firmware_is_running = true;
    fake->baud = 2;
  }
  void set_frame(const FalconCounts& encoders, int homed, int buttons = 0) {
    fake->frame = {encoders, static_cast<std::uint8_t>(buttons), static_cast<std::uint8_t>(homed), 'A'};
  }
  Cycle run_cycles(int cycles = 1, const Vec3& force_n = Vec3(0.0), bool forces = true) {
    Cycle last = Cycle::no_frame;
    for (int i = 0; i < cycles; ++i) last = session.cycle(force_n, forces);
    return last;
  }
  Cycle run_at(const FalconCounts& encoders, int homed, int cycles = 1, const Vec3& force_n = Vec3(0.0)) {
    set_frame(encoders, homed);
    return run_cycles(cycles, force_n);
  }
  void arm() {
    run_at(kAt175, 7, 4);
    ASSERT_EQ(session.pose().state, FalconState::ready);
    run_at({400, 400, 400}, 7);
    run_at(kAt110, 7);
  }
};

TEST_F(FalconSessionTest, HomingSetsItsBitInEveryPacketAndSendsNoForce) {
  set_frame(kAt110, 3);
  EXPECT_EQ(run_cycles(5, {0, 0, 5}), Cycle::frame);
  ASSERT_EQ(fake->commands.size(), 5u);
  for (const FalconCommand& c : fake->commands) {
    EXPECT_EQ(c.control, kFalconHoming | kFalconRed);
    EXPECT_EQ(c.motors, FalconCounts{});
  }
  EXPECT_EQ(session.pose().state, FalconState::homing);
  EXPECT_EQ(session.homed(), 3);
}

TEST_F(FalconSessionTest, HomedIsAcceptedAfterThreeFrames) {
  run_at(kAt110, 7, 2);
  EXPECT_EQ(session.pose().state, FalconState::homing);
  run_cycles();
  EXPECT_EQ(session.pose().state, FalconState::arming);
  EXPECT_TRUE(session.pose().valid);
  EXPECT_NEAR(session.pose().position_m.z, 0.110, 1e-4);
  run_cycles();
  EXPECT_EQ(fake->last().control, kFalconBlue);
}

TEST_F(FalconSessionTest, ForcesStartOnlyAfterTheGripWasPulledOut) {
  run_at(kAt110, 7, 10, {0, 0, 5});
  EXPECT_EQ(session.pose().state, FalconState::arming);
  for (const FalconCommand& c : fake->commands) EXPECT_EQ(c.motors, FalconCounts{});
  // 169 mm is not enough
  run_at({800, 800, 800}, 7, 2, {0, 0, 5});
  EXPECT_EQ(session.pose().state, FalconState::arming);
  EXPECT_EQ(fake->last().motors, FalconCounts{});
  run_at(kAt175, 7, 2, {0, 0, 5});
  EXPECT_EQ(session.pose().state, FalconState::ready);
  EXPECT_EQ(fake->last().control, kFalconGreen);
  EXPECT_LT(fake->last().motors[0], 0);
}

TEST_F(FalconSessionTest, AForceGivesTheMotorTorqueOfThePose) {
  arm();
  run_cycles(1, {0, 0, 1});
  // 24.18 mN m per newton at 110 mm
  for (const std::int16_t motor : fake->last().motors) EXPECT_NEAR(motor, -242, 1);
  run_cycles(1, {0, 0, 1}, false);
  EXPECT_EQ(fake->last().motors, FalconCounts{});
  EXPECT_EQ(fake->last().control, kFalconBlue);
}

TEST_F(FalconSessionTest, AForceBeyondTheMotorsIsClampedAndCounted) {
  arm();
  run_cycles(1, {0, 0, 16});
  EXPECT_EQ(counters.saturated, 0u);
  run_cycles(1, {0, 0, 1000});
  EXPECT_EQ(fake->last().motors, (FalconCounts{-4095, -4095, -4095}));
  EXPECT_EQ(counters.saturated, 1u);
}

TEST_F(FalconSessionTest, OneUnhomedFrameStopsTheForceForACycle) {
  arm();
  run_at(kAt110, 5, 1, {0, 0, 1});
  EXPECT_EQ(session.pose().state, FalconState::homing);
  run_at(kAt110, 7, 1, {0, 0, 1});
  EXPECT_EQ(fake->last().motors, FalconCounts{});
  EXPECT_EQ(session.pose().state, FalconState::ready);
  run_cycles(1, {0, 0, 1});
  EXPECT_NE(fake->last().motors, FalconCounts{});
}

TEST_F(FalconSessionTest, HomingLostForThreeFramesMustBeArmedAgain) {
  arm();
  run_at(kAt110, 5, 3);
  run_at(kAt110, 7, 10, {0, 0, 1});
  EXPECT_EQ(session.pose().state, FalconState::arming);
  EXPECT_EQ(fake->last().motors, FalconCounts{});
}

TEST_F(FalconSessionTest, AJumpIsAcceptedOnlyIfTheNextFrameConfirmsIt) {
  arm();
  const Vec3 before = session.pose().position_m;
  run_at({900, 900, 900}, 7, 1, {0, 0, 1});
  EXPECT_FALSE(session.pose().valid);
  EXPECT_EQ(session.pose().position_m, before);
  EXPECT_EQ(counters.jumps, 1u);
  run_at(kAt110, 7, 1, {0, 0, 1});
  EXPECT_EQ(fake->last().motors, FalconCounts{});  // no force at a position that is not accepted
  run_cycles();
  EXPECT_TRUE(session.pose().valid);
  EXPECT_EQ(session.pose().position_m, before);
}

TEST_F(FalconSessionTest, OutOfReachHoldsThePositionAndStopsTheForce) {
  arm();
  const Vec3 before = session.pose().position_m;
  for (const int step : {-1500, -2400, -3300, -4200}) {
    const auto e = static_cast<std::int16_t>(step);
    run_at({e, e, e}, 7, 1, {0, 0, 1});
  }
  run_at({-4200, -4200, -4200}, 7, 2, {0, 0, 1});
  EXPECT_FALSE(session.pose().valid);
  EXPECT_GT(counters.out_of_reach, 0u);
  EXPECT_EQ(fake->last().motors, FalconCounts{});
  EXPECT_TRUE(is_finite(session.pose().position_m));
  EXPECT_LT(session.pose().position_m.z, before.z);
  EXPECT_EQ(session.pose().state, FalconState::ready);
}

TEST_F(FalconSessionTest, SplitJoinedAndGarbledFramesAreRead) {
  arm();
  fake->packet_sizes = {5, 0, 11, 16, 3, 13, 32, 1};
  fake->garbage_before_frame = {'<', 'A', 0xFF};
  for (int i = 0; i < 200; ++i) {
    const auto e = static_cast<std::int16_t>(kAt110[0] + i);
    set_frame({e, e, e}, 7, i & 15);
    ASSERT_EQ(run_cycles(), Cycle::frame) << i;
    ASSERT_EQ(session.pose().encoders[1], e);
    ASSERT_EQ(session.pose().buttons, static_cast<unsigned>(i & 15));
  }
  EXPECT_GT(counters.dropped_bytes, 0u);
  EXPECT_GT(counters.resyncs, 0u);
  EXPECT_EQ(counters.bad_cycles, 0u);
}

TEST_F(FalconSessionTest, SilenceTimeoutsAndStallsGiveNoFrameAndNoLoss) {
  arm();
  fake->ignores_commands = true;
  EXPECT_EQ(run_cycles(), Cycle::no_frame);
  fake->ignores_commands = false;
  fake->read_faults = {UsbError::timeout};
  EXPECT_EQ(run_cycles(), Cycle::no_frame);
  EXPECT_EQ(run_cycles(), Cycle::frame);
  fake->read_faults = {UsbError::stall};
  fake->write_faults = {UsbError::stall};
  EXPECT_EQ(run_cycles(), Cycle::frame);
  EXPECT_EQ(fake->in_halt_clears, 1);
  EXPECT_EQ(fake->out_halt_clears, 1);
  fake->read_faults = {UsbError::stall, UsbError::stall};
  EXPECT_EQ(run_cycles(), Cycle::no_frame);
  EXPECT_EQ(run_cycles(), Cycle::frame);
  EXPECT_EQ(counters.bad_cycles, 3u);
  EXPECT_EQ(counters.ftdi.timeouts, 1u);
}

TEST_F(FalconSessionTest, AnUnplugIsReportedAsGone) {
  arm();
  fake->is_plugged = false;
  EXPECT_EQ(run_cycles(), Cycle::disconnected);
  fake->is_plugged = true;
  fake->read_faults = {UsbError::disconnected};
  EXPECT_EQ(run_cycles(), Cycle::disconnected);
}

}  // namespace catena::haptics::usb::falcon_session_test
