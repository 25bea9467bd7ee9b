// SPDX-License-Identifier: MIT
// Whole scenes on the simulated device: the energy that a switch, a snap or a program change adds to the springs is accounted, the hand
// gets no more than that, and a trembling hand on a streamline through an isosurface is stable.
#include "haptics/device/registry.h"
#include "haptics/servo/device_limits.h"
#include "tests/acceptance/chain_fixture.h"
#include "tests/support/closed_loop.h"

namespace catena::acceptance::coupling_safety_test {

using haptics::SimulatedDeviceParameters;
using test::ClosedLoop;

haptics::DeviceLimits simulated_limits(double cap = 0) {
  haptics::DeviceSettings settings;
  if (cap > 0) {
    settings.stiffness_cap = haptics::DeviceSettings::StiffnessCap::value;
    settings.stiffness_cap_n_per_m = cap;
  }
  settings.ramp_in_s = 0;
  return compute_device_limits(haptics::nominal_capabilities("simulated"), settings);
}

HapticProgram limited(const std::string& scene, const haptics::DeviceLimits& limits) {
  HapticProgram p = *make_program(scene);
  p.limits = limits;
  return p;
}

/// The mechanism without a hand: its energy gain equals the energy that it was given.
SimulatedDeviceParameters without_hand() {
  SimulatedDeviceParameters p = haptics::desktop_device_parameters();
  p.grip_stiffness_n_per_m = p.grip_damping_ns_per_m = p.friction_n = p.encoder_step_m = 0;
  p.max_force_n = 1e6;
  return p;
}

haptics::DeviceLimits above_the_limit(bool passivity) {
  haptics::DeviceLimits l = simulated_limits(4000);
  l.passivity_control = passivity;
  l.max_force_n = l.slew_n_per_s = haptics::DeviceLimits::kUnlimited;
  return l;
}

std::string pin_at(double x) {
  return R"({"coupling": {"stiffness": 4000, "max_force": 1e6}, "chain": [{"name": "pin", "type": "point", "position": [)" +
         std::to_string(x) + ", 0, 0]}]}";
}

double max_kinetic_of(ClosedLoop& loop, int ticks) {
  double maximum = 0;
  for (int i = 0; i < ticks; ++i) {
    loop.step();
    maximum = std::max(maximum, loop.kinetic_j());
  }
  return maximum;
}

TEST(CouplingSafety, AProgramChangeGivesNoMoreThanItsAccountedEnergy) {
  for (const bool passivity : {false, true}) {
    const HapticProgram here = limited(pin_at(0), above_the_limit(passivity)), there = limited(pin_at(0.02), above_the_limit(passivity));
    ClosedLoop loop(here, without_hand());
    EXPECT_EQ(max_kinetic_of(loop, 500), 0);
    EXPECT_EQ(loop.state->passivity.exempt_j, 0);
    loop.switch_program(there);
    loop.step();
    const double booked = loop.state->passivity.exempt_j;
    EXPECT_NEAR(booked, 0.5 * 4000 * 0.02 * 0.02, 1e-9);
    const double maximum = max_kinetic_of(loop, 3000);
    EXPECT_NEAR(loop.state->passivity.exempt_j, booked, 1e-9) << "once";
    if (passivity) {
      EXPECT_LE(maximum, 1.001 * booked);
    } else {
      EXPECT_GT(maximum, 100 * booked) << "the same spring without the controller";
    }
  }
}

TEST(CouplingSafety, ASnapGivesNoMoreThanItsAccountedEnergy) {
  const std::string scene = R"({"coupling": {"stiffness": 4000, "max_force": 1e6},
    "chain": [{"name": "pin", "type": "point", "position": [0, 0, 0], "snap": 0.01, "release": 0.03}]})";
  const HapticProgram p = limited(scene, above_the_limit(true));
  SimulatedDeviceParameters moving = without_hand();
  moving.velocity_m_per_s = {-0.1, 0, 0};
  ClosedLoop loop(p, moving, {{0, {0.02, 0, 0}}});
  const double brought = loop.kinetic_j();
  const double maximum = max_kinetic_of(loop, 4000);
  const double booked = loop.state->passivity.exempt_j;
  EXPECT_NEAR(booked, 0.5 * 4000 * 0.01 * 0.01, 0.03 * 0.2) << "within a tick's way of the snap";
  EXPECT_GT(booked, 0.15);
  EXPECT_TRUE(loop.out.links[0].active);
  EXPECT_LE(maximum, 1.001 * (booked + brought));
}

TEST(CouplingSafety, EachModeSwitchUnderLoadIsAccounted) {
  const std::string scene = R"({"coupling": {"stiffness": 4000, "max_force": 1e6, "ramp_s": 0.02},
    "chain": [{"name": "a", "type": "point", "position": [0, 0, 0]}, {"name": "b", "type": "point", "position": [0.01, 0, 0]}],
    "modes": [{"name": "first", "links": ["a"], "active_when": {"button": 1}}, {"name": "second", "links": ["b"], "active_when": {"button": 2}}]})";
  const HapticProgram p = limited(scene, above_the_limit(true));
  std::vector<haptics::SimulatedDevice::Waypoint> path;
  for (int k = 0; k < 20; ++k) path.push_back({0.1 * k, Vec3(0.0), k % 2 == 0 ? 1u : 2u});
  SimulatedDeviceParameters slack = without_hand();
  slack.grip_damping_ns_per_m = 5;  // a hand with damping and without stiffness
  ClosedLoop loop(p, slack, path);
  double before = 0;
  for (int k = 0; k < 20; ++k) {
    const double maximum = max_kinetic_of(loop, 100), granted = loop.state->passivity.exempt_j;
    if (k > 0) {
      EXPECT_GT(granted, before) << "switch " << k;
    }
    EXPECT_LE(maximum, 1.01 * granted) << "switch " << k;
    before = granted;
  }
  EXPECT_LT(before, 20 * 4 * 0.5 * 4000 * 1e-4) << "no more than the switches could";
}

std::string chain_scene(int stiffness) {
  return R"({"fields": {"v": {"analytic": "circle"}, "s": {"analytic": "sphere"}},
  "chain": [{"name": "curve", "type": "streamline", "field": "v", "seed": [0.05, 0, 0]},
            {"name": "surface", "type": "isosurface", "field": "s", "level": 0.045, "free": "below"}],
  "coupling": {"stiffness": )" +
         std::to_string(stiffness) + R"(, "max_force": 8, "ramp_s": 0.02}})";
}

/// A trembling hand that follows the circle, 1 cm inside and 3 mm above it: maximum energies and forces.
struct Extremes {
  double max_kinetic_j = 0, dissipated_j = 0, peak_force_n = 0, min_energy_j = 0;
};
Extremes follow(const HapticProgram& p) {
  std::vector<haptics::SimulatedDevice::Waypoint> path;
  for (int k = 0; k <= 300; ++k) {
    const double a = 2 * M_PI * k / 300;
    path.push_back({0.01 * k, {0.04 * std::cos(a), 0.04 * std::sin(a), 0.003}});
  }
  SimulatedDeviceParameters hand = haptics::desktop_device_parameters();
  hand.grip_stiffness_n_per_m = 150;
  hand.grip_damping_ns_per_m = 1;
  hand.tremor_m = 1e-4;
  ClosedLoop loop(p, hand, path);
  loop.run(500);
  Extremes result;
  for (int k = 0; k < 3000; ++k) {
    loop.step();
    result.max_kinetic_j = std::max(result.max_kinetic_j, loop.kinetic_j());
    result.peak_force_n = std::max(result.peak_force_n, norm(loop.out.force_n));
    result.min_energy_j = std::min(result.min_energy_j, loop.out.energy_j);
  }
  result.dissipated_j = loop.out.dissipated_j;
  return result;
}

TEST(CouplingSafety, ATremblingHandOnTheChainIsStable) {
  const double own_j = 0.5 * 0.159 * 0.084 * 0.084;  // kinetic energy of the hand's motion
  // with the default limits a scene with a too large stiffness gets the safe one
  const Extremes safe = follow(limited(chain_scene(20000), simulated_limits()));
  EXPECT_LT(safe.max_kinetic_j, 8 * own_j);
  EXPECT_LE(safe.peak_force_n, 8 + 1e-12);
  EXPECT_GT(safe.peak_force_n, 0.5);
  EXPECT_GT(safe.min_energy_j, -1e-3);

  // without limits the hand shakes up to the maximum force; the controller alone suppresses that
  haptics::DeviceLimits none;
  const Extremes shaken = follow(limited(chain_scene(20000), none));
  EXPECT_GT(shaken.max_kinetic_j, 20 * own_j);
  const Extremes controlled = follow(limited(chain_scene(20000), simulated_limits(20000)));
  EXPECT_LT(controlled.max_kinetic_j, 0.2 * shaken.max_kinetic_j);
  EXPECT_GT(controlled.dissipated_j, 0);
}

TEST(CouplingSafety, IsRepeatableBitForBit) {
  const HapticProgram p = limited(chain_scene(3000), simulated_limits(3000));
  const Extremes a = follow(p), b = follow(p);
  EXPECT_EQ(a.max_kinetic_j, b.max_kinetic_j);
  EXPECT_EQ(a.dissipated_j, b.dissipated_j);
  EXPECT_EQ(a.min_energy_j, b.min_energy_j);
}

}  // namespace catena::acceptance::coupling_safety_test
