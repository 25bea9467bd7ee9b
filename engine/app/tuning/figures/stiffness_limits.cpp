// SPDX-License-Identifier: MIT
/// Figure "stiffness": the largest spring stiffness that a device can render, against its damping, the servo's rate, the delay and the
/// virtual damping. Measured with the actual tick and the simulated mechanism: a plane, a mass of 0.159 kg released 1 mm from it.
///   stiffness-damping.csv  the device's own damping, at 1, 2 and 4 kHz, and at 1 kHz with a period of delay
///   stiffness-delay.csv    the delay, 0.5 N s/m at 1 kHz
///   stiffness-virtual.csv  the coupling's damping, 0.5 N s/m at 1 kHz without and with a period of delay
/// Columns: passive, the derived limit 2 b / (T + 2 t_d) (haptics/device/mass_model.h); stable, the largest spring at which
/// the oscillation decays; controlled, the largest of an increasing series (steps of a quarter) at which the passivity controller still
/// keeps the energy within 5 % of what the spring had at the start.
#include <cmath>
#include <numbers>

#include "engine/app/cli/command.h"
#include "engine/app/tuning/figures/figures.h"
#include "engine/app/tuning/figures/stiffness_limits.h"
#include "haptics/build/build_program.h"
#include "haptics/chain/tick.h"
#include "haptics/device/mass_model.h"
#include "haptics/device/simulated_device.h"
#include "haptics/servo/device_limits.h"

namespace catena::app {

namespace {

constexpr double kStart_m = 1e-3, kDamping = 0.5;
constexpr double kDampings[] = {0.05, 0.1, 0.2, 0.5, 1, 2, 5, 10, 20};
constexpr double kDelays_ms[] = {0, 0.25, 0.5, 1, 1.5, 2, 3, 4, 5};
constexpr double kVirtual[] = {0, 1, 2, 5, 10, 20, 35, 50, 75, 100, 125, 150, 175, 200};

using Setting = StiffnessSetting;

haptics::HapticProgram plane_program(const Setting& setting, double stiffness, bool controlled) {
  auto scene = scene::parse_scene(R"({"chain": [{"name": "plane", "type": "plane", "point": [0, 0, 0], "normal": [0, 0, 1]}]})", "figure");
  CATENA_ASSERT(static_cast<bool>(scene));
  auto made = haptics::build_program(*scene);
  CATENA_ASSERT(static_cast<bool>(made));
  haptics::HapticProgram program = **made;
  program.links[0].stiffness_n_per_m = stiffness;
  program.coupling.damping_ns_per_m = setting.virtual_damping;
  program.coupling.max_force_n = 1e12;
  if (controlled) {
    program.limits.passivity_control = true;
    program.limits.damping_ns_per_m = setting.damping;
    program.limits.delay_s = setting.delay_s;
    program.limits.max_added_damping_ns_per_m = haptics::max_added_damping(setting.mass_kg, 1 / setting.rate_hz, setting.delay_s);
  }
  return program;
}

haptics::SimulatedDeviceParameters mechanism_of(const Setting& setting) {
  haptics::SimulatedDeviceParameters p;
  p.mass_kg = setting.mass_kg;
  p.grip_stiffness_n_per_m = p.grip_damping_ns_per_m = 0;
  p.device_damping_ns_per_m = setting.damping;
  p.delay_s = setting.delay_s;
  p.period_s = 1 / setting.rate_hz;
  p.max_force_n = 1e12;
  return p;
}

/// The mass on the plane's spring: the largest energy in each of eight windows of one and a half oscillations.
class Swing {
 public:
  Swing(const Setting& setting, double stiffness, bool controlled)
      : program_(plane_program(setting, stiffness, controlled)),
        hand_({{0, {0, 0, kStart_m}}}, mechanism_of(setting)),
        state_(std::make_unique<haptics::ChainState>()),
        scratch_(std::make_unique<haptics::ChainScratch>()),
        period_s_(1 / setting.rate_hz),
        stiffness_(stiffness),
        mass_kg_(setting.mass_kg) {
    window_ = std::max(300, static_cast<int>(1.5 * 2 * std::numbers::pi * std::sqrt(mass_kg_ / stiffness) / period_s_));
  }
  double start_j() const { return 0.5 * stiffness_ * kStart_m * kStart_m; }
  double window() {
    double maximum = 0;
    for (int i = 0; i < window_; ++i) {
      const haptics::DeviceInput input = hand_.read();
      haptics::tick(program_, {period_s_ * static_cast<double>(ticks_++), input.position_m}, *state_, *scratch_, out_);
      hand_.write({out_.force_n, Vec3(0.0)});
      kinetic_ = std::max(kinetic_, 0.5 * mass_kg_ * dot(hand_.velocity_m_per_s(), hand_.velocity_m_per_s()));
      maximum = std::max(maximum, 0.5 * mass_kg_ * dot(hand_.velocity_m_per_s(), hand_.velocity_m_per_s()) +
                                      0.5 * stiffness_ * dot(hand_.position_m(), hand_.position_m()));
    }
    return maximum;
  }
  bool dies_away() {
    const double maximum = 1e4 * start_j();
    window();
    const double first = window();
    double last = first;
    for (int i = 0; i < 6 && last < maximum; ++i) last = window();
    return last < first && last < maximum;
  }
  bool stays_bounded() {
    for (int i = 0; i < 8; ++i)
      if (!(window() < 1e3 * start_j()) || kinetic_ > 1.05 * start_j()) return false;
    return true;
  }

 private:
  haptics::HapticProgram program_;
  haptics::SimulatedDevice hand_;
  std::unique_ptr<haptics::ChainState> state_;
  std::unique_ptr<haptics::ChainScratch> scratch_;
  HapticState out_;
  double period_s_, stiffness_, mass_kg_, kinetic_ = 0;
  int window_;
  std::uint64_t ticks_ = 0;
};

}  // namespace

double max_passive_stiffness(const StiffnessSetting& setting) {
  return haptics::safe_stiffness({.mass_kg = setting.mass_kg, .damping_ns_per_m = setting.damping, .delay_s = setting.delay_s},
                                 1 / setting.rate_hz)
      .min_n_per_m();
}

double max_stable_stiffness(const StiffnessSetting& setting) {
  const auto stable = [&](double k) { return Swing(setting, k, false).dies_away(); };
  double lo = 0.5 * max_passive_stiffness(setting);
  while (lo > 1 && !stable(lo)) lo *= 0.25;
  if (lo <= 1) return 0;
  double hi = 1.3 * lo;
  for (; stable(hi); hi *= 1.3) lo = hi;
  while (hi > 1.003 * lo) {
    const double mid = 0.5 * (lo + hi);
    (stable(mid) ? lo : hi) = mid;
  }
  return lo;
}

namespace {

double largest_controlled(const Setting& setting) {
  double k = max_passive_stiffness(setting);
  for (int i = 0; i < 40 && Swing(setting, 1.25 * k, true).stays_bounded(); ++i) k *= 1.25;
  return k;
}

std::string damping_table(ProgressLine& progress, double& done) {
  CsvTable table("rate_hz,delay_ms,device_damping_ns_per_m,passive_n_per_m,stable_n_per_m,controlled_n_per_m");
  for (const auto& [rate_hz, delay_s] : {std::pair{1000.0, 0.0}, {1000.0, 1e-3}, {2000.0, 0.0}, {4000.0, 0.0}})
    for (const double damping : kDampings) {
      const Setting s{damping, rate_hz, delay_s, 0};
      table.add(rate_hz)
          .add(1e3 * delay_s)
          .add(damping)
          .add(max_passive_stiffness(s))
          .add(max_stable_stiffness(s))
          .add(largest_controlled(s))
          .end_row();
      progress.update(++done);
    }
  return table.text();
}

std::string delay_table(ProgressLine& progress, double& done) {
  CsvTable table("delay_ms,passive_n_per_m,stable_n_per_m,controlled_n_per_m");
  for (const double delay_ms : kDelays_ms) {
    const Setting s{kDamping, 1000, 1e-3 * delay_ms, 0};
    table.add(delay_ms).add(max_passive_stiffness(s)).add(max_stable_stiffness(s)).add(largest_controlled(s)).end_row();
    progress.update(++done);
  }
  return table.text();
}

std::string virtual_table(ProgressLine& progress, double& done) {
  CsvTable table("virtual_damping_ns_per_m,passive_n_per_m,stable_n_per_m,passive_delayed_n_per_m,stable_delayed_n_per_m");
  for (const double b : kVirtual) {
    const Setting prompt{kDamping, 1000, 0, b}, delayed{kDamping, 1000, 1e-3, b};
    table.add(b)
        .add(max_passive_stiffness(prompt))
        .add(max_stable_stiffness(prompt))
        .add(max_passive_stiffness(delayed))
        .add(max_stable_stiffness(delayed))
        .end_row();
    progress.update(++done);
  }
  return table.text();
}

constexpr const char* kStiffnessScript = R"gp(set key outside right top Left reverse spacing 1.3 samplen 2
set ylabel 'maximum stiffness (N/m)'
set logscale y
set format y '10^{%L}'
array rate[4] = [1000, 1000, 2000, 4000]
array delay[4] = [0, 1, 0, 0]
array label[4] = ["1 kHz", "1 kHz, 1 ms late", "2 kHz", "4 kHz"]
array colour[4] = ["#1f77b4", "#d62728", "#2ca02c", "#9467bd"]

set output 'stiffness-damping.png'
set title 'Maximum stiffness against the damping of the device (0.159 kg)'
set xlabel 'damping of the device (N s/m)'
set logscale x
set xrange [0.04:25]
plot for [i=1:4] 'stiffness-damping.csv' every ::1 using ($1 == rate[i] && $2 == delay[i] ? $3 : NaN):4 with lines linewidth 4 \
    linecolor rgb '#bbbbbb' title (i == 1 ? 'passive: 2 b / (T + 2 delay)' : ''), \
  for [i=1:4] '' every ::1 using ($1 == rate[i] && $2 == delay[i] ? $3 : NaN):5 with linespoints linewidth 1.5 pointtype 7 \
    pointsize 1.1 linecolor rgb colour[i] title label[i].', stable', \
  for [i=1:4] '' every ::1 using ($1 == rate[i] && $2 == delay[i] ? $3 : NaN):6 with linespoints linewidth 1.5 dashtype 3 pointtype 6 \
    pointsize 1.1 linecolor rgb colour[i] title label[i].', controlled'

set output 'stiffness-delay.png'
set title 'Maximum stiffness against the delay from pose to force: 0.5 N s/m, 1 kHz'
set xlabel 'delay in addition to the period (ms)'
unset logscale x
set xrange [-0.2:5.2]
plot 'stiffness-delay.csv' every ::1 using 1:2 with lines linewidth 4 linecolor rgb '#bbbbbb' title 'passive: 2 b / (T + 2 delay)', \
  '' every ::1 using 1:3 with linespoints linewidth 1.5 pointtype 7 linecolor rgb colour[1] title 'stable', \
  '' every ::1 using 1:4 with linespoints linewidth 1.5 dashtype 3 pointtype 6 linecolor rgb colour[1] title 'controlled'

set output 'stiffness-virtual.png'
set title 'Maximum stiffness against the virtual damping of the coupling: device 0.5 N s/m, 1 kHz'
set xlabel 'virtual damping (N s/m)'
set xrange [-5:205]
set yrange [100:2e5]
plot 'stiffness-virtual.csv' every ::1 using 1:2 with lines linewidth 4 linecolor rgb '#bbbbbb' title 'passive, without it', \
  '' every ::1 using 1:4 with lines linewidth 4 linecolor rgb '#bbbbbb' title '', \
  '' every ::1 using 1:3 with linespoints linewidth 1.5 pointtype 7 linecolor rgb colour[1] title 'stable', \
  '' every ::1 using 1:($5 > 0 ? $5 : NaN) with linespoints linewidth 1.5 pointtype 7 linecolor rgb colour[2] title 'stable, 1 ms late'
)gp";

}  // namespace

Outcome figure_stiffness(ResultsDir& folder) {
  ProgressLine progress("figure stiffness", static_cast<double>(4 * std::size(kDampings) + std::size(kDelays_ms) + std::size(kVirtual)));
  double done = 0;
  CATENA_CHECK(folder.add("stiffness-damping.csv", damping_table(progress, done)));
  CATENA_CHECK(folder.add("stiffness-delay.csv", delay_table(progress, done)));
  CATENA_CHECK(folder.add("stiffness-virtual.csv", virtual_table(progress, done)));
  CATENA_CHECK(folder.add("stiffness.gp",
                          make_figure_script("gnuplot stiffness.gp: the plots of figure \"stiffness\" from its tables", kStiffnessScript)));
  return folder.add_plots("stiffness.gp", {"stiffness-damping.png", "stiffness-delay.png", "stiffness-virtual.png"});
}

}  // namespace catena::app
