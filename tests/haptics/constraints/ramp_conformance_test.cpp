// SPDX-License-Identifier: MIT
// The bound of haptics/chain/ramp.h for every constraint and every cause of a step: no tick changes the force by more than
// K |dx| + max_force dt / ramp_s.
#include "tests/haptics/chain/chain_driver.h"
#include "tests/haptics/constraints/examples.h"

namespace catena::haptics::tests::ramp_conformance_test {

enum Cause { motion, fast, thrown, switched, reordered, replaced, lost, kCauses };
constexpr const char* kNames[]{"slow hand", "10 m/s", "thrown", "switch", "mode", "program", "device lost"};

using catena::test::ChainDriver;

/// A chain of the example and a plane.
ChainDriver chain_of(const ConstraintPtr& example, double stiffness, double ramp_s) {
  ChainDriver hand;
  hand.program.coupling = {};
  hand.add(example, stiffness);
  hand.add(build(R"({"name": "b", "type": "plane", "point": [0.1, 0.2, 0], "normal": [1, -1, 2]})"), 150);
  hand.program.modes = {{"other", {1, 0}, {.button = 2}}, {"without", {1}, {.button = 1}}};
  hand.program.coupling.ramp_s = ramp_s;
  return hand;
}

/// The largest step of the force, in units of the bound.
double worst(const ConstraintPtr& example, Cause cause, double rate, std::uint64_t seed) {
  const double dt = 1 / rate, ramp_s = seed % 2 == 0 ? 0.02 : 0.05;
  ChainDriver hand = chain_of(example, 500, ramp_s);
  HapticProgram other = chain_of(example, 200, ramp_s).program;
  Random random(seed);
  Vec3 at = random.box(0.9), way = random.unit();
  double maximum = 0;
  std::uint32_t buttons = 0;
  for (int i = 0; i < 400; ++i) {
    const Vec3 last = at, force = hand.out.force_n;
    if (cause == thrown && i % 40 == 0) at = random.box(1.5);
    if (cause == motion || cause == fast) {
      way = direction(way + random.unit() * 0.2 - at * 0.1);
      at += way * ((cause == fast ? 10 : 0.3) * dt);
    }
    if (cause == switched && i % 30 == 29) buttons ^= 1;
    if (cause == reordered && i % 30 == 29) buttons ^= 2;
    if (cause == replaced && i % 30 == 29) {
      const HapticProgram last_program = hand.program;
      hand.replace(other);
      other = last_program;
    }
    const bool gone = cause == lost && i % 50 == 49;
    hand.at(hand.t + dt, at, buttons, kIdentityRotation, gone ? TickCondition::no_device : TickCondition::normal);
    if (i == 0 || gone) continue;
    double k = 0;
    for (const Link& link : hand.program.links) k += link.stiffness_n_per_m.max();
    const double bound = k * norm(at - last) + hand.program.coupling.max_force_n * dt / ramp_s;
    maximum = std::max(maximum, (norm(hand.out.force_n - force) - 1e-12) / bound);
  }
  return maximum;
}

TEST(RampConformance, BoundsTheForceStepForEveryConstraintAndCause) {
  std::uint64_t seed = 1;
  for (const auto& [type, bodies] : examples())
    for (std::string body : bodies)
      for (const bool snaps : {false, true}) {
        if (snaps && body.find("release") == std::string::npos) body += R"(, "snap": 0.1, "release": 0.3)";
        const ConstraintPtr made = build_example(type, body);
        for (int cause = 0; cause < kCauses; ++cause) {
          const double rate = std::array{100.0, 1000.0, 8000.0}[++seed % 3];
          EXPECT_LE(worst(made, static_cast<Cause>(cause), rate, seed), 1 + 1e-9) << type << " " << body << ": " << kNames[cause];
        }
      }
}

}  // namespace catena::haptics::tests::ramp_conformance_test
