// SPDX-License-Identifier: MIT
// The bound of ramp.h in the chain: under any switch, order, replacement or loss, no tick changes the force by more than
// K |dx| + max_force dt / ramp_s, and after the ramp the force is that of the links.
#include "haptics/chain/ramp.h"

#include <functional>
#include <random>

#include "engine/base/memory_limit.h"
#include "tests/haptics/chain/plane_links.h"

namespace catena::haptics::ramp_test {

using catena::test::ChainDriver;
using catena::test::hold_plane;

const Vec3 kProbe(0.3, 0.4, 0.5);
constexpr double kMaxForceN = 40, kRamp = 0.02;

HapticProgram ordered() {
  HapticProgram program = catena::test::make_order_program(kRamp);
  program.coupling.max_force_n = kMaxForceN;
  return program;
}

/// An upper bound of the stiffness of all links together.
double stiffness(const HapticProgram& program) {
  double sum = 0;
  for (const Link& link : program.links) sum += link.stiffness_n_per_m.max() * program.meters_per_unit;
  return sum;
}

TEST(Ramp, BoundsTheForceChangeForAnySteps) {
  std::mt19937_64 random(3);
  std::uniform_real_distribution<double> part(-1, 1);
  Ramp ramp;
  Vec3 before(0.0);
  for (int i = 0; i < 100000; ++i) {
    const double moved = i % 3 == 0 ? 0 : std::fabs(part(random)), fall = i % 5 == 0 ? 0 : 0.1 * std::fabs(part(random));
    const Vec3 now = i % 7 < 3 ? ramp.last_force : Vec3(part(random), part(random), part(random)) * (i % 2 ? 10.0 : 0.1);
    const Vec3 sent = now + step_ramp(ramp, now, moved, fall);
    ASSERT_LE(norm(sent - before), moved + fall + 1e-13) << i;
    before = sent;
  }
}

TEST(Ramp, ASingleLinkRampsInByItsWeightAndOutByTheRamp) {
  HapticProgram program;
  program.links = {hold_plane("a", {0, 0, 1}, 0, 100)};
  program.links[0].active_when.button = 1;
  program.coupling.ramp_s = kRamp;
  program.coupling.max_force_n = 50;
  ChainDriver hand(program);
  hand.step(kProbe);
  for (int n = 1; n <= 30; ++n) EXPECT_NEAR(hand.step(kProbe, 1).z, -50 * std::min(1.0, n / 20.0), 1e-12) << n;
  for (int n = 1; n <= 30; ++n) EXPECT_NEAR(hand.step(kProbe, 0).z, -50 * std::max(0.0, 1 - n / 20.0), 1e-12) << n;
  EXPECT_LE(norm(hand.step(kProbe, 0)), 1e-13);
}

TEST(Ramp, WithoutARampSwitchesActAtOnce) {
  ChainDriver ramped(catena::test::make_order_program(0)), fresh(catena::test::make_order_program(0));
  for (const std::uint32_t buttons : {0u, 1u, 3u, 7u, 4u, 8u, 0u, 2u, 12u}) {
    ramped.step(kProbe, buttons);
    fresh.state = ChainState{};
    EXPECT_EQ(ramped.out.force_n, fresh.step(kProbe, buttons)) << buttons;
  }
}

TEST(Ramp, BoundsTheForceChangeUnderSwitchesOrderChangesMotionAndLoss) {
  for (const double rate : {100.0, 1000.0, 8000.0}) {
    std::mt19937_64 random(11);
    ChainDriver hand(ordered());
    const double fall = kMaxForceN / (rate * kRamp), k = stiffness(hand.program);
    Vec3 at = kProbe;
    hand.step(at, 0, 1 / rate);
    double minimum = 1e300, maximum = 0;
    std::uint32_t buttons = 0;
    for (int i = 0; i < 20000; ++i) {
      if (random() % (i < 10000 ? 40 : 1 + i % 4) == 0) buttons = static_cast<std::uint32_t>(random() % 16);
      const bool lost = random() % 500 == 0;
      const Vec3 before = hand.out.force_n;
      const Vec3 last = at;
      const double way = i % 3 == 0 ? 1e-4 * static_cast<double>(random() % 100) : 0;
      at = kProbe + (at + Vec3(way, -way, i % 2 ? way : -way) - kProbe) * 0.9;
      const double allowed = k * norm(at - last) + fall + 1e-9;
      if (lost) {
        ASSERT_EQ(hand.step(Vec3(std::numeric_limits<double>::quiet_NaN()), buttons, 1 / rate), Vec3(0.0)) << "at once";
        ASSERT_LE(norm(hand.step(at, buttons, 1 / rate)), allowed) << i;
        continue;
      }
      ASSERT_LE(norm(hand.step(at, buttons, 1 / rate) - before), allowed) << i;
      minimum = std::min(minimum, norm(hand.out.force_n));
      maximum = std::max(maximum, norm(hand.out.force_n));
    }
    EXPECT_GT(maximum - minimum, kMaxForceN / 8) << "the switches must matter";
  }
}

TEST(Ramp, AfterTheRampTheForceIsThatOfTheNewOrder) {
  for (const std::uint32_t from : {0u, 1u, 3u, 7u, 8u})
    for (const std::uint32_t to : {0u, 2u, 3u, 4u, 7u, 12u, 8u}) {
      ChainDriver hand(ordered()), fresh(ordered());
      for (int i = 0; i < 5; ++i) hand.step(kProbe, from);
      for (int i = 0; i < 45; ++i) hand.step(kProbe, to);
      EXPECT_LE(norm(hand.out.force_n - fresh.step(kProbe, to)), 1e-12) << from << " " << to;
    }
}

TEST(Ramp, BoundsTheForceChangeWhenAProgramIsReplaced) {
  const HapticProgram first = ordered();
  std::vector<std::function<void(HapticProgram&)>> changes{
      [](HapticProgram& p) { p.links.erase(p.links.begin()), p.modes.clear(); },
      [](HapticProgram& p) { p.links.clear(), p.modes.clear(); },
      [](HapticProgram& p) { std::swap(p.links[0], p.links[2]); },
      [](HapticProgram& p) {
        p.links[0] = hold_plane("new", {0, 1, 1}, 0.2, 200);
      },
      [](HapticProgram& p) {
        p.links.insert(p.links.begin() + 1, hold_plane("more", {0, 1, 1}, 0.2, 200)), p.modes.clear();
      },
      [](HapticProgram& p) { p.links[2].stiffness_n_per_m = 400; },
      [](HapticProgram& p) { p.meters_per_unit = 3; },
      [](HapticProgram& p) { p.coupling.method = CouplingMethod::closest; },
  };
  for (std::size_t c = 0; c < changes.size(); ++c)
    for (const std::uint32_t buttons : {0u, 1u, 3u, 4u}) {
      ChainDriver hand(first);
      for (int i = 0; i < 30; ++i) hand.step(kProbe, buttons);
      HapticProgram next = first;
      changes[c](next);
      hand.replace(next);
      ChainDriver fresh(next);
      for (int i = 0; i < 45; ++i) fresh.step(kProbe, buttons);
      for (int i = 0; i < 45; ++i) {
        const Vec3 before = hand.out.force_n;
        ASSERT_LE(norm(hand.step(kProbe, buttons) - before), kMaxForceN / 20 + 1e-12) << c << " " << buttons << " tick " << i;
      }
      EXPECT_LE(norm(hand.out.force_n - fresh.out.force_n), 1e-10) << c << " " << buttons;
    }
}

TEST(Ramp, IsDeterministicAndAllocatesNothing) {
  ChainDriver a(ordered()), b(ordered());
  std::mt19937_64 random(12);
  const AllocationCounter guard;
  for (int i = 0; i < 3000; ++i) {
    const auto buttons = static_cast<std::uint32_t>(random() % 16);
    const Vec3 probe = kProbe * (1 + 0.1 * static_cast<double>(random() % 100) / 100);
    a.step(probe, buttons);
    ASSERT_EQ(a.out.force_n, b.step(probe, buttons)) << i;
  }
  EXPECT_EQ(guard.count(), 0u);
}

TEST(Ramp, OverflowingForcesLeaveNoResidue) {
  ChainDriver hand(ordered());
  hand.step({1e308, -1e308, 1e308}, 3);
  hand.step({1e308, -1e308, 1e308}, 4);
  for (int i = 0; i < 45; ++i) {
    ASSERT_TRUE(is_finite(hand.step(kProbe, 0))) << i;
  }
  ChainDriver fresh(ordered());
  EXPECT_LE(norm(hand.out.force_n - fresh.step(kProbe, 0)), 1e-10);
}

}  // namespace catena::haptics::ramp_test
