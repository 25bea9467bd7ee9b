#include "haptics/chain/switching.h"

#include <functional>
#include <random>

#include "engine/base/memory_limit.h"
#include "tests/haptics/chain/order_links.h"

namespace catena::haptics {
namespace fade_test {

using catena::test::ChainHand;
using catena::test::hold_plane;

const Vec3 kProbe(0.3, 0.4, 0.5);

/// The most that one tick may change the force of a still hand: all shares G at full weight ramp or fade at once.
double bound(const Program& program, double dt) {
  double g = 0;
  for (const Link& link : program.links) g += link.stiffness_n_per_m.most() * 1.2;  // no gap of these links is longer
  return 3 * g * dt / program.coupling.ramp_s;
}

double all_shares(const exchange::HapticState& out) {
  double sum = 0;
  for (int i = 0; i < out.link_count; ++i) sum += norm(out.links[static_cast<std::size_t>(i)].force_n);
  return sum;
}

TEST(Fade, ALinkAloneFollowsItsWeightUpAndDown) {
  Program program;
  program.links = {hold_plane("a", {0, 0, 1}, 0, 100)};
  program.links[0].on.button = 1;
  program.coupling.ramp_s = 0.02;
  program.coupling.max_force_n = 1e9;
  ChainHand hand(program);
  hand.step(kProbe);
  for (int n = 1; n <= 30; ++n) EXPECT_NEAR(hand.step(kProbe, 1).z, -50 * std::min(1.0, n / 20.0), 1e-12) << n;
  for (int n = 1; n <= 30; ++n) EXPECT_NEAR(hand.step(kProbe, 0).z, -50 * std::max(0.0, 1 - n / 20.0), 1e-12) << n;
  EXPECT_EQ(hand.step(kProbe, 0), Vec3(0.0));
}

TEST(Fade, TheLastLinkFollowsItsWeightUpAndDown) {
  Program program;
  program.links = {hold_plane("a", {1, 0, 0}, 0, 100), hold_plane("b", {0, 0, 1}, 0, 40)};
  program.links[1].on.button = 1;
  program.coupling.ramp_s = 0.02;
  program.coupling.max_force_n = 1e9;
  ChainHand hand(program);
  hand.step(kProbe);
  for (int n = 1; n <= 30; ++n) {
    hand.step(kProbe, 1);
    EXPECT_NEAR(hand.out.force_n.z, -20 * std::min(1.0, n / 20.0), 1e-12) << n;
    EXPECT_NEAR(hand.out.force_n.x, -30, 1e-12) << n;
  }
  for (int n = 1; n <= 30; ++n) {
    hand.step(kProbe, 0);
    EXPECT_NEAR(hand.out.force_n.z, -20 * std::max(0.0, 1 - n / 20.0), 1e-12) << n;
    EXPECT_NEAR(hand.out.force_n.x, -30, 1e-12) << n;
  }
}

TEST(Fade, WithoutARampAllIsAtOnce) {
  ChainHand fading(catena::test::order_program(0)), fresh(catena::test::order_program(0));
  for (const std::uint32_t buttons : {0u, 1u, 3u, 7u, 4u, 8u, 0u, 2u, 12u}) {
    fading.step(kProbe, buttons);
    fresh.state = ChainState{};
    fresh.step(kProbe, buttons);
    EXPECT_EQ(fading.out.force_n, fresh.out.force_n) << buttons;
  }
}

TEST(Fade, NoJumpHoweverLinksAreSwitchedAndReordered) {
  std::mt19937_64 random(11);
  for (const double ramp : {0.02, 0.1}) {
    ChainHand hand(catena::test::order_program(ramp));
    const double most = bound(hand.program, 1e-3);
    hand.step(kProbe);
    double largest = 0, least = 1e300, swing = 0;
    for (int i = 0; i < 20000; ++i) {
      // now in every tick, now after a while
      static std::uint32_t buttons = 0;
      if (random() % (i < 10000 ? 40 : 1 + i % 4) == 0) buttons = static_cast<std::uint32_t>(random() % 16);
      const Vec3 before = hand.out.force_n;
      hand.step(kProbe, buttons);
      largest = std::max(largest, norm(hand.out.force_n - before));
      swing = std::max(swing, norm(hand.out.force_n));
      least = std::min(least, norm(hand.out.force_n));
    }
    EXPECT_LE(largest, most) << ramp;
    EXPECT_GT(swing - least, 4 * largest) << "the switches must matter";
    EXPECT_LT(swing, 300) << "what fades stays within what was felt";
  }
}

TEST(Fade, AfterTheRampTheForceIsThatOfTheNewOrder) {
  for (const std::uint32_t from : {0u, 1u, 3u, 7u, 8u})
    for (const std::uint32_t to : {0u, 2u, 3u, 4u, 7u, 12u, 8u}) {
      ChainHand hand(catena::test::order_program(0.02)), fresh(catena::test::order_program(0.02));
      for (int i = 0; i < 5; ++i) hand.step(kProbe, from);
      for (int i = 0; i < 25; ++i) hand.step(kProbe, to);
      fresh.step(kProbe, to);
      EXPECT_LE(norm(hand.out.force_n - fresh.out.force_n), 1e-12) << from << " " << to;
    }
}

TEST(Fade, NoJumpWhenAProgramReplacesAnother) {
  const Program first = catena::test::order_program(0.02);
  std::vector<std::function<void(Program&)>> changes{
      [](Program& p) { p.links.erase(p.links.begin()), p.modes.clear(); },
      [](Program& p) { p.links.pop_back(), p.modes.clear(); },
      [](Program& p) { p.links.clear(), p.modes.clear(); },
      [](Program& p) { std::swap(p.links[0], p.links[2]); },
      [](Program& p) {
        p.links[0] = hold_plane("new", {0, 1, 1}, 0.2, 200);
      },
      [](Program& p) {
        p.links.insert(p.links.begin() + 1, hold_plane("more", {0, 1, 1}, 0.2, 200)), p.modes.clear();
      },
      [](Program& p) { p.links[2].stiffness_n_per_m = 400; },
      [](Program& p) { p.metres_per_unit = 3; },
  };
  for (std::size_t c = 0; c < changes.size(); ++c)
    for (const std::uint32_t buttons : {0u, 1u, 3u, 4u}) {
      ChainHand hand(first);
      for (int i = 0; i < 30; ++i) hand.step(kProbe, buttons);
      const double before_n = all_shares(hand.out);
      Program next = first;
      changes[c](next);
      hand.replace(next);
      ChainHand fresh(next);
      for (int i = 0; i < 25; ++i) fresh.step(kProbe, buttons);
      const double most = 1.5 * (before_n + all_shares(fresh.out)) / 20;
      for (int i = 0; i < 30; ++i) {
        const Vec3 before = hand.out.force_n;
        hand.step(kProbe, buttons);
        ASSERT_LE(norm(hand.out.force_n - before), most) << c << " " << buttons << " tick " << i;
      }
      EXPECT_LE(norm(hand.out.force_n - fresh.out.force_n), 1e-10) << c << " " << buttons;
    }
}

TEST(Fade, ASwitchBackWithinTheRampGoesOnFromWhereItIs) {
  Program program;
  program.links = {hold_plane("a", {0, 0, 1}, 0, 100)};
  program.links[0].on.button = 1;
  program.coupling.ramp_s = 0.02;
  program.coupling.max_force_n = 1e9;
  ChainHand hand(program);
  hand.step(kProbe);
  for (int i = 0; i < 400; ++i) {
    const double before = hand.out.force_n.z;
    hand.step(kProbe, static_cast<std::uint32_t>(i / 7 % 2));
    EXPECT_LE(std::fabs(hand.out.force_n.z - before), 2 * 50 / 20.0 + 1e-12) << i;
    EXPECT_LE(hand.out.force_n.z, 1e-12);
    EXPECT_GE(hand.out.force_n.z, -50 - 1e-12);
  }
}

TEST(Fade, TheSameBitsAgainAndNoAllocation) {
  ChainHand a(catena::test::order_program(0.02)), b(catena::test::order_program(0.02));
  std::mt19937_64 random(12);
  const AllocationGuard guard;
  for (int i = 0; i < 3000; ++i) {
    const auto buttons = static_cast<std::uint32_t>(random() % 16);
    const Vec3 probe = kProbe * (1 + 0.1 * static_cast<double>(random() % 100) / 100);
    a.step(probe, buttons);
    b.step(probe, buttons);
    ASSERT_EQ(a.out.force_n, b.out.force_n) << i;
  }
  EXPECT_EQ(guard.count(), 0u);
}

TEST(Fade, NoJumpWhereAForceOrdersTheChain) {
  Program program = catena::test::order_program(0.02);
  for (Link& link : program.links) link.on = {};
  program.modes = {{"pressed", {2, 3, 0, 1}, {.force_above_n = 70, .force_below_n = 55}}};
  ChainHand hand(program);
  hand.step(Vec3(0.0));
  int changes = 0;
  double largest = 0;
  for (int i = 0; i < 4000; ++i) {
    const double way = i < 2000 ? i / 2000.0 : 2 - i / 2000.0;
    const Vec3 before = hand.out.force_n;
    const std::int32_t mode = hand.out.mode;
    hand.step(kProbe * (1.5 * way));
    changes += hand.out.mode != mode;
    largest = std::max(largest, norm(hand.out.force_n - before));
  }
  EXPECT_EQ(changes, 2) << "once in, once out";
  EXPECT_LE(largest, 1.5 * 2 * 200 / 20.0 + 2);  // both orders' shares over the ramp, and the hand's own motion
  ChainHand at_once(program);
  at_once.program.coupling.ramp_s = 0;
  at_once.step(Vec3(0.0));
  double jump = 0;
  for (int i = 0; i < 2000; ++i) {
    const Vec3 before = at_once.out.force_n;
    at_once.step(kProbe * (1.5 * i / 2000.0));
    jump = std::max(jump, norm(at_once.out.force_n - before));
  }
  std::printf("ordered by force: %.2f N a tick with the ramp, %.2f N at once\n", largest, jump);
  EXPECT_GT(jump, 4 * largest);
}

TEST(Fade, ForcesBeyondDoublesLeaveNothingBehind) {
  ChainHand hand(catena::test::order_program(0.02));
  hand.step({1e308, -1e308, 1e308}, 3);
  hand.step({1e308, -1e308, 1e308}, 4);
  for (int i = 0; i < 30; ++i) {
    hand.step(kProbe, 0);
    ASSERT_TRUE(is_finite(hand.out.force_n)) << i;
  }
  ChainHand fresh(catena::test::order_program(0.02));
  fresh.step(kProbe, 0);
  EXPECT_LE(norm(hand.out.force_n - fresh.out.force_n), 1e-10);
}

}  // namespace fade_test
}  // namespace catena::haptics
