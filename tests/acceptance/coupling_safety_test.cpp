// SPDX-License-Identifier: MIT
// Whole scenes on the simulated device: what a switch, a snap or another program puts into the springs is booked, the hand gets
// no more than that, and a trembling hand on a streamline through an isosurface feels no shaking.
#include "haptics/device/registry.h"
#include "haptics/servo/device_limits.h"
#include "tests/acceptance/chain_fixture.h"
#include "tests/support/closed_loop.h"

namespace catena::acceptance {
namespace coupling_safety_test {

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

/// The mechanism alone, no hand: what it gains is what it was given.
SimulatedDeviceParameters nobody() {
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

double most_kinetic(ClosedLoop& loop, int ticks) {
  double most = 0;
  for (int i = 0; i < ticks; ++i) {
    loop.step();
    most = std::max(most, loop.kinetic_j());
  }
  return most;
}

TEST(CouplingSafety, AnotherProgramIsBookedAndGivesNoMore) {
  for (const bool passivity : {false, true}) {
    const HapticProgram here = limited(pin_at(0), above_the_limit(passivity)), there = limited(pin_at(0.02), above_the_limit(passivity));
    ClosedLoop loop(here, nobody());
    EXPECT_EQ(most_kinetic(loop, 500), 0);
    EXPECT_EQ(loop.state->passivity.exempt_j, 0);
    loop.switch_program(there);
    loop.step();
    const double booked = loop.state->passivity.exempt_j;
    EXPECT_NEAR(booked, 0.5 * 4000 * 0.02 * 0.02, 1e-9);
    const double most = most_kinetic(loop, 3000);
    EXPECT_NEAR(loop.state->passivity.exempt_j, booked, 1e-9) << "once";
    if (passivity) {
      EXPECT_LE(most, 1.001 * booked);
    } else {
      EXPECT_GT(most, 100 * booked) << "the same spring without the controller";
    }
  }
}

TEST(CouplingSafety, ASnapIsBookedAndGivesNoMore) {
  const std::string scene = R"({"coupling": {"stiffness": 4000, "max_force": 1e6},
    "chain": [{"name": "pin", "type": "point", "position": [0, 0, 0], "snap": 0.01, "release": 0.03}]})";
  const HapticProgram p = limited(scene, above_the_limit(true));
  SimulatedDeviceParameters moving = nobody();
  moving.velocity_m_per_s = {-0.1, 0, 0};
  ClosedLoop loop(p, moving, {{0, {0.02, 0, 0}}});
  const double brought = loop.kinetic_j();
  const double most = most_kinetic(loop, 4000);
  const double booked = loop.state->passivity.exempt_j;
  EXPECT_NEAR(booked, 0.5 * 4000 * 0.01 * 0.01, 0.03 * 0.2) << "within a tick's way of the snap";
  EXPECT_GT(booked, 0.15);
  EXPECT_TRUE(loop.out.links[0].active);
  EXPECT_LE(most, 1.001 * (booked + brought));
}

TEST(CouplingSafety, ModesThatSwitchWhileTheHandIsHeldBookEachSwitch) {
  const std::string scene = R"({"coupling": {"stiffness": 4000, "max_force": 1e6, "ramp_s": 0.02},
    "chain": [{"name": "a", "type": "point", "position": [0, 0, 0]}, {"name": "b", "type": "point", "position": [0.01, 0, 0]}],
    "modes": [{"name": "first", "links": ["a"], "active_when": {"button": 1}}, {"name": "second", "links": ["b"], "active_when": {"button": 2}}]})";
  const HapticProgram p = limited(scene, above_the_limit(true));
  std::vector<haptics::SimulatedDevice::Waypoint> path;
  for (int k = 0; k < 20; ++k) path.push_back({0.1 * k, Vec3(0.0), k % 2 == 0 ? 1u : 2u});
  SimulatedDeviceParameters slack = nobody();
  slack.grip_damping_ns_per_m = 5;  // a hand that damps, and wants nowhere
  ClosedLoop loop(p, slack, path);
  double before = 0;
  for (int k = 0; k < 20; ++k) {
    const double most = most_kinetic(loop, 100), granted = loop.state->passivity.exempt_j;
    if (k > 0) {
      EXPECT_GT(granted, before) << "switch " << k;
    }
    EXPECT_LE(most, 1.01 * granted) << "switch " << k;
    before = granted;
  }
  EXPECT_LT(before, 20 * 4 * 0.5 * 4000 * 1e-4) << "no more than the switches could";
}

constexpr const char* kChain = R"({"fields": {"v": {"analytic": "circle"}, "s": {"analytic": "sphere"}},
  "chain": [{"name": "curve", "type": "streamline", "field": "v", "seed": [0.05, 0, 0]},
            {"name": "surface", "type": "isosurface", "field": "s", "level": 0.045, "free": "below"}],
  "coupling": {"stiffness": STIFF, "max_force": 8, "ramp_s": 0.02}})";

std::string chain_scene(int stiffness) {
  std::string text = kChain;
  return text.replace(text.find("STIFF"), 5, std::to_string(stiffness));
}

/// A trembling hand that follows the circle, 1 cm inside it, 3 mm above: most of the kinetic energy beyond its own way.
struct Felt {
  double most_j = 0, dissipated_j = 0, most_force_n = 0, least_energy_j = 0;
};
Felt follow(const HapticProgram& p) {
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
  Felt felt;
  for (int k = 0; k < 3000; ++k) {
    loop.step();
    felt.most_j = std::max(felt.most_j, loop.kinetic_j());
    felt.most_force_n = std::max(felt.most_force_n, norm(loop.out.force_n));
    felt.least_energy_j = std::min(felt.least_energy_j, loop.out.energy_j);
  }
  felt.dissipated_j = loop.out.dissipated_j;
  return felt;
}

TEST(CouplingSafety, ATremblingHandOnTheChainFeelsNoShaking) {
  const double own_j = 0.5 * 0.159 * 0.084 * 0.084;  // of its way around
  // the default limits: a scene that asks for too much gets the safe stiffness
  const Felt safe = follow(limited(chain_scene(20000), simulated_limits()));
  EXPECT_LT(safe.most_j, 8 * own_j);
  EXPECT_LE(safe.most_force_n, 8 + 1e-12);
  EXPECT_GT(safe.most_force_n, 0.5);
  EXPECT_GT(safe.least_energy_j, -1e-3);

  // without any: it shakes as hard as the force allows; the controller alone quiets that
  haptics::DeviceLimits none;
  const Felt shaken = follow(limited(chain_scene(20000), none));
  EXPECT_GT(shaken.most_j, 20 * own_j);
  const Felt controlled = follow(limited(chain_scene(20000), simulated_limits(20000)));
  EXPECT_LT(controlled.most_j, 0.2 * shaken.most_j);
  EXPECT_GT(controlled.dissipated_j, 0);
}

TEST(CouplingSafety, TheSameBitsAgain) {
  const HapticProgram p = limited(chain_scene(3000), simulated_limits(3000));
  const Felt a = follow(p), b = follow(p);
  EXPECT_EQ(a.most_j, b.most_j);
  EXPECT_EQ(a.dissipated_j, b.dissipated_j);
  EXPECT_EQ(a.least_energy_j, b.least_energy_j);
}

}  // namespace coupling_safety_test
}  // namespace catena::acceptance
