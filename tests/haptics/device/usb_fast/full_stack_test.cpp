// SPDX-License-Identifier: MIT
/// The whole of the hand's side over the unmodified libusb within one process: forces to within half a motor count, a hand that
/// pushes into the surface and feels it.
#include "tests/haptics/device/usbfs/full_stack_program.h"

#include <atomic>

#include "tests/haptics/device/usbfs/in_process_bus.h"
#include "tests/haptics/device/usbfs/wrap_source.h"

namespace catena::haptics::tests {
namespace whole_catena_test {

TEST(FullStackInProcess, TheMotorsGetTheTicksForceToWithinHalfACount) {
  InProcessBus bus({.homed = true});
  auto falcon = open_wrapped_falcon(bus.fd());
  ASSERT_NE(falcon, nullptr);
  ServoRig catena(bus, *falcon, ball_program(), {.rate_hz = 4000});
  ASSERT_TRUE(catena.start());
  GripWalk walk;
  for (int i = 0; i < 300; ++i) catena.check(walk.next());
  EXPECT_GT(catena.held, 80);
  EXPECT_GT(catena.free, 80);
  // the bound is tight: some force is off by more than a fifth of it
  EXPECT_GT(catena.worst_n, 0.2 * max_abs(force_quantum(kBallCenterM)));
  RecordProperty("worst_force_error_mn", std::to_string(1e3 * catena.worst_n));
}

TEST(FullStackInProcess, BetweenCountsTheProbeIsWithinAnEncoderStepOfTheGrip) {
  InProcessBus bus({.homed = true});
  auto falcon = open_wrapped_falcon(bus.fd());
  ASSERT_NE(falcon, nullptr);
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

/// Every tick's force, kept where it changes.
struct KeptTicks final : TickSink {
  KeptTicks() { forces.reserve(100000); }
  void put(const ProbeSample&, const HapticState& output) noexcept override {
    if (forces.size() < forces.capacity() && (forces.empty() || forces.back() != output.force_n)) forces.push_back(output.force_n);
    count.fetch_add(1);
  }
  /// Two more ticks: the second has begun with all that was there before.
  void wait_for_two() const {
    const std::uint64_t from = count.load();
    while (count.load() < from + 2) std::this_thread::yield();
  }
  std::vector<Vec3> forces;
  std::atomic<std::uint64_t> count{0};
};

TEST(FullStackInProcess, AHandThatPushesInIsHeldByTheSurface) {
  InProcessBus bus({.homed = true, .seconds_per_frame = 5e-4});
  auto falcon = open_wrapped_falcon(bus.fd());
  ASSERT_NE(falcon, nullptr);
  KeptTicks ticks;
  ServoRig catena(bus, *falcon, ball_program(), {.paced = false, .sink = &ticks});
  ASSERT_TRUE(catena.start());
  // the hand wants to be 5 mm under the top of the ball
  const Vec3 top = kBallCenterM + Vec3(0, 0, kBallRadiusM), wish = top - Vec3(0, 0, 0.005);
  EmulatedUser hand;
  hand.damping_ns_per_m = 12;
  hand.path = {{0, top + Vec3(0, 0, 0.005), 0}, {0.01, top + Vec3(0, 0, 0.005), 0}, {0.12, wish, 0}};
  std::vector<EmulatedFalcon::Exchange> felt;
  felt.reserve(100000);
  bus.with([&](EmulatedFalcon& device) {
    device.mechanism().attach_user(hand);
    device.set_exchange_observer([&](const EmulatedFalcon::Exchange& exchange) {
      if (felt.size() < felt.capacity()) felt.push_back(exchange);
      // the mechanism's time waits for the servo's: a delay of two or three frames, however busy the machine is
      ticks.wait_for_two();
    });
  });
  const double depth = 0.005 * hand.stiffness_n_per_m / (hand.stiffness_n_per_m + kBallStiffness);
  ASSERT_TRUE(wait_for_frames(bus, 600));
  // it rests where the hand's pull and the surface's push are even
  for (int i = 0; i < 10; ++i) {
    ASSERT_TRUE(wait_for_frames(bus, 5));
    bus.with([&](EmulatedFalcon& device) {
      const auto& last = device.last_exchange();
      EXPECT_NEAR(top.z - last.position_m.z, depth, 0.05e-3);
      EXPECT_NEAR(hand.stiffness_n_per_m * (wish.z - last.position_m.z) + last.force_n.z, 0, 0.06) << "three encoder steps";
    });
  }
  bus.with([](EmulatedFalcon& device) { device.set_exchange_observer(nullptr); });
  catena.servo().stop();

  // what the motors did was some tick's force, all along the way
  double lowest = 1;
  int checked = 0;
  for (std::size_t k = 1; k < felt.size(); ++k) {
    lowest = std::min(lowest, felt[k].position_m.z);
    if (felt[k].motors == EmulatedMechanism::Counts{}) continue;
    const Vec3 bound = force_quantum(felt[k].position_m) + Vec3(2e-3 * norm(felt[k].force_n));
    bool found = false;
    for (std::size_t t = 0; t < ticks.forces.size() && !found; ++t) {
      const Vec3 off = felt[k].force_n - ticks.forces[t];
      found = std::fabs(off.x) <= bound.x && std::fabs(off.y) <= bound.y && std::fabs(off.z) <= bound.z;
    }
    EXPECT_TRUE(found) << "frame " << k;
    ++checked;
  }
  EXPECT_GT(checked, 50);
  EXPECT_LT(lowest, top.z);
  EXPECT_GT(lowest, wish.z) << "it never got where it wanted";
}

}  // namespace whole_catena_test
}  // namespace catena::haptics::tests
