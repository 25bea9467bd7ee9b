// SPDX-License-Identifier: MIT
#include "haptics/servo/servo.h"

#include <gtest/gtest.h>

#include <cmath>

#include "haptics/device/recorded_path.h"
#include "haptics/device/simulated_device.h"
#include "haptics/servo/replay.h"
#include "tests/haptics/servo/run_servo.h"
#include "tests/support/simple_links.h"

namespace catena::haptics::servo_test {

std::shared_ptr<HapticProgram> program_at(double height, std::uint64_t epoch) {
  auto program = std::make_shared<HapticProgram>();
  program->epoch = epoch;
  program->links = {test::hold_height("a", height)};
  program->coupling.damping_ns_per_m = 1.5;
  return program;
}

TEST(Servo, ThreadAndReplayGiveTheSameHash) {
  std::vector<RecordedPath::Sample> samples;
  std::vector<ProbeSample> path;
  for (int k = 0; k < 5000; ++k) {
    const double t = 0.001 * k;
    const Vec3 p{std::sin(t), -0.0, 0.3 * t};
    samples.push_back({t, p, 0});
    path.push_back({t, p, 0});
  }
  const auto program = program_at(0.5, 1);
  const ReplayStats stats = replay(*program, path, [](const HapticState&) { return true; });
  RecordedPath device(samples);
  Servo servo(device, program, {.rate_hz = 1000, .paced = false, .max_ticks = 5000});
  EXPECT_TRUE(servo.start());
  HapticState seen;
  while (servo.running()) servo.receive(seen);
  servo.stop();
  servo.receive(seen);
  EXPECT_EQ(servo.state_hash(), stats.state_hash);
  EXPECT_EQ(seen.tick, 5000u);
  EXPECT_EQ(device.forces_written(), 5001u) << "one a tick, and a last zero";
}

TEST(ServoDeathTest, TwoProgramsWithOneEpochFailAnAssertion) {
  GTEST_FLAG_SET(death_test_style, "threadsafe");
  SimulatedDevice hand({{0, {0, 0, 0.4}}}, {});
  Servo servo(hand, program_at(0.5, 1));
  servo.set_program(program_at(0.5, 2));
  EXPECT_DEATH(servo.set_program(program_at(0.6, 2)), "epoch") << "the frame side would free the one that runs";
}

TEST(Servo, NewProgramsTakeOverAndTheFrameSideFreesOldOnes) {
  SimulatedDevice hand({{0, {0, 0, 0.4}}}, {});
  Servo servo(hand, program_at(0.5, 1), {.rate_hz = 1000, .paced = false});
  EXPECT_TRUE(servo.start());
  HapticState seen;
  for (std::uint64_t epoch = 2; epoch <= 40; ++epoch) {
    servo.set_program(program_at(0.5 + 0.001 * static_cast<double>(epoch), epoch));
    while (seen.program_epoch != epoch) servo.receive(seen);
    EXPECT_EQ(servo.live_program_count(), 1u);
  }
  servo.stop();
  EXPECT_NEAR(seen.links[0].proxy.z, 0.54, 1e-12);
}

TEST(Servo, ASimulatedHandSettlesWhereItsGripBalancesTheForce) {
  // grip 500 N/m toward z = 0, link 500 N/m toward z = 0.01: the equilibrium is in the middle
  auto program = program_at(0.01, 1);
  program->coupling.damping_ns_per_m = 0;
  SimulatedDevice hand({{0, {0, 0, 0}}}, {.mass_kg = 0.15, .grip_stiffness_n_per_m = 500, .grip_damping_ns_per_m = 5, .period_s = 1e-3});
  Servo servo(hand, program, {.rate_hz = 1000, .paced = false, .max_ticks = 4000});
  test::run_to_end(servo);
  EXPECT_NEAR(hand.position_m().z, 0.005, 1e-6);
}

TEST(Replay, CountsTicksAndStopsWhenAsked) {
  std::vector<ProbeSample> path(100);
  for (std::size_t k = 0; k < path.size(); ++k) path[k].t_s = 0.001 * static_cast<double>(k);
  int calls = 0;
  const ReplayStats stats = replay(*program_at(0, 1), path, [&](const HapticState&) { return ++calls < 30; });
  EXPECT_EQ(stats.ticks, 30u);
  EXPECT_EQ(stats.evaluations_p50, 1);
}

}  // namespace catena::haptics::servo_test
