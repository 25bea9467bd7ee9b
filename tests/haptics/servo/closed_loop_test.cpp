// SPDX-License-Identifier: MIT
// The closed loop of tick and simulated mechanism: the derived linear stability limits, the passive limit, and the passivity
// controller's effect on stiffer springs. Unpaced and deterministic.
#include <gtest/gtest.h>

#include <cmath>
#include <glm/matrix.hpp>
#include <limits>

#include "haptics/device/mass_model.h"
#include "tests/support/closed_loop.h"
#include "tests/support/simple_links.h"

namespace catena::haptics::closed_loop_test {
using test::ClosedLoop;

constexpr double kMass = 0.159, kDamping = 0.5, kPeriod = 1e-3;

SimulatedDeviceParameters bare(double delay_s = 0) {
  return {.mass_kg = kMass,
          .grip_stiffness_n_per_m = 0,
          .grip_damping_ns_per_m = 0,
          .device_damping_ns_per_m = kDamping,
          .delay_s = delay_s,
          .max_force_n = 1e9};
}

/// A spring towards z = 0 with virtual damping.
HapticProgram spring(double stiffness, double damping = 0) {
  HapticProgram p;
  p.links = {test::hold_height("a", 0, stiffness)};
  p.coupling.damping_ns_per_m = damping;
  p.coupling.max_force_n = 1e9;
  return p;
}

void control(HapticProgram& p, double delay_s = 0) {
  p.limits.passivity_control = true;
  p.limits.damping_ns_per_m = kDamping;
  p.limits.delay_s = delay_s;
  p.limits.max_added_damping_ns_per_m = 0.25 * kMass / (kPeriod + delay_s);
}

// ---- an independent result: the sampled-data system's characteristic polynomial and its Schur-Cohn test ----

/// States: x, v, the previous x and, with a delay of one sample, the pending force. Mass and damper under a held force are exact.
bool is_stable(double stiffness, double damping, bool delayed) {
  const int n = delayed ? 4 : 3;
  const double rate = kDamping / kMass, e = std::exp(-rate * kPeriod), p = (1 - e) / rate;
  const double to_x = (kPeriod - p) / kDamping, to_v = p / kMass;
  const glm::dvec4 law(-stiffness - damping / kPeriod, 0, damping / kPeriod, 0), waiting(0, 0, 0, 1);
  const glm::dvec4& acts = delayed ? waiting : law;
  const glm::dmat4 a = glm::transpose(glm::dmat4(to_x * acts + glm::dvec4(1, p, 0, 0), to_v * acts + glm::dvec4(0, e, 0, 0),
                                                 glm::dvec4(1, 0, 0, 0), delayed ? law : glm::dvec4(0.0)));

  // Faddeev-LeVerrier algorithm
  std::vector<double> c{1};
  glm::dmat4 m(0.0);
  for (int k = 1; k <= n; ++k) {
    m = a * m + glm::dmat4(c.back());
    const glm::dmat4 am = a * m;
    c.push_back(-(am[0][0] + am[1][1] + am[2][2] + am[3][3]) / k);
  }
  while (c.size() > 1) {
    if (std::fabs(c.back()) >= std::fabs(c.front())) return false;
    const double r = c.back() / c.front();
    std::vector<double> less(c.size() - 1);
    for (std::size_t i = 0; i < less.size(); ++i) less[i] = c[i] - r * c[c.size() - 1 - i];
    c = less;
  }
  return true;
}

/// True if an initial displacement decays in the closed loop of tick and simulated mechanism.
bool settles(double stiffness, double damping, double delay_s) {
  const HapticProgram p = spring(stiffness, damping);
  ClosedLoop loop(p, bare(delay_s), {{0, {0, 0, 1e-3}}});
  const auto energy = [&] { return loop.kinetic_j() + 0.5 * stiffness * loop.device.position_m().z * loop.device.position_m().z; };
  const auto max_energy_over = [&](int ticks) {
    double max_j = 0;
    for (int i = 0; i < ticks; ++i) {
      loop.step();
      const double now = energy();
      if (!(now < 1e6 * stiffness * 1e-6)) return std::numeric_limits<double>::infinity();
      max_j = std::max(max_j, now);
    }
    return max_j;
  };
  loop.run(300);
  const double before = max_energy_over(300);
  for (int i = 0; i < 20; ++i)
    if (!(max_energy_over(300) < 1e3 * before)) return false;
  return max_energy_over(300) < before;
}

template <class F>
double bisect(double lo, double hi, double relative, const F& stable) {
  while (hi - lo > relative * lo) {
    const double mid = 0.5 * (lo + hi);
    (stable(mid) ? lo : hi) = mid;
  }
  return 0.5 * (lo + hi);
}

TEST(ClosedLoopTest, TheLargestStableStiffnessMatchesTheTable) {
  struct Limit {
    double damping, without_delay, with_delay;  ///< derived
  };
  for (const Limit& row : {Limit{0, 994, 332}, Limit{5, 10585, 3535}, Limit{20, 36061, 11660}, Limit{50, 73324, 21522}})
    for (const bool delayed : {false, true}) {
      const double expected = delayed ? row.with_delay : row.without_delay;
      const double derived = bisect(0.5 * expected, 2 * expected, 1e-9, [&](double k) { return is_stable(k, row.damping, delayed); });
      EXPECT_NEAR(derived / expected, 1, 0.01) << "B " << row.damping << (delayed ? " delayed" : "");
      const double measured =
          bisect(0.9 * expected, 1.1 * expected, 5e-4, [&](double k) { return settles(k, row.damping, delayed ? kPeriod : 0); });
      EXPECT_NEAR(measured / derived, 1, 1e-3) << "B " << row.damping << (delayed ? " delayed" : "");
    }
  // more damping is not always better
  EXPECT_NEAR(bisect(1e4, 3e4, 1e-9, [&](double k) { return is_stable(k, 100, true); }), 17358, 0.01 * 17358);
  EXPECT_FALSE(is_stable(1, 200, true));
  EXPECT_FALSE(settles(1, 200, kPeriod));
}

double max_kinetic_j(ClosedLoop& loop, int ticks) {
  double max_j = 0;
  for (int i = 0; i < ticks; ++i) {
    loop.step();
    max_j = std::max(max_j, loop.kinetic_j());
  }
  return max_j;
}

/// min(E + int b v^2) / E0 over 4 s of a spring that is released from rest.
double min_relative_energy(const HapticProgram& p, double stiffness, double delay_s = 0) {
  ClosedLoop loop(p, bare(delay_s), {{0, {0, 0, 0.01}}});
  // measured on the mass: energy that the spring gave and the damping did not dissipate is kinetic
  return -max_kinetic_j(loop, 4000) / (0.5 * stiffness * 1e-4);
}

TEST(ClosedLoopTest, TheEnergyCriterionSeparates990From1010NewtonsPerMetre) {
  EXPECT_NEAR(min_relative_energy(spring(990), 990), -0.9993, 5e-4);
  EXPECT_LT(min_relative_energy(spring(1010), 1010), -1.1);
  EXPECT_GT(min_relative_energy(spring(1010), 1010), -1.15);
}

TEST(ClosedLoopTest, ThePassivityObserverFindsTheSameLimit) {
  // E + int b v^2: the test's own sum of the work, and the observer's balance
  for (const double k : {990.0, 999.0, 1001.0, 1010.0}) {
    HapticProgram p = spring(k);
    p.limits.damping_ns_per_m = kDamping;
    ClosedLoop loop(p, bare(), {{0, {0, 0, 0.01}}});
    loop.run(4000);
    const double e0 = 0.5 * k * 1e-4;
    EXPECT_EQ(loop.min_passivity_j / e0<-1.0001, k> 1000) << k;
    EXPECT_EQ(loop.state->passivity.balance_j<-1e-6 * e0, k> 1000) << k;
    EXPECT_NEAR(loop.state->passivity.exempt_j, e0, 1e-12) << "the spring was tight when it began";
  }
}

TEST(ClosedLoopTest, TheLedgerEqualsTheWorkDone) {
  const HapticProgram p = spring(800, 1);
  ClosedLoop loop(p, bare(), {{0, {0, 0, 0.01}}});
  for (int i = 0; i < 500; ++i) {
    loop.step();
    const PassivityState& ledger = loop.state->passivity;
    // one link and the coupling's damping: the link's ledger has only the spring's energy
    const double stored = loop.out.links[0].energy_j(1);
    ASSERT_NEAR(ledger.stored_j[0], stored, 1e-15);
    ASSERT_NEAR(loop.out.links[0].accounted_j, ledger.work_j[0] + stored, 1e-15);
  }
  EXPECT_GT(loop.state->passivity.work_j[0], loop.energy_to_device_j) << "the damping has taken some of it";
}

TEST(ClosedLoopTest, BelowThePassiveLimitTheControllerLeavesTheForceUnchanged) {
  HapticProgram with = spring(990), without = spring(990);
  control(with);
  ClosedLoop a(with, bare(), {{0, {0, 0, 0.01}}}), b(without, bare(), {{0, {0, 0, 0.01}}});
  for (int i = 0; i < 4000; ++i) {
    a.step();
    b.step();
    ASSERT_TRUE(bitwise_equal(a.out.force_n, b.out.force_n)) << i;
  }
  EXPECT_EQ(a.out.dissipated_j, 0);
}

TEST(ClosedLoopTest, AboveThePassiveLimitTheControllerStopsEnergyGrowth) {
  for (const double delay_s : {0.0, 1e-3, 1.5e-3})
    for (const double times : {1.1, 2.0, 5.0, 10.0}) {
      const double limit = 2 * kDamping / (kPeriod + 2 * delay_s), k = times * limit;
      HapticProgram without = spring(k), with = spring(k);
      control(with, delay_s);
      EXPECT_LT(min_relative_energy(without, k, delay_s), times > 2 ? -1000 : -2) << k << " " << delay_s;
      EXPECT_GT(min_relative_energy(with, k, delay_s), -1.05) << k << " " << delay_s;

      // the oscillation decays, slowly near the limit
      ClosedLoop loop(with, bare(delay_s), {{0, {0, 0, 0.01}}});
      loop.run(20000);
      EXPECT_LT(loop.kinetic_j(), (times >= 2 ? 0.5 : 1) * 0.5 * k * 1e-4) << k << " " << delay_s;
      EXPECT_GT(loop.out.dissipated_j, 0);
    }
}

/// Free for z > 0, held on z = 0 below.
class Wall final : public Constraint {
 public:
  void start(const Vec3& probe, LinkState& state, LinkScratch&) const noexcept override { state.proxy = probe; }
  void advance(const Vec3& probe, LinkState& state, LinkScratch&) const noexcept override {
    state.proxy = {probe.x, probe.y, probe.z < 0 ? 0 : probe.z};
    state.status = probe.z < 0 ? LinkStatus::ok : LinkStatus::free;
  }
};

HapticProgram wall(double stiffness) {
  HapticProgram p;
  Link link;
  link.name = "wall";
  link.constraint = std::make_shared<Wall>();
  link.stiffness_n_per_m = stiffness;
  p.links = {link};
  p.coupling.max_force_n = 1e9;
  return p;
}

/// Maximum kinetic energy in the last 0.5 s of 4 s, of a trembling hand that pushes 10 mm into a wall.
double unrest_j(const HapticProgram& p, SimulatedDeviceParameters hand) {
  hand.grip_stiffness_n_per_m = 500;
  hand.grip_damping_ns_per_m = 0.2;
  hand.tremor_m = 2e-5;
  ClosedLoop loop(p, hand, {{0, {0, 0, 0.01}}, {0.1, {0, 0, -0.01}}});
  loop.run(3500);
  return max_kinetic_j(loop, 500);
}

TEST(ClosedLoopTest, AWallIsStableWithDelayAndEncoders) {
  const double push_j = 0.5 * 500 * 1e-4;  // the energy of the hand's grip spring
  for (const double delay_s : {0.0, 1e-3, 1.5e-3})
    for (const double step_m : {0.0, 4e-5}) {
      SimulatedDeviceParameters hand = bare(delay_s);
      hand.encoder_step_m = step_m;
      hand.friction_n = step_m > 0 ? 0.1 : 0;
      const double safe = safe_stiffness(SimulatedDevice({{}}, hand).capabilities().mechanics, kPeriod).min_n_per_m();
      EXPECT_LT(unrest_j(wall(0.9 * safe), hand), 0.01 * push_j) << "below the limit: " << delay_s << " " << step_m;
      const double stiff = 8 * safe;
      EXPECT_GT(unrest_j(wall(stiff), hand), 10 * push_j) << "above it, without the controller: " << delay_s << " " << step_m;
      HapticProgram controlled = wall(stiff);
      control(controlled, delay_s);
      EXPECT_LT(unrest_j(controlled, hand), 0.01 * push_j) << "above it, with the controller: " << delay_s << " " << step_m;
    }
}

TEST(ClosedLoopTest, TheStiffnessCapMakesAStiffWallStable) {
  SimulatedDeviceParameters hand = bare();
  HapticProgram p = wall(20000);
  EXPECT_GT(unrest_j(p, hand), 1);
  p.limits.max_stiffness_n_per_m = safe_stiffness(SimulatedDevice({{}}, hand).capabilities().mechanics, kPeriod).min_n_per_m() * 0.9;
  EXPECT_LT(unrest_j(p, hand), 1e-4);
}

}  // namespace catena::haptics::closed_loop_test
