// SPDX-License-Identifier: MIT
/// The full haptic stack over the unmodified libusb within one process: forces to within half a motor count, and a hand that
/// pushes into the surface.
#include "tests/haptics/device/usbfs/full_stack_program.h"

#include <atomic>

#include "tests/haptics/device/usbfs/in_process_bus.h"
#include "tests/haptics/device/usbfs/wrap_source.h"

namespace catena::haptics::tests::full_stack_test {

TEST(FullStackInProcess, TheMotorForceMatchesTheTicksWithinHalfACount) {
  InProcessBus bus({.homed = true});
  auto falcon = open_wrapped_falcon(bus.fd());
  ServoRig catena(bus, *falcon, ball_program(), {.rate_hz = 4000});
  ASSERT_TRUE(catena.start());
  GripWalk walk;
  for (int i = 0; i < 300; ++i) catena.check(walk.next());
  EXPECT_GT(catena.held, 80);
  EXPECT_GT(catena.free, 80);
  // the bound is tight: some force deviates by more than a fifth of it
  EXPECT_GT(catena.worst_n, 0.2 * max_abs(force_quantum(kBallCenterM)));
}

TEST(FullStackInProcess, BetweenCountsTheProbeIsWithinAnEncoderStepOfTheGrip) {
  InProcessBus bus({.homed = true});
  auto falcon = open_wrapped_falcon(bus.fd());
  ServoRig catena(bus, *falcon, ball_program(), {.rate_hz = 4000});
  ASSERT_TRUE(catena.start());
  double worst_m = 0;
  for (int i = 0; i < 100; ++i) {
    const Vec3 grip = kBallCenterM + Vec3(0.0003 * i - 0.015, 0.01, 0.0001 * i);
    ASSERT_TRUE(hold_grip_at(bus, grip, 8));
    HapticState tick;
    ASSERT_TRUE(wait_until([&] {
      catena.servo().receive(tick);
      return norm(tick.probe - to_world(grip)) * 0.04 < encoder_quantum_m(grip);
    }));
    worst_m = std::max(worst_m, norm(tick.probe - to_world(grip)) * 0.04);
  }
  EXPECT_GT(worst_m, 1e-6) << "the encoders do step";
}

/// Records each change of the tick's force.
struct ForceRecorder final : TickSink {
  ForceRecorder() { forces.reserve(100000); }
  void put(const ProbeSample&, const HapticState& output) noexcept override {
    if (forces.size() < forces.capacity() && (forces.empty() || forces.back() != output.force_n)) forces.push_back(output.force_n);
    count.fetch_add(1);
  }
  /// Waits for two ticks, of which the second began after the call.
  void wait_for_two() const {
    const std::uint64_t from = count.load();
    while (count.load() < from + 2) std::this_thread::yield();
  }
  std::vector<Vec3> forces;
  std::atomic<std::uint64_t> count{0};
};

TEST(FullStackInProcess, APushingHandIsHeldByTheSurface) {
  InProcessBus bus({.homed = true, .seconds_per_frame = 5e-4});
  auto falcon = open_wrapped_falcon(bus.fd());
  ForceRecorder ticks;
  ServoRig catena(bus, *falcon, ball_program(), {.paced = false, .sink = &ticks});
  ASSERT_TRUE(catena.start());
  // the hand's target is 5 mm below the top of the ball
  const Vec3 top = kBallCenterM + Vec3(0, 0, kBallRadiusM), target = top - Vec3(0, 0, 0.005);
  EmulatedUser hand;
  hand.damping_ns_per_m = 12;
  hand.path = {{0, top + Vec3(0, 0, 0.005), 0}, {0.01, top + Vec3(0, 0, 0.005), 0}, {0.12, target, 0}};
  std::vector<EmulatedFalcon::Exchange> exchanges;
  exchanges.reserve(100000);
  bus.with([&](EmulatedFalcon& device) {
    device.mechanism().attach_user(hand);
    device.set_exchange_observer([&](const EmulatedFalcon::Exchange& exchange) {
      if (exchanges.size() < exchanges.capacity()) exchanges.push_back(exchange);
      // the mechanism waits for the servo, so that the delay is two or three frames on any machine
      ticks.wait_for_two();
    });
  });
  const double depth = 0.005 * hand.stiffness_n_per_m / (hand.stiffness_n_per_m + kBallStiffness);
  ASSERT_TRUE(wait_for_frames(bus, 600));
  // it rests where the hand's and the surface's forces are equal
  for (int i = 0; i < 10; ++i) {
    ASSERT_TRUE(wait_for_frames(bus, 5));
    bus.with([&](EmulatedFalcon& device) {
      const auto& last = device.last_exchange();
      EXPECT_NEAR(top.z - last.position_m.z, depth, 0.05e-3);
      EXPECT_NEAR(hand.stiffness_n_per_m * (target.z - last.position_m.z) + last.force_n.z, 0, 0.06) << "three encoder steps";
    });
  }
  bus.with([](EmulatedFalcon& device) { device.set_exchange_observer(nullptr); });
  catena.servo().stop();

  // each motor force equals the force of some tick
  double lowest = 1;
  int checked = 0;
  for (std::size_t k = 1; k < exchanges.size(); ++k) {
    lowest = std::min(lowest, exchanges[k].position_m.z);
    if (exchanges[k].motors == EmulatedMechanism::Counts{}) continue;
    const Vec3 bound = force_quantum(exchanges[k].position_m) + Vec3(2e-3 * norm(exchanges[k].force_n));
    const bool found = std::any_of(ticks.forces.begin(), ticks.forces.end(), [&](const Vec3& force) {
      return glm::all(glm::lessThanEqual(glm::abs(exchanges[k].force_n - force), bound));
    });
    EXPECT_TRUE(found) << "frame " << k;
    ++checked;
  }
  EXPECT_GT(checked, 50);
  EXPECT_LT(lowest, top.z);
  EXPECT_GT(lowest, target.z) << "it never got where it wanted";
}

}  // namespace catena::haptics::tests::full_stack_test
