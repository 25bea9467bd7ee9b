// SPDX-License-Identifier: MIT
// A slow hand on noisy data: the proxy stays on its sheet with bounded steps, so that the force never jumps; friction keeps its proxy.
#include "tests/acceptance/chain_fixture.h"
#include "tests/acceptance/reference_numerics.h"

namespace catena::acceptance::noisy_surface_test {

using haptics::tests::Random;
using haptics::tests::Rig;

constexpr double kStiffness = 800, kMetres = 0.05, kMaxForce = 8, kLevel = 0.6;
constexpr int kNodes = 96;
#ifdef CATENA_SANITIZED
constexpr int kTicks = 6000;
#else
constexpr int kTicks = 60000;
#endif

/// A ball with voxel noise of up to 0.05, which gives shells, islands and holes near the level.
std::shared_ptr<const field::ScalarGrid> noisy_ball() {
  Random random(7);
  const double h = 2.0 / (kNodes - 1);
  return haptics::tests::sample_scalar_grid(field::Mapping::from_linear(Mat3(h), Vec3(-1.0)), {kNodes, kNodes, kNodes},
                                            [&](const Vec3& p) { return norm(p) + random.uniform(-0.05, 0.05); });
}

/// A hand's path at 0.2 L/s around the shell, in and out of it.
struct Hand {
  Random random{11};
  Vec3 at{0.55, 0.1, 0.1}, way{0.0, 1.0, 0.0};
  double step;
  explicit Hand(double length) : step(2e-4 * length) {}
  const Vec3& next() {
    way = direction(way + random.unit() * 0.1);
    if (norm(at) > 0.72 || norm(at) < 0.4) way = direction(at) * (norm(at) > 0.6 ? -1.0 : 1.0);
    return at += way * step;
  }
};

std::shared_ptr<const HapticProgram> program_on(const std::vector<haptics::tests::ConstraintPtr>& constraints) {
  auto program = std::make_shared<HapticProgram>(*make_program(constraints));
  for (haptics::Link& link : program->links) link.stiffness_n_per_m = kStiffness;
  program->meters_per_unit = kMetres;
  program->coupling.max_force_n = kMaxForce;
  return program;
}

void follow(const std::string& side) {
  const auto grid = noisy_ball();
  const auto constraint = haptics::tests::isosurface(grid, kLevel, side);
  ChainRig chain(program_on({constraint}));
  Rig unlimited(constraint);
  Hand hand(grid->domain_length());
  const double newtons_per_unit = kStiffness * kMetres, voxel = grid->max_voxel_edge();
  Vec3 last_probe(0.0), last_proxy(0.0), last_force(0.0), last_unlimited(0.0);
  double worst_move = 0, worst_step = 0, worst_unlimited = 0, worst_rise = 0;
  int held = 0, waits = 0;
  for (int i = 0; i < kTicks; ++i) {
    const Vec3 probe = hand.next();
    const Vec3 force = chain.step_to(probe).coupling_force_n;
    unlimited.tick(probe);
    const double gap = norm(probe - last_proxy), dx = norm(probe - last_probe);
    if (i > 0) {
      // in units of the bound
      const double slip = std::max(0.05 * kMaxForce / newtons_per_unit, 0.05 * gap);
      worst_move = std::max(worst_move, (norm(chain.proxy() - last_proxy) - dx) / slip);
      worst_step = std::max(worst_step, norm(force - last_force) / (0.05 * kMaxForce));
      worst_unlimited = std::max(worst_unlimited, norm(unlimited.state.proxy - last_unlimited) / voxel);
      if (chain.status() == LinkStatus::ok) worst_rise = std::max(worst_rise, norm(probe - chain.proxy()) - gap);
    }
    held += chain.status() == LinkStatus::ok;
    waits += chain.status() == LinkStatus::budget;
    last_probe = probe;
    last_proxy = chain.proxy();
    last_force = force;
    last_unlimited = unlimited.state.proxy;
  }
  const std::string who = "noisy ball" + side + ": ";
  expect_at_most(who + "move beyond |dx|, of 0.05 max_force / (K S)", worst_move, 1);
  expect_at_most(who + "step of the force, of 0.05 max_force", worst_step, 1);
  record_results(who, {{"ticks on the way", waits}, {"largest move without the limit, voxels", worst_unlimited}});
  EXPECT_GT(held, kTicks / 10);
  EXPECT_LE(worst_rise, 1e-9);
#ifndef CATENA_SANITIZED
  EXPECT_GT(worst_unlimited, 3) << "the path has no jump to hold back";
#endif
}

TEST(NoisySurface, TwoSidedTheProxysStepsAreBounded) { follow(""); }
TEST(NoisySurface, FreeAboveTheProxysStepsAreBounded) { follow(R"(, "free": "above")"); }
TEST(NoisySurface, FreeBelowTheProxysStepsAreBounded) { follow(R"(, "free": "below")"); }

// A hand between two sheets of a gyroid: the held point stops being the closest of its own sheet, and the next one is far along it.
// A point that was already nearer to the last probe is not a moved closest point: the proxy walks to it, at any step of the hand.
TEST(NoisySurface, OnlyAMovingClosestPointMayExceedTheStepBound) {
  const auto grid =
      haptics::tests::sample_scalar_grid(field::Mapping::from_linear(Mat3(2.0 / 47), Vec3(-1.0)), {48, 48, 48}, [](const Vec3& p) {
        const Vec3 q = p * 6.0;
        return std::sin(q.x) * std::cos(q.y) + std::sin(q.y) * std::cos(q.z) + std::sin(q.z) * std::cos(q.x);
      });
  ChainRig chain(program_on({haptics::tests::isosurface(grid, 0)}));
  Hand hand(grid->domain_length());
  Vec3 last_probe(0.0), last_proxy(0.0);
  int jumps = 0, moved = 0;
  for (int i = 0; i < kTicks; ++i) {
    const Vec3 probe = hand.next();
    chain.step_to(probe);
    if (i > 0) {
      const double gap = norm(probe - last_proxy), slip = std::max(0.05 * kMaxForce / (kStiffness * kMetres), 0.05 * gap);
      if (norm(chain.proxy() - last_proxy) > norm(probe - last_probe) + slip) {
        const bool was_nearer = norm(last_probe - chain.proxy()) < norm(last_probe - last_proxy) - 1e-8 * grid->domain_length();
        ++(was_nearer ? jumps : moved);
      }
    }
    last_probe = probe;
    last_proxy = chain.proxy();
  }
  record_result("gyroid: moves of the closest point itself beyond the travel", moved);
  EXPECT_EQ(jumps, 0);
  EXPECT_LT(moved, kTicks / 1000);
}

TEST(NoisySurface, FrictionKeepsItsProxyIfAReprojectionFails) {
  const auto grid = noisy_ball();
  haptics::tests::Fields fields;
  fields.named["f"].scalar = grid;
  const auto surface = haptics::tests::isosurface(grid, kLevel);
  const auto drag = haptics::tests::build(R"({"name": "d", "type": "drag", "threshold": 0.03, "surface": "f", "level": 0.6})", fields);
  ChainRig chain(program_on({surface, drag}));
  Hand hand(grid->domain_length());
  LinkStatus before = LinkStatus::ok;
  int lost = 0, at_once = 0, budget_ticks = 0;
  for (int i = 0; i < kTicks; ++i) {
    chain.step_to(hand.next());
    const LinkStatus now = chain.status(1);
    lost += now == LinkStatus::no_surface;
    at_once += now == LinkStatus::no_surface && before == LinkStatus::ok;
    budget_ticks += now == LinkStatus::budget;
    before = now;
  }
  record_results("noisy ball, drag: ", {{"ticks with a proxy kept", budget_ticks}, {"ticks that lose it", lost}});
#ifndef CATENA_SANITIZED
  EXPECT_GT(budget_ticks, 0) << "no reprojection fails on this path";
#endif
  EXPECT_EQ(at_once, 0);
}

}  // namespace catena::acceptance::noisy_surface_test
