// SPDX-License-Identifier: MIT
// Rows of the coupling: rates, irregular clocks, and spring stiffness from zero to far above the passive limit.
#include "haptics/device/registry.h"
#include "haptics/servo/device_limits.h"
#include "tests/acceptance/chain_fixture.h"
#include "tests/limits/limits_table.h"
#include "tests/limits/probe_path.h"
#include "tests/support/closed_loop.h"
#include "tests/support/simple_links.h"

namespace catena::extremes {
namespace coupling_limits_test {

using acceptance::ChainRig;
using acceptance::HapticProgram;
using acceptance::make_program;
using haptics::bitwise_equal;
using test::ClosedLoop;

constexpr double kMass = 0.159, kDamping = 0.5;  ///< of the mechanism, in kg and N s/m
constexpr double kRates[] = {100, 333, 1000, 5000, 10000, 20000};

/// A line, a ball and a floor that all hold the hand.
std::string chain(const std::string& coupling) {
  return R"({"fields": {"v": {"analytic": "circle"}, "s": {"analytic": "sphere"}},
    "chain": [{"name": "line", "type": "streamline", "field": "v", "seed": [0.8, 0, 0]},
              {"name": "ball", "type": "isosurface", "field": "s", "level": 0.7},
              {"name": "floor", "type": "plane", "point": [0, 0, -0.3], "normal": [0, 0, 1]}],
    "coupling": {)" +
         coupling + R"(}, "workspace": {"metres_per_unit": 0.05}})";
}

std::string the_same_place_at_any_rate() {
  const auto program = make_program(chain(R"("stiffness": 500, "max_force": 100)"));
  std::vector<Vec3> proxies, forces;
  for (const double rate : kRates) {
    ChainRig rig(program);
    // 2 s of a hand at 0.1 m/s, then 1 s of rest
    const int ticks = static_cast<int>(3 * rate);
    for (int i = 0; i < ticks; ++i) {
      const double t = std::min(i / rate, 2.0), a = 2.5 * t;
      rig.step_at(i / rate, {(0.8 + 0.1 * std::sin(5 * a)) * std::cos(a), 0.8 * std::sin(a), 0.1 * std::sin(7 * a)});
    }
    for (std::size_t k = 0; k < 3; ++k) proxies.push_back(rig.proxy(k));
    forces.push_back(rig.out.force_n);
  }
  double off = 0, force = 0;
  for (std::size_t i = 3; i < proxies.size(); ++i) off = std::max(off, norm(proxies[i] - proxies[i % 3]) / 4);
  for (const Vec3& f : forces) force = std::max(force, norm(f - forces[0]));
  return Findings()
      .at_most("distance of the proxies between rates", off, 1e-9, "L")
      .at_most("difference of the forces between rates", force, 1e-6, "N")
      .add(norm(forces[0]) > 0.1 ? "held" : "free");
}

std::string an_irregular_clock() {
  // a hand at constant speed: the damping force depends on the speed only, for any steps
  const auto program = make_program(R"({"chain": [{"name": "a", "type": "line", "point": [0, 0, 0], "direction": [1, 0, 0]}],
    "coupling": {"stiffness": 500, "damping": 3, "max_force": 100}, "workspace": {"metres_per_unit": 0.05}})");
  ChainRig rig(program);
  haptics::tests::Random random(11);
  double t = 0, off = 0;
  const double speed = 0.2;  // units per second
  for (int i = 0; i < 20000; ++i) {
    rig.step_at(t, {speed * t, 0, 0});
    if (i > 0) off = std::max(off, norm(rig.out.force_n + Vec3(3 * 0.05 * speed, 0, 0)));
    t += std::exp(random.uniform(std::log(1e-5), std::log(0.1)));
  }
  return Findings().at_most("difference of the damping force from b v", off, 1e-9, "N");
}

// ---- springs on a mechanism ----

haptics::SimulatedDeviceParameters bare(double period_s) {
  haptics::SimulatedDeviceParameters p;
  p.mass_kg = kMass;
  p.device_damping_ns_per_m = kDamping;
  p.grip_stiffness_n_per_m = p.grip_damping_ns_per_m = 0;
  p.period_s = period_s;
  p.max_force_n = 1e9;
  return p;
}

HapticProgram spring(double stiffness) {
  HapticProgram p;
  p.links = {test::hold_height("a", 0, stiffness)};
  p.coupling.max_force_n = 1e9;
  return p;
}

/// Maximum kinetic energy after the release of a spring from rest, divided by the spring's energy: above 1 energy was generated.
double gain(const HapticProgram& p, double stiffness, double period_s, int ticks) {
  ClosedLoop loop(p, bare(period_s), {{0, {0, 0, 0.01}}});
  double maximum = 0;
  for (int i = 0; i < ticks; ++i) {
    loop.step();
    maximum = std::max(maximum, -loop.min_passivity_j);
  }
  return maximum / (0.5 * stiffness * 1e-4);
}

std::string the_passive_limit_at_any_rate() {
  double below = 0, above = 1e300;
  for (const double rate : kRates) {
    const double limit = 2 * kDamping * rate;
    below = std::max(below, gain(spring(0.99 * limit), 0.99 * limit, 1 / rate, 6000));
    above = std::min(above, gain(spring(1.01 * limit), 1.01 * limit, 1 / rate, 6000));
  }
  return Findings()
      .at_most("at 0.99 of the limit, returned per stored energy", below, 1, {})
      .add(above > 1 ? "at 1.01 of it, more than was stored at every rate" : "at 1.01 of it, no more than was stored at some rate");
}

std::string far_past(const std::vector<double>& rates, double bound_j) {
  double maximum = 0, end = 0;
  bool finite = true;
  for (const double rate : rates)
    for (const double times : {10.0, 100.0, 1000.0}) {
      const double stiffness = times * 2 * kDamping * rate;
      haptics::DeviceSettings settings;
      settings.stiffness_cap = haptics::DeviceSettings::StiffnessCap::value;
      settings.stiffness_cap_n_per_m = stiffness;
      settings.ramp_in_s = 0;
      haptics::SimulatedDeviceParameters hand = haptics::desktop_device_parameters();
      hand.period_s = 1 / rate;
      hand.grip_stiffness_n_per_m = 300;
      hand.grip_damping_ns_per_m = 3;
      ClosedLoop probe(spring(1), hand, {{0, {0, 0, 0.01}}});
      HapticProgram p = spring(stiffness);
      p.limits = compute_device_limits(probe.device.capabilities(), settings);
      ClosedLoop loop(p, hand, {{0, {0, 0, 0.01}}});
      loop.run(static_cast<int>(2 * rate));
      double kinetic = 0;
      for (int i = 0; i < static_cast<int>(rate); ++i) {
        finite = finite && is_finite(loop.step().force_n) && std::isfinite(loop.out.energy_j) && loop.out.dissipated_j >= 0;
        maximum = std::max(maximum, norm(loop.out.force_n));
        kinetic = std::max(kinetic, loop.kinetic_j());
      }
      end = std::max(end, kinetic);
    }
  return Findings()
      .add(finite ? "forces and energies are finite" : "a force or an energy is not finite")
      .at_most("force above 10 N by", maximum - 10, 1e-10, "N")
      .at_most("a second later the grip's kinetic energy is", end, bound_j, "J");
}

// 0.015 J: the energy of the grip's spring of 300 N/m at 10 mm
std::string far_past_the_limit() { return far_past({1000, 10000}, 0.015); }
std::string far_past_the_limit_at_100_hz() { return far_past({100}, 0.1); }

std::string no_spring() {
  ChainRig none(make_program(chain(R"("stiffness": 0, "max_force": 8)"))), some(make_program(chain(R"("stiffness": 500, "max_force": 8)")));
  long long same = 0, zero = 0;
  constexpr int kTicks = 1000;
  for (int i = 0; i < kTicks; ++i) {
    zero += max_abs(none.step_to(probe_at(i)).force_n) == 0;
    some.step_to(probe_at(i));
    same += norm(none.proxy(2) - some.proxy(2)) <= 1e-9 * 4;
  }
  return Findings().all("no force", zero, kTicks).all("the same proxies as with 500 N/m", same, kTicks);
}

std::string springs_beyond_everything() {
  long long right = 0, asked = 0;
  for (const char* stiffness : {"1e6", "1e12", "1e30"}) {
    ChainRig rig(make_program(chain(std::string(R"("max_force": 8, "damping": 1, "stiffness": )") + stiffness)));
    for (int i = 0; i < 1000; ++i, ++asked) {
      const auto& out = rig.step_to(probe_at(i));
      bool ok = is_finite(out.force_n) && norm(out.force_n) <= 8 * (1 + 1e-12) && std::isfinite(out.energy_j);
      for (std::size_t k = 0; k < 3; ++k) ok = ok && is_finite(out.links[k].proxy) && std::isfinite(out.links[k].accounted_j);
      right += ok;
    }
  }
  return Findings().all("proxies, force and energies are finite, and the force is at most 8 N", right, asked);
}

}  // namespace coupling_limits_test

Group coupling_rows() {
  using namespace coupling_limits_test;
  return {
      "Clocks and stiffness",
      {
          {"TheSamePlaceAtAnyRate",
           "The same motion of two seconds at 100 Hz to 20 kHz on a line, a sphere and a plane, then one second at rest",
           "distance of the proxies between rates at most 1e-09 L; difference of the forces between rates at most 1e-06 N; held",
           the_same_place_at_any_rate},
          {"AnIrregularClock", "Time steps of 10 us to 0.1 s in random order; probe at constant velocity v, damping b",
           "difference of the damping force from b v at most 1e-09 N", an_irregular_clock},
          proved_elsewhere("A clock that stops or runs backwards", "the tick counts as zero seconds",
                           "Tick.ADecreasingClockGivesNoDamping"),
          proved_elsewhere("Late or missing ticks", "the force is held for five ticks, then ramped to zero",
                           "ForceLimiter.LateTicksHoldThenRampOutLinearlyIn20ms"),
          {"ThePassiveLimitAtAnyRate", "Springs just below and above the limit 2 b / T at 100 Hz to 20 kHz, released from rest",
           "at 0.99 of the limit, returned per stored energy at most 1; at 1.01 of it, more than was stored at every rate",
           the_passive_limit_at_any_rate},
          proved_elsewhere("The largest stable stiffness at 1 kHz, without and with a delay of one sample",
                           "equal to linear theory within 0.1 %", "ClosedLoopTest.TheLargestStableStiffnessMatchesTheTable"),
          proved_elsewhere("Stiffness 1.1 to 10 times the limit, with the passivity controller",
                           "no energy is gained, and the motion dies out",
                           "ClosedLoopTest.AboveThePassiveLimitTheControllerStopsEnergyGrowth"),
          {"FarPastTheLimit",
           "Stiffness 10, 100 and 1000 times the limit at 1 and 10 kHz, with a simulated hand, the device's limits and the controller",
           "forces and energies are finite; force above 10 N by at most 1e-10 N; a second later the grip's kinetic energy is at most 0.015 "
           "J",
           far_past_the_limit},
          {"FarPastTheLimitAt100Hz", "The same at 100 Hz",
           "forces and energies are finite; force above 10 N by at most 1e-10 N; a second later the grip's kinetic energy is at most 0.1 J",
           far_past_the_limit_at_100_hz,
           "At most 0.015 J, as at higher rates. The controller adds at most m / (4 T) of damping, which is too little at 100 Hz. It "
           "occurs only with a `stiffness_cap` above the default, which is the safe stiffness"},
          {"NoSpring", "Stiffness 0", "no force in every case; the same proxies as with 500 N/m in every case", no_spring},
          {"SpringsBeyondEverything", "Stiffness 1e6, 1e12 and 1e30 N/m without a device limit",
           "proxies, force and energies are finite, and the force is at most 8 N in every case", springs_beyond_everything},
      }};
}

}  // namespace catena::extremes
