// SPDX-License-Identifier: MIT
// The bound of haptics/chain/ramp.h for every constraint and every cause of a step: no tick changes the force by more than
// K |dx| + max_force dt / ramp_s. Prints a table of the largest steps by type and cause, in units of that bound.
#include "haptics/chain/tick.h"
#include "tests/haptics/constraints/examples.h"

namespace catena::haptics::tests {
namespace ramp_conformance_test {

enum Cause { motion, fast, thrown, switched, reordered, replaced, lost, kCauses };
constexpr std::array<const char*, kCauses> kNames{"slow hand", "10 m/s", "thrown", "switch", "mode", "program", "device lost"};

struct Hand {
  HapticProgram program;
  ChainState state;
  ChainScratch scratch;
  HapticState out;
  double t = 0;

  void step(const Vec3& probe, double dt, std::uint32_t buttons = 0, TickCondition condition = TickCondition::normal) {
    ProbeSample sample{.t_s = t += dt, .position = probe, .buttons = buttons};
    sample.condition = condition;
    tick(program, sample, state, scratch, out);
  }
};

/// A chain of the example and a plane.
HapticProgram program_of(const ConstraintPtr& example, double stiffness, double ramp_s) {
  HapticProgram program;
  Link first, second;
  first.name = "a";
  first.constraint = example;
  first.stiffness_n_per_m = stiffness;
  second.name = "b";
  second.constraint = build(R"({"name": "b", "type": "plane", "point": [0.1, 0.2, 0], "normal": [1, -1, 2]})");
  second.stiffness_n_per_m = 150;
  program.links = {first, second};
  program.modes = {{"other", {1, 0}, {.button = 2}}, {"without", {1}, {.button = 1}}};
  program.coupling.ramp_s = ramp_s;
  return program;
}

/// The largest step of the force, in units of the bound.
double worst(const ConstraintPtr& example, Cause cause, double rate, std::uint64_t seed) {
  const double dt = 1 / rate, ramp_s = seed % 2 == 0 ? 0.02 : 0.05;
  Hand hand;
  hand.program = program_of(example, 500, ramp_s);
  HapticProgram other = program_of(example, 200, ramp_s);
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
      rebind_program(hand.program, other, hand.state, hand.scratch);
      std::swap(hand.program, other);
    }
    const bool gone = cause == lost && i % 50 == 49;
    hand.step(at, dt, buttons, gone ? TickCondition::no_device : TickCondition::normal);
    if (i == 0 || gone) continue;
    double k = 0;
    for (const Link& link : hand.program.links) k += link.stiffness_n_per_m.max();
    const double bound = k * norm(at - last) + hand.program.coupling.max_force_n * dt / ramp_s;
    maximum = std::max(maximum, (norm(hand.out.force_n - force) - 1e-12) / bound);
  }
  return maximum;
}

TEST(RampConformance, BoundsTheForceStepForEveryConstraintAndCause) {
  std::printf("%-20s", "constraint");
  for (const char* name : kNames) std::printf("%12s", name);
  std::printf("\n");
  std::uint64_t seed = 1;
  for (const auto& [type, bodies] : examples()) {
    std::array<double, kCauses> largest{};
    for (std::string body : bodies)
      for (const bool snaps : {false, true}) {
        if (snaps && body.find("release") == std::string::npos) body += R"(, "snap": 0.1, "release": 0.3)";
        const ConstraintPtr made = build(R"({"name": "a", "type": ")" + type + "\", " + body + "}", fields());
        for (int cause = 0; cause < kCauses; ++cause) {
          const double rate = std::array{100.0, 1000.0, 8000.0}[++seed % 3];
          double& maximum = largest[static_cast<std::size_t>(cause)];
          maximum = std::max(maximum, worst(made, static_cast<Cause>(cause), rate, seed));
        }
      }
    std::printf("%-20s", type.c_str());
    for (int cause = 0; cause < kCauses; ++cause) {
      const double maximum = largest[static_cast<std::size_t>(cause)];
      std::printf("%12.3f", maximum);
      EXPECT_LE(maximum, 1 + 1e-9) << type << ": " << kNames[static_cast<std::size_t>(cause)];
    }
    std::printf("\n");
  }
}

}  // namespace ramp_conformance_test
}  // namespace catena::haptics::tests
