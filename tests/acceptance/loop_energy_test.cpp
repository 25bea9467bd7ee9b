// SPDX-License-Identifier: MIT
// The passivity controller on the simulated device: energy gain of loops of the hand from two planes at 45 degrees, beyond the device's
// damping, for every coupling method and 1 to 5 loops per second.
#include <gtest/gtest.h>

#include "engine/scene/scene.h"
#include "haptics/build/build_program.h"
#include "tests/support/closed_loop.h"

namespace loop_energy_test {

using namespace catena;
using namespace catena::haptics;

constexpr double kRadius_m = 0.012, kSpring = 400;

/// Energy in J per lap given to the hand beyond the device's damping, mean of the laps after the second; `way`: direction of the loop.
double gain_of_a_lap(const std::string& method, double loops_a_second, double way, bool controlled) {
  auto scene = scene::parse_scene(R"({"chain": [{"name": "a", "type": "plane", "point": [0, 0, 0], "normal": [0, 0, 1]},
      {"name": "b", "type": "plane", "point": [0, 0, 0], "normal": [1, 0, 1]}],
    "coupling": {"stiffness": 400, "max_force": 100, "method": ")" +
                                      method + "\"}}",
                                  "loop.json");
  EXPECT_TRUE(scene);
  DeviceLimits limits;
  limits.passivity_control = controlled;
  const SimulatedDeviceParameters hand = [] {
    SimulatedDeviceParameters p = desktop_device_parameters();
    p.encoder_step_m = p.friction_n = 0;
    p.max_force_n = 100;
    return p;
  }();
  limits.damping_ns_per_m = hand.device_damping_ns_per_m;
  limits.max_added_damping_ns_per_m = 0.25 * hand.mass_kg / hand.period_s;
  auto program = build_program(*scene, limits);
  EXPECT_TRUE(program);
  const int ticks = static_cast<int>(1 / (loops_a_second * hand.period_s));
  const auto hand_target = [&](int k) {
    const double u = way * 2 * 3.14159265358979 * k / ticks;
    return Vec3(kRadius_m * std::cos(u), 0, kRadius_m * std::sin(u));
  };
  test::ClosedLoop loop(**program, hand, {{0, hand_target(0)}});
  double before = 0;
  constexpr int kLaps = 12, kFirst = 2;
  for (int k = 0; k < kLaps * ticks; ++k) {
    if (k == kFirst * ticks) before = loop.energy_to_device_j - loop.energy_damped_j;
    loop.device.set_target(hand_target(k));
    loop.step();
  }
  return (loop.energy_to_device_j - loop.energy_damped_j - before) / (kLaps - kFirst);
}

TEST(LoopEnergy, TheControllerAbsorbsTheEnergyGainOfLoops) {
  const double unit = kSpring * kRadius_m * kRadius_m;
  std::printf("%-9s%10s%14s%14s\n", "method", "loops/s", "free", "controlled");
  double maximum = 0;
  for (const char* method : {"chain", "pipe", "balance", "closest", "linear"})
    for (const double loops : {1.0, 2.0, 5.0}) {
      double free = -1, controlled = -1;
      for (const double way : {1.0, -1.0}) {
        free = std::max(free, gain_of_a_lap(method, loops, way, false) / unit);
        controlled = std::max(controlled, gain_of_a_lap(method, loops, way, true) / unit);
      }
      std::printf("%-9s%10.0f%14.4f%14.4f\n", method, loops, free, controlled);
      maximum = std::max(maximum, free);
      EXPECT_LE(controlled, 1e-3) << method << " at " << loops;
    }
  EXPECT_GT(maximum, 0.02) << "without the controller a loop gains";
}

}  // namespace loop_energy_test
