// SPDX-License-Identifier: MIT
#include "haptics/chain/tick.h"

#include <gtest/gtest.h>

#include <cstring>
#include <limits>

#include "engine/base/memory_limit.h"
#include "haptics/chain/state_hash.h"
#include "tests/support/simple_links.h"

namespace tick_test {

using namespace catena;
using namespace catena::haptics;
using test::hold_height;

struct Hand {
  HapticProgram program;
  ChainState state;
  ChainScratch scratch;
  HapticState out;
  void step(double t, const Vec3& p, std::uint32_t buttons = 0) { tick(program, {t, p, buttons}, state, scratch, out); }
};

TEST(Tick, EqualStiffnessTelescopesToTheLastProxy) {
  Hand run;
  run.program.links = {hold_height("a", 1), hold_height("b", 3), hold_height("c", 2)};
  run.program.meters_per_unit = 0.5;
  run.program.coupling.max_force_n = 1e9;
  run.step(0, {0.25, 0.5, 0});
  EXPECT_DOUBLE_EQ(run.out.force_n.z, 500 * 0.5 * 2.0);
  EXPECT_EQ(run.out.force_n.x, 0);
  EXPECT_DOUBLE_EQ(run.out.links[1].force_n.z, 500 * 0.5 * 2.0);
  EXPECT_DOUBLE_EQ(run.out.links[2].force_n.z, -500 * 0.5 * 1.0);
}

TEST(Tick, LinksMaySetTheirOwnStiffness) {
  Hand run;
  run.program.links = {hold_height("a", 1, 100), hold_height("b", 3, 10)};
  run.program.coupling.max_force_n = 1e9;
  run.step(0, {0, 0, 0});
  EXPECT_DOUBLE_EQ(run.out.force_n.z, 100 * 1.0 + 10 * 2.0);
}

TEST(Tick, DampingUsesTheTimeBetweenSamplesAndIsZeroAtTickZero) {
  Hand run;
  run.program.coupling.damping_ns_per_m = 2;
  run.program.coupling.max_force_n = 1e9;
  run.program.meters_per_unit = 0.1;
  run.step(1.0, {0, 0, 0});
  EXPECT_EQ(run.out.force_n, Vec3(0.0));
  run.step(1.5, {3, 0, 0});
  EXPECT_DOUBLE_EQ(run.out.force_n.x, -2 * 0.1 * 3 / 0.5);
}

TEST(Tick, ADecreasingClockAdvancesNoWeight) {
  Hand run;
  run.program.links = {hold_height("a", 1)};
  run.program.links[0].active_when.button = 1;
  run.program.coupling.ramp_s = 0.02;
  run.program.coupling.damping_ns_per_m = 2;
  run.step(0, {0, 0, 0});
  run.step(1.00, {0, 0, 0});
  run.step(1.01, {0, 0, 0}, 1);
  EXPECT_NEAR(run.out.links[0].weight, 0.5, 1e-12);
  run.step(0.5, {0, 1, 0}, 1);
  EXPECT_NEAR(run.out.links[0].weight, 0.5, 1e-12);
  EXPECT_EQ(run.out.force_n.y, 0);
  run.step(0.505, {0, 1, 0}, 1);
  EXPECT_NEAR(run.out.links[0].weight, 0.75, 1e-12);
}

TEST(Tick, TheReportOfALinkIsFiniteForEveryProbe) {
  Hand run;
  run.program.links = {hold_height("a", 1), hold_height("b", -1.7e308)};
  run.program.links[1].active_when.button = 1;
  run.program.coupling.ramp_s = 0.02;
  const double largest = std::numeric_limits<double>::max();
  int k = 0;
  for (const double z : {1.7e308, -1.7e308, 1e300, 1e154, 0.0})
    for (const std::uint32_t buttons : {0u, 1u, 1u}) {
      run.step(0.001 * k++, {0, 0, z}, buttons);
      for (int i = 0; i < run.out.link_count; ++i) {
        const LinkReport& link = run.out.links[static_cast<std::size_t>(i)];
        EXPECT_TRUE(is_finite(link.force_n)) << z;
        EXPECT_TRUE(std::isfinite(link.gap) && std::isfinite(link.energy_j(1))) << z;
      }
      if (std::fabs(z) > 1e307) {
        EXPECT_EQ(run.out.links[0].force_n.z, z > 0 ? -largest : largest);
        EXPECT_EQ(run.out.links[0].energy_j(1), largest);
      }
      EXPECT_TRUE(is_finite(run.out.force_n)) << z;
    }
}

TEST(Tick, ForceIsLimitedAndKeepsItsDirection) {
  Hand run;
  run.program.links = {hold_height("a", 1)};
  run.program.coupling.max_force_n = 8;
  run.program.coupling.damping_ns_per_m = 500;
  run.step(0, {0, 0, 0});
  EXPECT_DOUBLE_EQ(norm(run.out.force_n), 8);
  run.step(1, {-1, 0, 0});
  EXPECT_NEAR(norm(run.out.force_n), 8, 1e-14);
  EXPECT_NEAR(run.out.force_n.x, 8 / std::sqrt(2.0), 1e-14);
  EXPECT_NEAR(run.out.force_n.z, 8 / std::sqrt(2.0), 1e-14);
}

TEST(Tick, AnOverflowingForceIsLimitedInItsDirection) {
  Hand run;
  run.program.links = {hold_height("a", 1)};
  run.step(0, {0, 0, -1.7e308});
  EXPECT_DOUBLE_EQ(run.out.force_n.z, 8);
  run.program.coupling.damping_ns_per_m = 1;
  run.step(1e-3, {1.7e308, 0, 1});
  EXPECT_NEAR(norm(run.out.force_n), 8, 1e-12);
  EXPECT_LT(run.out.force_n.x, 0);
}

TEST(Tick, ABadProbeHoldsTheProxiesAndGivesNoForce) {
  Hand run;
  run.program.links = {hold_height("a", 1)};
  run.step(0, {0.5, 0, 0});
  const Vec3 held = run.out.links[0].proxy;
  for (const double bad : {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
    run.step(0.001, {0, bad, 0});
    EXPECT_EQ(run.out.links[0].proxy, held);
    EXPECT_EQ(run.out.force_n, Vec3(0.0));
    EXPECT_EQ(run.out.links[0].status, LinkStatus::bad_probe);
    EXPECT_EQ(run.out.links[0].evaluations, 0);
  }
  run.step(0.002, {0.5, 0, 0});
  EXPECT_EQ(run.out.links[0].status, LinkStatus::ok);
}

TEST(Tick, ASwitchedOffLinkPassesItsProbeThroughBitForBit) {
  Hand run;
  run.program.links = {hold_height("a", 1)};
  run.program.links[0].active_when.button = 2;
  run.program.coupling.ramp_s = 0.004;
  run.program.coupling.max_force_n = 1e9;
  const Vec3 probe{0.1, -0.2, 0.3};
  run.step(0, probe, 1);
  EXPECT_FALSE(run.out.links[0].active);
  EXPECT_EQ(std::memcmp(&run.out.links[0].proxy, &probe, sizeof probe), 0);
  EXPECT_EQ(run.out.force_n, Vec3(0.0));
  // switched on: the weight rises over the ramp
  double last = 0;
  for (int k = 1; k <= 4; ++k) {
    run.step(0.001 * k, probe, 2);
    EXPECT_TRUE(run.out.links[0].active);
    EXPECT_NEAR(run.out.links[0].weight, 0.25 * k, 1e-12);
    EXPECT_GT(run.out.force_n.z, last);
    last = run.out.force_n.z;
  }
}

TEST(Tick, ADecreasingClockGivesNoDamping) {
  Hand run;
  run.program.links = {hold_height("a", 1)};
  run.program.links[0].active_when.button = 1;
  run.program.coupling.ramp_s = 0.25;
  run.program.coupling.damping_ns_per_m = 5;
  run.program.coupling.max_force_n = 1e9;
  run.step(1, {0, 0, 0});
  run.step(1.125, {0, 0, 0}, 1);
  EXPECT_DOUBLE_EQ(run.out.links[0].weight, 0.5);
  run.step(0.5, {0.1, 0, 0}, 1);
  EXPECT_DOUBLE_EQ(run.out.links[0].weight, 0.5);
  EXPECT_EQ(run.out.force_n.x, 0);
  EXPECT_DOUBLE_EQ(run.out.force_n.z, 250);
}

TEST(Tick, AForceSwitchActivatesALinkOneTickLater) {
  Hand run;
  run.program.links = {hold_height("a", 1, 5), hold_height("b", 2, 5)};
  run.program.links[1].active_when.force_above_n = 3;
  run.step(0, {0, 0, 0.9});
  EXPECT_FALSE(run.out.links[1].active);
  run.step(1, {0, 0, 0});  // 5 N
  EXPECT_FALSE(run.out.links[1].active);
  run.step(2, {0, 0, 0});
  EXPECT_TRUE(run.out.links[1].active);
}

TEST(Tick, AllocatesNothing) {
  Hand run;
  run.program.links = {hold_height("a", 1), hold_height("b", 2)};
  const AllocationCounter guard;
  for (int k = 0; k < 1000; ++k) run.step(0.001 * k, {0.001 * k, 0, 0});
  EXPECT_EQ(guard.count(), 0u);
  const AllocationCounter control;
  const auto escaped = std::make_unique<std::array<int, 100>>();
  EXPECT_NE(escaped.get(), nullptr);
  EXPECT_EQ(control.count(), 1u) << "the counter itself must work";
}

TEST(Tick, StateHashDistinguishesSignedZeros) {
  HapticState a;
  a.link_count = 1;
  HapticState b = a;
  b.links[0].proxy.z = -0.0;
  StateHash hash_a, hash_b;
  hash_a.add(a);
  hash_b.add(b);
  EXPECT_NE(hash_a.value(), hash_b.value());
}

TEST(Rebind, KeepsTheStateOfTheSameConstraintUnderTheSameName) {
  Hand run;
  run.program.links = {hold_height("a", 1), hold_height("b", 2)};
  run.step(0, {0, 0, 0});
  HapticProgram next = run.program;
  std::swap(next.links[0], next.links[1]);
  next.links[1].constraint = std::make_shared<test::HoldHeight>(5.0);
  rebind_program(run.program, next, run.state, run.scratch);
  EXPECT_TRUE(run.state.links[0].started);
  EXPECT_EQ(run.state.links[0].proxy.z, 2);
  EXPECT_FALSE(run.state.links[1].started);
}

}  // namespace tick_test
