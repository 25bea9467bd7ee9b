// SPDX-License-Identifier: MIT
// The energy ledger in the tick. The closed loop is tested in tests/haptics/servo/closed_loop_test.cpp.
#include "haptics/chain/passivity.h"

#include "tests/haptics/chain/chain_driver.h"
#include "tests/support/simple_links.h"

namespace passivity_test {

using namespace catena;
using namespace catena::haptics;
using test::ChainDriver;
using test::hold_height;

TEST(StiffnessCap, AppliesToEveryLinkAndToABaseline) {
  ChainDriver hand({hold_height("a", 0.01, 3000), hold_height("b", 0.02, 100)});
  hand.program.limits.max_stiffness_n_per_m = 200;
  hand.step(Vec3(0.0));
  EXPECT_EQ(hand.link().stiffness_n_per_m, 200);
  EXPECT_EQ(hand.link(1).stiffness_n_per_m, 100);
  EXPECT_DOUBLE_EQ(hand.out.force_n.z, 200 * 0.01 + 100 * 0.01);

  ChainDriver single({hold_height("a", 0.01, 3000)});
  single.program.coupling = {.stiffness_n_per_m = 5000, .max_force_n = 1e9, .method = CouplingMethod::pipe};
  single.program.limits.max_stiffness_n_per_m = 200;
  EXPECT_DOUBLE_EQ(single.step(Vec3(0.0)).z, 2);
  EXPECT_EQ(single.link().stiffness_n_per_m, 200);
}

TEST(Passivity, ASpringAccountsHalfKTimesStepSquaredPerTick) {
  // down and up by steps of 1 mm: a held force generates K/2 step^2 per tick
  ChainDriver hand({hold_height("a", 0, 500)});
  double expected = 0;
  hand.step(Vec3(0.0));
  for (int k = 1; k <= 20; ++k) {
    hand.step({0, 0, -1e-3 * (k <= 10 ? k : 20 - k)});
    expected += 0.5 * 500 * 1e-6;
    ASSERT_NEAR(hand.link().accounted_j, expected, 1e-15) << k;
    ASSERT_NEAR(hand.out.energy_j, hand.link().energy_j(1) - expected, 1e-15) << k;
  }
  // a device whose damping dissipates as much: the balance is the stored energy
  ChainDriver damped(hand.program);
  damped.program.limits.damping_ns_per_m = 0.25;
  damped.step(Vec3(0.0));
  for (int k = 1; k <= 20; ++k) {
    damped.step({0, 0, -1e-3 * (k <= 10 ? k : 20 - k)});
    ASSERT_NEAR(damped.out.energy_j, damped.link().energy_j(1), 1e-15) << k;
  }
}

TEST(Passivity, TheEnergyOfARisingWeightIsExempt) {
  ChainDriver hand({hold_height("a", 0.01, 500)});
  hand.program.links[0].active_when.button = 1;
  hand.program.coupling.ramp_s = 0.01;
  hand.step(Vec3(0.0));
  hand.step(Vec3(0.0));
  for (int k = 1; k <= 10; ++k) {
    hand.step(Vec3(0.0), 1);
    ASSERT_NEAR(hand.state.passivity.exempt_j, 0.1 * k * 0.5 * 500 * 1e-4, 1e-12) << k;
    ASSERT_NEAR(hand.out.energy_j, hand.state.passivity.exempt_j, 1e-12) << k;
  }
}

TEST(Passivity, ALostDeviceAccountsNoWorkAndRestarts) {
  ChainDriver hand({hold_height("a", 0.01, 500)});
  hand.step(Vec3(0.0));
  const double booked = hand.link().accounted_j;
  EXPECT_NEAR(booked, 0.5 * 500 * 1e-4, 1e-15);
  hand.at(hand.t + 1e-3, {9, 9, 9}, 0, kIdentityRotation, TickCondition::no_device);
  EXPECT_EQ(hand.out.force_n, Vec3(0.0));
  EXPECT_EQ(hand.out.energy_j, 0);
  hand.step({0, 0, -0.01});
  EXPECT_NEAR(hand.link().accounted_j, 4 * booked, 1e-14) << "no work was done on the way";
  EXPECT_NEAR(hand.out.energy_j, 4 * booked, 1e-14);
}

TEST(Passivity, TheLedgerOfAKeptLinkContinuesUnderANewProgram) {
  ChainDriver hand({hold_height("a", 0, 500)});
  hand.step(Vec3(0.0));
  hand.step({0, 0, -0.01});
  hand.step({0, 0, -0.02});
  const double booked = hand.link().accounted_j;
  HapticProgram next = hand.program;
  next.links.insert(next.links.begin(), hold_height("new", 0, 500));
  hand.replace(next);
  hand.step({0, 0, -0.02});
  // the stored energy moves to the new first link; the old link keeps the work that it has done
  EXPECT_NEAR(hand.link(1).accounted_j, booked - 0.5 * 500 * 4e-4, 1e-14);
  EXPECT_NEAR(hand.link().accounted_j, 0.5 * 500 * 4e-4, 1e-14);
}

TEST(Passivity, ASpringBeyondTheForceLimitStoresOnlyItsRecoverableEnergy) {
  ChainDriver hand({hold_height("a", 0.02, 500)});
  hand.program.coupling.max_force_n = 8;
  hand.step(Vec3(0.0));
  // 8 N over the first 4 mm, then the spring's energy of the last 16 mm
  EXPECT_NEAR(hand.out.energy_j, 8 * 0.004 + 0.5 * 500 * 0.016 * 0.016, 1e-14);
}

TEST(Passivity, HugePositionsGiveFiniteEnergies) {
  ChainDriver hand({hold_height("a", 0, 500)});
  hand.program.limits.passivity_control = true;
  hand.program.limits.damping_ns_per_m = 0.5;
  for (const double z : {0.0, 1e200, -1e200, 1e308, 0.0, 1e-3, 2e-3}) {
    ASSERT_TRUE(is_finite(hand.step({0, 0, z}))) << z;
    ASSERT_TRUE(std::isfinite(hand.out.energy_j) && std::isfinite(hand.out.dissipated_j)) << z;
    ASSERT_TRUE(std::isfinite(hand.link().accounted_j)) << z;
  }
}

}  // namespace passivity_test
