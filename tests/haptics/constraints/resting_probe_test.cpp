// SPDX-License-Identifier: MIT
// The energy test of every constraint: an observer at the hand does not see a proxy that moves by itself, so the
// ledger is read tick by tick with the probe held still after a motion. What goes in there, the hand gets for nothing.
#include "haptics/chain/tick.h"
#include "tests/haptics/constraints/examples.h"

namespace catena::haptics::tests {
namespace still_probe_test {

constexpr double kStiffness = 500;

struct Felt {
  explicit Felt(ConstraintPtr constraint) {
    Link link;
    link.name = "a";
    link.constraint = std::move(constraint);
    link.stiffness_n_per_m = kStiffness;
    program.links = {link};
    program.coupling.max_force_n = 1e9;
  }
  const LinkReport& tick(const Vec3& probe) {
    catena::haptics::tick(program, {1e-3 * static_cast<double>(ticks++), probe}, state, scratch, out);
    return out.links[0];
  }
  HapticProgram program;
  ChainState state;
  ChainScratch scratch;
  HapticState out;
  int ticks = 0;
};

/// A hand that wanders through the domain, pushes, and holds still now and then.
template <class F>
void wander(const F& at) {
  Random random(77);
  Vec3 p(0.6, 0.2, 0.1), v = random.unit() * 0.004;
  for (int i = 0; i < 1200; ++i) {
    v = direction(v + random.unit() * 0.002) * (i % 80 < 40 ? 0.003 : 0.02);
    p = norm(p + v) > 1.7 ? p * 0.9 : p + v;
    at(p, false);
    if (i % 12 == 11)
      for (int k = 0; k < 4; ++k) at(p, true);
  }
}

class RestingProbe : public testing::TestWithParam<Example> {};

TEST_P(RestingProbe, GetsNoEnergyButBySnapOrSwitch) {
  // Eqs. 1-2 as printed never come to rest: they are there as the baseline
  if (GetParam().body.find("\"linear\"") != std::string::npos) return;
  const ConstraintPtr constraint = build(R"({"name": "a", "type": ")" + GetParam().type + "\", " + GetParam().body + "}", fields());
  ASSERT_NE(constraint, nullptr);
  Felt felt(constraint);
  const double length = constraint->domain_length(), most = 1e-12 * kStiffness * length * length;
  LinkReport before;
  int held = 0;
  wander([&](const Vec3& probe, bool still) {
    const LinkReport now = felt.tick(probe);
    // a search that was out of budget may take hold of something; otherwise that is told apart by `active`
    const bool goes_on = (before.status == LinkStatus::budget && now.status != LinkStatus::budget) || now.active != before.active;
    if (still && !goes_on) {
      ++held;
      ASSERT_LE(now.accounted_j - before.accounted_j, most) << "tick " << felt.ticks << " " << to_string(now.status);
    }
    before = now;
  });
  EXPECT_GE(held, 200);
}

INSTANTIATE_TEST_SUITE_P(All, RestingProbe, testing::ValuesIn(all_examples()),
                         [](const auto& test) { return test.param.type + "_" + std::to_string(test.index); });

/// Moves by itself, a little each tick: the test above must see it.
class Creeps final : public Constraint {
 public:
  void start(const Vec3& probe, LinkState& state, LinkScratch&) const noexcept override { state.proxy = probe; }
  void advance(const Vec3&, LinkState& state, LinkScratch&) const noexcept override { state.proxy.x += 1e-5; }
};

TEST(RestingProbeTest, SeesAProxyThatMovesByItself) {
  Felt felt(std::make_shared<Creeps>());
  double before = 0, most = 0;
  wander([&](const Vec3& probe, bool still) {
    const double now = felt.tick(probe).accounted_j;
    if (still) most = std::max(most, now - before);
    before = now;
  });
  EXPECT_GT(most, 1e-9 * kStiffness);
}

TEST(RestingProbeTest, ASnapIsBookedInItsTick) {
  Felt felt(build(R"({"name": "a", "type": "point", "position": [0, 0, 0], "snap": 0.05, "release": 0.2})"));
  felt.tick({0.06, 0, 0});
  EXPECT_EQ(felt.tick({0.06, 0, 0}).accounted_j, 0);
  const LinkReport snapped = felt.tick({0.04, 0, 0});
  EXPECT_TRUE(snapped.active);
  EXPECT_NEAR(snapped.accounted_j, 0.5 * kStiffness * 0.04 * 0.04, 1e-12);
  EXPECT_NEAR(felt.state.passivity.exempt_j, snapped.accounted_j, 1e-12);
  EXPECT_NEAR(felt.out.energy_j, snapped.accounted_j, 1e-12) << "the hand may have it";
}

}  // namespace still_probe_test
}  // namespace catena::haptics::tests
