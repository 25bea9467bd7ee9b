// SPDX-License-Identifier: MIT
#include "haptics/chain/tick.h"

#include <cstring>
#include <limits>

#include "engine/base/memory_limit.h"
#include "haptics/chain/state_hash.h"
#include "tests/haptics/chain/chain_driver.h"
#include "tests/support/simple_links.h"

namespace tick_test {

using namespace catena;
using namespace catena::haptics;
using test::ChainDriver;
using test::hold_height;

TEST(Tick, EqualStiffnessTelescopesToTheLastProxy) {
  ChainDriver run({hold_height("a", 1), hold_height("b", 3), hold_height("c", 2)});
  run.program.meters_per_unit = 0.5;
  EXPECT_DOUBLE_EQ(run.at(0, {0.25, 0.5, 0}).force_n.z, 500 * 0.5 * 2.0);
  EXPECT_EQ(run.out.force_n.x, 0);
  EXPECT_DOUBLE_EQ(run.link(1).force_n.z, 500 * 0.5 * 2.0);
  EXPECT_DOUBLE_EQ(run.link(2).force_n.z, -500 * 0.5 * 1.0);
}

TEST(Tick, LinksMaySetTheirOwnStiffness) {
  ChainDriver run({hold_height("a", 1, 100), hold_height("b", 3, 10)});
  EXPECT_DOUBLE_EQ(run.at(0, {0, 0, 0}).force_n.z, 100 * 1.0 + 10 * 2.0);
}

TEST(Tick, DampingUsesTheTimeBetweenSamplesAndIsZeroAtTickZero) {
  ChainDriver run;
  run.program.coupling.damping_ns_per_m = 2;
  run.program.meters_per_unit = 0.1;
  EXPECT_EQ(run.at(1.0, {0, 0, 0}).force_n, Vec3(0.0));
  EXPECT_DOUBLE_EQ(run.at(1.5, {3, 0, 0}).force_n.x, -2 * 0.1 * 3 / 0.5);
}

TEST(Tick, TheReportOfALinkIsFiniteForEveryProbe) {
  ChainDriver run({hold_height("a", 1), hold_height("b", -1.7e308)}, 8);
  run.program.links[1].active_when.button = 1;
  run.program.coupling.ramp_s = 0.02;
  const double largest = std::numeric_limits<double>::max();
  int k = 0;
  for (const double z : {1.7e308, -1.7e308, 1e300, 1e154, 0.0})
    for (const std::uint32_t buttons : {0u, 1u, 1u}) {
      run.at(0.001 * k++, {0, 0, z}, buttons);
      for (int i = 0; i < run.out.link_count; ++i) {
        const LinkReport& link = run.link(static_cast<std::size_t>(i));
        EXPECT_TRUE(is_finite(link.force_n)) << z;
        EXPECT_TRUE(std::isfinite(link.gap) && std::isfinite(link.energy_j(1))) << z;
      }
      if (std::fabs(z) > 1e307) {
        EXPECT_EQ(run.link().force_n.z, z > 0 ? -largest : largest);
        EXPECT_EQ(run.link().energy_j(1), largest);
      }
      EXPECT_TRUE(is_finite(run.out.force_n)) << z;
    }
}

/// Gives a proxy that is not finite, or a status that does not exist, as a faulty plug-in may.
class Strays final : public haptics::Constraint {
 public:
  explicit Strays(bool bad_status) : bad_status_(bad_status) {}
  void start(const Vec3& probe, haptics::LinkState& state, haptics::LinkScratch&) const noexcept override { state.proxy = probe; }
  void advance(const Vec3& probe, haptics::LinkState& state, haptics::LinkScratch&) const noexcept override {
    state.proxy = bad_status_ ? probe + 5.0 : Vec3(std::numeric_limits<double>::quiet_NaN());
    state.status = bad_status_ ? static_cast<LinkStatus>(200) : LinkStatus::ok;
  }

 private:
  bool bad_status_;
};

TEST(Tick, ResultsOfAFaultyConstraintAreReplacedByTheProbe) {
  for (const bool bad_status : {false, true}) {
    ChainDriver run;
    run.add(std::make_shared<Strays>(bad_status));
    run.program.links.push_back(hold_height("b", 1));
    for (int k = 0; k < 3; ++k) {
      run.at(0.001 * k, {0.5, 0.25, 0});
      EXPECT_EQ(run.link(0).proxy, Vec3(0.5, 0.25, 0)) << bad_status;
      EXPECT_EQ(run.link(0).status, LinkStatus::critical);
      EXPECT_EQ(run.link(1).proxy, Vec3(0.5, 0.25, 1)) << "the next link goes on from the probe";
      EXPECT_DOUBLE_EQ(run.out.force_n.z, 500 * 1.0);
    }
  }
}

TEST(Tick, ForceIsLimitedAndKeepsItsDirection) {
  ChainDriver run({hold_height("a", 1)}, 8);
  run.program.coupling.max_force_n = 8;
  run.program.coupling.damping_ns_per_m = 500;
  EXPECT_DOUBLE_EQ(norm(run.at(0, {0, 0, 0}).force_n), 8);
  EXPECT_NEAR(norm(run.at(1, {-1, 0, 0}).force_n), 8, 1e-14);
  EXPECT_NEAR(run.out.force_n.x, 8 / std::sqrt(2.0), 1e-14);
  EXPECT_NEAR(run.out.force_n.z, 8 / std::sqrt(2.0), 1e-14);
}

TEST(Tick, AnOverflowingForceIsLimitedInItsDirection) {
  ChainDriver run({hold_height("a", 1)}, 8);
  EXPECT_DOUBLE_EQ(run.at(0, {0, 0, -1.7e308}).force_n.z, 8);
  run.program.coupling.damping_ns_per_m = 1;
  EXPECT_NEAR(norm(run.at(1e-3, {1.7e308, 0, 1}).force_n), 8, 1e-12);
  EXPECT_LT(run.out.force_n.x, 0);
}

TEST(Tick, ABadProbeHoldsTheProxiesAndGivesNoForce) {
  ChainDriver run({hold_height("a", 1)}, 8);
  run.at(0, {0.5, 0, 0});
  const Vec3 held = run.link().proxy;
  for (const double bad : {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
    EXPECT_EQ(run.at(0.001, {0, bad, 0}).links[0].proxy, held);
    EXPECT_EQ(run.out.force_n, Vec3(0.0));
    EXPECT_EQ(run.link().status, LinkStatus::bad_probe);
    EXPECT_EQ(run.link().evaluations, 0);
  }
  EXPECT_EQ(run.at(0.002, {0.5, 0, 0}).links[0].status, LinkStatus::ok);
}

TEST(Tick, ASwitchedOffLinkPassesItsProbeThroughBitForBit) {
  ChainDriver run({hold_height("a", 1)});
  run.program.links[0].active_when.button = 2;
  run.program.coupling.ramp_s = 0.004;
  const Vec3 probe{0.1, -0.2, 0.3};
  EXPECT_FALSE(run.at(0, probe, 1).links[0].active);
  EXPECT_EQ(std::memcmp(&run.link().proxy, &probe, sizeof probe), 0);
  EXPECT_EQ(run.out.force_n, Vec3(0.0));
  // switched on: the weight rises over the ramp
  double last = 0;
  for (int k = 1; k <= 4; ++k) {
    EXPECT_TRUE(run.at(0.001 * k, probe, 2).links[0].active);
    EXPECT_NEAR(run.link().weight, 0.25 * k, 1e-12);
    EXPECT_GT(run.out.force_n.z, last);
    last = run.out.force_n.z;
  }
}

TEST(Tick, ADecreasingClockGivesNoDamping) {
  ChainDriver run({hold_height("a", 1)});
  run.program.links[0].active_when.button = 1;
  run.program.coupling.ramp_s = 0.25;
  run.program.coupling.damping_ns_per_m = 5;
  run.at(1, {0, 0, 0});
  EXPECT_DOUBLE_EQ(run.at(1.125, {0, 0, 0}, 1).links[0].weight, 0.5);
  EXPECT_DOUBLE_EQ(run.at(0.5, {0.1, 0, 0}, 1).links[0].weight, 0.5);
  EXPECT_EQ(run.out.force_n.x, 0);
  EXPECT_DOUBLE_EQ(run.out.force_n.z, 250);
  EXPECT_DOUBLE_EQ(run.at(0.5625, {0.1, 0, 0}, 1).links[0].weight, 0.75);
}

TEST(Tick, AForceSwitchActivatesALinkOneTickLater) {
  ChainDriver run({hold_height("a", 1, 5), hold_height("b", 2, 5)}, 8);
  run.program.links[1].active_when.force_above_n = 3;
  EXPECT_FALSE(run.at(0, {0, 0, 0.9}).links[1].active);
  run.at(1, {0, 0, 0});  // 5 N
  EXPECT_FALSE(run.link(1).active);
  EXPECT_TRUE(run.at(2, {0, 0, 0}).links[1].active);
}

TEST(Tick, AllocatesNothing) {
  ChainDriver run({hold_height("a", 1), hold_height("b", 2)}, 8);
  const AllocationCounter guard;
  for (int k = 0; k < 1000; ++k) run.at(0.001 * k, {0.001 * k, 0, 0});
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
  ChainDriver run({hold_height("a", 1), hold_height("b", 2)}, 8);
  run.at(0, {0, 0, 0});
  HapticProgram next = run.program;
  std::swap(next.links[0], next.links[1]);
  next.links[1].constraint = std::make_shared<test::HoldHeight>(5.0);
  run.replace(next);
  EXPECT_TRUE(run.state.links[0].started);
  EXPECT_EQ(run.state.links[0].proxy.z, 2);
  EXPECT_FALSE(run.state.links[1].started);
}

}  // namespace tick_test
