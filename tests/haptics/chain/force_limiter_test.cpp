// SPDX-License-Identifier: MIT
#include "haptics/chain/force_limiter.h"

#include <gtest/gtest.h>

#include <cstring>
#include <limits>

namespace force_limiter_test {

using namespace catena;
using namespace catena::haptics;

constexpr double kTick = 1e-3, kNan = std::numeric_limits<double>::quiet_NaN();
const Vec3 kRequested(3, -4, 0);

struct LimiterRig {
  DeviceLimits limits;
  ForceLimiterState state;
  Vec3 requested = kRequested;
  bool on = true;
  double dt = kTick;

  /// With these limits, after this many ticks.
  explicit LimiterRig(int ticks = 0, const DeviceLimits& with = {}) : limits(with) { run(ticks); }
  LimiterRig& step(TickCondition condition = TickCondition::normal) {
    limit_force(limits, {requested, requested * 0.01, condition, on, dt}, state);
    return *this;
  }
  void run(int ticks, TickCondition condition = TickCondition::normal) {
    for (int i = 0; i < ticks; ++i) step(condition);
  }
  double force() const { return norm(state.force_n); }
  void expect(const Vec3& force_n, ForceState now) const {
    EXPECT_EQ(state.force_n, force_n);
    EXPECT_EQ(state.force_state, now);
  }
  void expect_near(double force_n, double tolerance, ForceState now) const {
    EXPECT_NEAR(force(), force_n, tolerance);
    EXPECT_EQ(state.force_state, now);
  }
};

TEST(ForceLimiter, WithoutLimitsTheForceIsUnchangedBitForBit) {
  LimiterRig g;
  for (const Vec3& v : {Vec3(-0.0, 5e-324, 1e308), Vec3(3, -4, 0.1), Vec3(0.0)}) {
    g.requested = v;
    g.step();
    EXPECT_EQ(std::memcmp(&g.state.force_n, &v, sizeof v), 0);
    EXPECT_EQ(g.state.force_state, ForceState::on);
  }
}

TEST(ForceLimiter, AFaultGivesZeroForceInItsTickWhateverTheLimits) {
  for (const TickCondition fault : {TickCondition::no_device, TickCondition::watchdog}) {
    LimiterRig g(5000, {.slew_n_per_s = 1});
    ASSERT_GT(g.force(), 4.9);
    g.step(fault).expect(Vec3(0.0), ForceState::stopped);
    EXPECT_EQ(g.state.torque_nm, Vec3(0.0));
  }
}

TEST(ForceLimiter, ANonFiniteForceIsAFault) {
  for (const double bad : {kNan, std::numeric_limits<double>::infinity()}) {
    LimiterRig g(50, {.ramp_in_s = 0.01});
    g.requested = Vec3(0, bad, 0);
    g.step().expect(Vec3(0.0), ForceState::stopped);
    g.requested = kRequested;
    g.step().expect_near(0.5, 1e-12, ForceState::ramping_in);  // a tenth, from nothing
  }
}

TEST(ForceLimiter, LateTicksHoldThenRampOutLinearlyIn20ms) {
  LimiterRig g(3);
  g.requested = Vec3(100, 100, 100);
  for (int i = 0; i < 5; ++i) {
    g.step(TickCondition::late).expect(kRequested, ForceState::held);
    EXPECT_EQ(g.state.torque_nm, kRequested * 0.01);
  }
  g.dt = 2.5e-3;  // late ticks are longer
  for (int i = 1; i < 8; ++i) {
    g.step(TickCondition::late).expect_near(5 * (1 - i / 8.0), 1e-12, ForceState::ramping_out);
  }
  for (int i = 0; i < 3; ++i) {
    g.step(TickCondition::late).expect(Vec3(0.0), ForceState::stopped);
  }
}

TEST(ForceLimiter, OneTickOnTimeResetsTheCountOfLateTicks) {
  LimiterRig g(200, {.ramp_in_s = 0.1});
  for (int i = 0; i < 10; ++i) {
    g.run(5, TickCondition::late);
    EXPECT_EQ(g.state.force_state, ForceState::held);
    g.step().expect(kRequested, ForceState::on);
  }
}

TEST(ForceLimiter, AfterARampOutTheForceRampsInFromItsCurrentValue) {
  LimiterRig g(200, {.ramp_in_s = 0.1});
  g.run(5 + 10, TickCondition::late);  // half of 20 ms
  EXPECT_NEAR(g.force(), 2.5, 1e-9);
  g.step().expect_near(5 * 0.51, 1e-9, ForceState::ramping_in);
}

TEST(ForceLimiter, ARampOutEndsEvenIfTheClockStandsStill) {
  LimiterRig g(2);
  g.dt = 0;
  g.run(5 + 1000, TickCondition::late);
  EXPECT_EQ(g.state.force_state, ForceState::stopped);
}

TEST(ForceLimiter, RampsInFromTheFirstTick) {
  LimiterRig g(0, {.ramp_in_s = 0.5});
  g.dt = 0;
  g.step().expect(Vec3(0.0), ForceState::ramping_in);
  g.dt = kTick;
  for (int k = 1; k < 500; ++k) {
    g.step();
    ASSERT_NEAR(g.force(), 5 * k * kTick / 0.5, 1e-9) << k;
    ASSERT_NEAR(norm(g.state.torque_nm), 0.05 * k * kTick / 0.5, 1e-9) << k;
  }
  g.run(2);
  g.expect(kRequested, ForceState::on);
}

TEST(ForceLimiter, SwitchingOffAndOnRampsOutAndIn) {
  LimiterRig g(200, {.ramp_in_s = 0.1});
  g.on = false;
  for (int k = 1; k < 20; ++k) {
    g.step().expect_near(5 * (1 - k / 20.0), 1e-9, ForceState::ramping_out);
  }
  g.run(2);
  g.expect(Vec3(0.0), ForceState::off);
  g.run(3, TickCondition::late);
  EXPECT_EQ(g.state.force_state, ForceState::off);
  g.on = true;
  g.step();
  EXPECT_NEAR(g.force(), 0.05, 1e-9);
}

TEST(ForceLimiter, SwitchingOffNeverRaisesTheForce) {
  // while the slew limit bounds a jump
  LimiterRig g(3, {.slew_n_per_s = 100});
  const double before = g.force();
  ASSERT_NEAR(before, 0.3, 1e-9);
  g.on = false;
  g.step();
  EXPECT_LE(g.force(), before);
  // after late ticks have halved the force
  LimiterRig late(10);
  late.run(5 + 10, TickCondition::late);
  ASSERT_NEAR(late.force(), 2.5, 1e-9);
  late.on = false;
  for (double last = 2.5; late.force() > 0; last = late.force()) {
    late.step(TickCondition::late);
    ASSERT_LE(late.force(), last + 1e-12);
  }
  EXPECT_EQ(late.state.force_state, ForceState::off);
  // while the requested force grows and reverses
  LimiterRig deeper(10, {.slew_n_per_s = 1000});
  deeper.on = false;
  for (double k = 1; k < 25; ++k) {
    const Vec3 last = deeper.state.force_n;
    deeper.requested = kRequested * (static_cast<int>(k) % 2 == 0 ? 1 + k : -1 - k);
    deeper.step();
    ASSERT_LE(deeper.force(), norm(last) + 1e-12) << k;
    ASSERT_LE(deeper.force(), 5 * std::fmax(0.0, 1 - k / 20) + 1e-9) << "never longer than the way to zero";
  }
  EXPECT_EQ(deeper.state.force_state, ForceState::off);
}

TEST(ForceLimiter, SwitchingOnDuringTheRampOutContinuesFromTheRemainingForce) {
  LimiterRig g(0, {.ramp_in_s = 0.5});
  g.requested = kRequested * 0.1;
  g.run(600);
  g.on = false;
  g.run(4);
  g.requested = kRequested;  // a larger request while switched off has no effect
  g.step();
  const double left = g.force();
  ASSERT_LE(left, 0.5);
  g.on = true;
  g.step().expect_near(left + 5 * kTick / 0.5, 1e-9, ForceState::ramping_in);
}

TEST(ForceLimiter, SwitchedOffAtTheStartTheForceIsZero) {
  LimiterRig g;
  g.on = false;
  g.step().expect(Vec3(0.0), ForceState::off);
}

TEST(ForceLimiter, LimitsKeepTheDirection) {
  LimiterRig g(0, {.max_force_n = 2, .max_torque_nm = 0.01});
  g.step();
  EXPECT_NEAR(g.state.force_n.x, 1.2, 1e-15);
  EXPECT_NEAR(g.state.force_n.y, -1.6, 1e-15);
  EXPECT_NEAR(norm(g.state.torque_nm), 0.01, 1e-17);
  g.limits.max_force_n = 0;
  EXPECT_EQ(norm(g.step().state.force_n), 0);
}

TEST(ForceLimiter, TheSlewLimitBoundsTheSlopeAndReachesTheForce) {
  LimiterRig g(0, {.slew_n_per_s = 100});
  for (int k = 1; k <= 49; ++k) ASSERT_NEAR(norm(g.step().state.force_n), 0.1 * k, 1e-12);
  g.run(2);
  EXPECT_EQ(g.state.force_n, kRequested);
  // from a force to its opposite: along the line between them
  g.requested = -kRequested;
  const Vec3 before = g.state.force_n;
  g.step();
  EXPECT_NEAR(norm(g.state.force_n - before), 0.1, 1e-12);
  EXPECT_NEAR(norm(cross(g.state.force_n, kRequested)), 0, 1e-12);
}

TEST(ForceLimiter, NeverExceedsItsLimitsInAnyOrderOfConditions) {
  // in every condition: below the maximum force, below the slew limit, and zero at once on a fault
  LimiterRig g(0, {.max_force_n = 4, .slew_n_per_s = 2000, .ramp_in_s = 0.01});
  std::uint32_t seed = 1;
  const auto next = [&seed] { return (seed = seed * 1664525u + 1013904223u) >> 16; };
  int faults = 0, held = 0;
  for (int k = 0; k < 20000; ++k) {
    const std::uint32_t r = next() % 100;
    const TickCondition bad[] = {TickCondition::no_device, TickCondition::watchdog, TickCondition::late};
    const TickCondition c = r < 40 ? bad[std::min(r / 2, 2u)] : TickCondition::normal;
    if (next() % 50 == 0) g.on = !g.on;
    g.requested = kRequested * (static_cast<double>(next() % 1000) * 1e-3);
    const Vec3 last = g.state.force_n;
    g.step(c);
    ASSERT_LE(g.force(), 4 + 1e-12);
    if (r < 4) {
      ASSERT_EQ(g.force(), 0);
      ++faults;
    } else if (g.state.force_state == ForceState::held) {
      ASSERT_EQ(g.state.force_n, last);
      ++held;
    } else if (g.state.force_state == ForceState::on || g.state.force_state == ForceState::ramping_in) {
      ASSERT_LE(norm(g.state.force_n - last), 2 + 1e-12);
    }
  }
  EXPECT_GT(faults, 100);
  EXPECT_GT(held, 1000);
}

}  // namespace force_limiter_test
