// SPDX-License-Identifier: MIT
/// A tracker with sparse, late and lost samples, against a hand whose position is known at every tick.
#include "haptics/device/controller.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "haptics/servo/device_limits.h"
#include "haptics/servo/servo_tick.h"
#include "tests/support/simple_links.h"

namespace catena::haptics::controller_test {

std::int64_t clock_ns = 0;
constexpr std::int64_t kTick_ns = 1'000'000;

struct Rig {
  Rig() { clock_ns = 1'000'000'000'000; }
  TrackedController controller{{.clock = [] { return clock_ns; }}};
  DeviceInput tick() {
    clock_ns += kTick_ns;
    return controller.read();
  }
};

/// Position of an oscillating hand with a maximum speed of 0.63 m/s.
Vec3 hand_at(std::int64_t t_ns) {
  const double t = 1e-9 * static_cast<double>(t_ns - 1'000'000'000'000);
  return {0.1 * std::sin(2 * M_PI * t), 0.02 * std::sin(7 * t), 0.3};
}
Quat turn_at(std::int64_t t_ns) { return rotation_from_vector({0, 10 * hand_at(t_ns).x, 0}); }

TEST(Controller, InterpolatesSparseSamplesSmoothly) {
  for (const double hz : {60.0, 90.0, 120.0, 500.0}) {
    Rig rig;
    std::mt19937 random(3);
    std::uniform_real_distribution<double> late(0, 0.3), lost(0, 1);
    double next = 0, max_step_m = 0, max_turn = 0, off_m = 0;
    Vec3 last(0.0);
    Quat last_turn = kIdentityRotation;
    for (int k = 0; k < 4000; ++k) {
      // samples are late by up to a third of their interval, and one in twenty is lost
      if (1e-3 * k >= next) {
        if (lost(random) > 0.05) rig.controller.push_pose({clock_ns, hand_at(clock_ns), turn_at(clock_ns)});
        next = (std::floor(next * hz + 1e-6) + 1 + late(random)) / hz;
      }
      const DeviceInput input = rig.tick();
      ASSERT_EQ(input.status, DeviceStatus::ready);
      if (k > 500) {
        max_step_m = std::max(max_step_m, norm(input.position_m - last));
        max_turn = std::max(max_turn, norm(rotation_vector(normalized(input.orientation * glm::conjugate(last_turn)))));
        // distance from the hand's path: the minimum over the last 100 ms
        double off = 1;
        for (int back = 0; back < 100; ++back) off = std::min(off, norm(input.position_m - hand_at(clock_ns - back * kTick_ns)));
        off_m = std::max(off_m, off);
      }
      last = input.position_m;
      last_turn = input.orientation;
    }
    // the hand moves up to 0.65 mm per tick; raw samples at 60 Hz step by 10 mm
    EXPECT_LT(max_step_m, 1.25 * 0.66e-3) << hz << " Hz";
    EXPECT_LT(max_turn, 1.25 * 6.4e-3) << hz << " Hz";
    EXPECT_LT(off_m, hz < 100 ? 2e-3 : 1e-3) << hz << " Hz";
  }
}

/// In pauses of 80 ms of the tracker the position waits, then catches up at most a quarter faster than the hand moved.
TEST(Controller, APauseOfTheTrackerCausesNoJump) {
  for (const double hz : {60.0, 120.0, 1000.0}) {
    Rig rig;
    double next = 0, max_step_m = 0;
    Vec3 last(0.0);
    for (int k = 0; k < 3000; ++k) {
      if (1e-3 * k >= next) {
        rig.controller.push_pose({clock_ns, Vec3(5e-4 * k, 0, 0), kIdentityRotation});
        next = (k % 500 >= 400 && k % 500 < 420 ? 0.08 : 0) + 1e-3 * k + 1 / hz;
      }
      const DeviceInput input = rig.tick();
      ASSERT_EQ(input.status, DeviceStatus::ready);
      if (k > 100) max_step_m = std::max(max_step_m, norm(input.position_m - last));
      last = input.position_m;
    }
    EXPECT_LT(max_step_m, 1.251 * 5e-4) << hz << " Hz";
  }
}

TEST(Controller, AStillHandComesToRestExactly) {
  Rig rig;
  for (int k = 0; k < 300; ++k) {
    if (k % 11 == 0) rig.controller.push_pose({clock_ns, Vec3(0.1, 0.2, 0.3), turn_at(clock_ns), TrackedController::kGrab});
    rig.tick();
  }
  const DeviceInput input = rig.tick();
  EXPECT_EQ(input.position_m, Vec3(0.1, 0.2, 0.3));
  EXPECT_EQ(input.buttons, TrackedController::kGrab);
}

TEST(Controller, IsLostBySilenceOrStatusAndReturnsAtItsNewPosition) {
  Rig rig;
  EXPECT_EQ(rig.tick().status, DeviceStatus::starting);
  rig.controller.push_pose({clock_ns, Vec3(0.1)});
  for (int k = 0; k < 99; ++k) EXPECT_EQ(rig.tick().status, DeviceStatus::ready);
  rig.tick();
  EXPECT_EQ(rig.tick().status, DeviceStatus::lost) << "silent for more than 100 ms";
  rig.controller.push_pose({clock_ns, Vec3(0.5)});
  EXPECT_EQ(rig.tick().position_m, Vec3(0.5)) << "not on the way from where it was";
  rig.controller.push_pose({clock_ns, {}, kIdentityRotation, 0, false});
  EXPECT_EQ(rig.tick().status, DeviceStatus::lost) << "by word";
  for (int k = 0; k < 20; ++k) rig.tick();
  rig.controller.push_pose({clock_ns, Vec3(0.9)});
  const DeviceInput found = rig.tick();
  EXPECT_EQ(found.status, DeviceStatus::ready);
  EXPECT_EQ(found.position_m, Vec3(0.9));
  rig.controller.push_pose({clock_ns, Vec3(NAN)});
  rig.controller.push_pose({clock_ns - 50'000'000, Vec3(7.0)});
  EXPECT_EQ(rig.tick().position_m, Vec3(0.9)) << "not a number, and older than what is known";
}

TEST(Controller, AfterAReturnTheForceRampsInWithoutAVibration) {
  Rig rig;
  HapticProgram program;
  program.links = {test::hold_height("plane", 0)};
  program.limits = compute_device_limits(rig.controller.capabilities(), {});
  EXPECT_EQ(program.limits.ramp_in_s, 0.5);
  ServoStepper stepper(rig.controller, program, 1000);
  const auto at = [&](const Vec3& place) {
    rig.controller.push_pose({clock_ns, place});
    clock_ns += kTick_ns;
    return stepper.step();
  };
  for (int k = 0; k < 1000; ++k) at({0, 0, -0.001});
  EXPECT_NEAR(at({0, 0, -0.001}).force_n.z, 0.5, 1e-9);
  rig.controller.peaks().take_peaks();
  for (int k = 0; k < 300; ++k) {
    clock_ns += kTick_ns;
    const Vec3 force = stepper.step().force_n;
    EXPECT_TRUE(k <= 100 || force == Vec3(0.0)) << "silent for so long";
  }
  rig.controller.peaks().take_peaks();
  // returned deep below the plane: the link's force is 5 N
  double last = 0, max_step = 0;
  for (int k = 0; k < 600; ++k) {
    const double force = at({0, 0, -0.01}).force_n.z;
    max_step = std::max(max_step, force - last);
    last = force;
  }
  EXPECT_NEAR(last, 5, 1e-9);
  EXPECT_LT(max_step, 5 / 500.0 * 1.01);
  EXPECT_LT(rig.controller.peaks().take_peaks().change_n, 5 / 0.5 * PeakDetector::kTau_s * 1.01)
      << "the slope of the ramp, no contact of 5 N";
}

}  // namespace catena::haptics::controller_test
