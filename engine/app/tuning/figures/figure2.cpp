// SPDX-License-Identifier: MIT
/// Figure 2: a streamline of the field `circle` with a radius of 50 mm, followed at 1 kHz by a probe on it.
///   figure2-drift.csv   laps at three speeds, every method: distance of the proxy from the streamline
///   figure2-path.csv    path of the proxy of the linear method
///   figure2-tremor.csv  a probe at rest except for a tremor of 1 mm at 10 Hz along the line
#include <cmath>
#include <numbers>

#include "engine/app/cli/command.h"
#include "engine/app/tuning/figures/figures.h"

namespace catena::app {

namespace {

constexpr double kRadius_m = 0.05, kFigure2Tick_s = 1e-3;
constexpr double kTremor_m = 1e-3, kTremor_hz = 10, kStill_s = 60;
constexpr int kLaps = 5, kPathLaps = 8;
constexpr double kSpeeds[] = {0.05, 0.2, 1.0}, kPathSpeed = 1.0;
constexpr const char* kFigure2Methods[] = {"linear", "euler", "rk2", "rk3", "rk4", "rkf34", "dp54", "selected"};

TickSimulation follower(const std::string& method) {
  const std::string how = method == "selected" ? "" : R"(, "method": ")" + method + "\"";
  return TickSimulation(R"({"fields": {"v": {"analytic": "circle"}},
    "chain": [{"name": "curve", "type": "streamline", "field": "v", "seed": [0.05, 0, 0])" +
                        how + "}]}");
}

Vec3 on_circle(double angle) { return {kRadius_m * std::cos(angle), kRadius_m * std::sin(angle), 0}; }

double off_circle_mm(const Vec3& p) { return 1e3 * std::hypot(std::hypot(p.x, p.y) - kRadius_m, p.z); }

std::string drift_table(ProgressLine& progress, double& done) {
  CsvTable table("method,speed_m_per_s,drift_mm_first_lap,drift_mm_after_5_laps,evaluations_per_tick,evaluations_max");
  for (const char* method : kFigure2Methods)
    for (const double speed : kSpeeds) {
      TickSimulation hand = follower(method);
      const double lap_ticks = 2 * std::numbers::pi * kRadius_m / (speed * kFigure2Tick_s);
      double first = 0, last = 0, sum = 0;
      int maximum = 0;
      const int ticks = static_cast<int>(std::ceil(kLaps * lap_ticks)), first_ticks = static_cast<int>(std::ceil(lap_ticks));
      for (int k = 0; k <= ticks; ++k) {
        const auto& out = hand.step(k * kFigure2Tick_s, on_circle(speed * kFigure2Tick_s * k / kRadius_m));
        last = std::max(last, off_circle_mm(out.links[0].proxy));
        if (k <= first_ticks) first = last;
        sum += out.links[0].evaluations;
        maximum = std::max(maximum, out.links[0].evaluations);
      }
      table.add(method).add(speed).add(first).add(last).add(sum / (ticks + 1)).add(maximum).end_row();
      progress.update(++done);
    }
  return table.text();
}

std::string path_table() {
  CsvTable table("t_s,laps,streamline_x_mm,streamline_y_mm,linear_x_mm,linear_y_mm,selected_x_mm,selected_y_mm");
  TickSimulation linear = follower("linear"), selected = follower("selected");
  const int ticks = static_cast<int>(std::ceil(kPathLaps * 2 * std::numbers::pi * kRadius_m / (kPathSpeed * kFigure2Tick_s)));
  for (int k = 0; k <= ticks; ++k) {
    const double t = k * kFigure2Tick_s, angle = kPathSpeed * t / kRadius_m;
    const Vec3 probe = on_circle(angle);
    const Vec3 a = 1e3 * linear.step(t, probe).links[0].proxy, b = 1e3 * selected.step(t, probe).links[0].proxy;
    table.add(t).add(angle / (2 * std::numbers::pi));
    for (const double value : {1e3 * probe.x, 1e3 * probe.y, a.x, a.y, b.x, b.y}) table.add(value);
    table.end_row();
  }
  return table.text();
}

std::string tremor_table(ProgressLine& progress, double& done) {
  std::string header = "t_s";
  std::vector<TickSimulation> hands;
  for (const char* method : kFigure2Methods) {
    header += std::string(",") + method + "_drift_mm";
    hands.push_back(follower(method));
  }
  CsvTable table(header);
  const int ticks = static_cast<int>(kStill_s / kFigure2Tick_s);
  for (int k = 0; k <= ticks; ++k) {
    const double t = k * kFigure2Tick_s;
    const Vec3 probe(kRadius_m, kTremor_m * std::sin(2 * std::numbers::pi * kTremor_hz * t), 0);
    const bool row = k % 250 == 0;
    if (row) table.add(t);
    for (TickSimulation& hand : hands) {
      const double drift = off_circle_mm(hand.step(t, probe).links[0].proxy);
      if (row) table.add(drift);
    }
    if (row) table.end_row();
    if (k % 10000 == 0) progress.update(++done);
  }
  return table.text();
}

constexpr const char* kFigure2Script = R"gp(methods = "linear euler rk2 rk3 rk4 rkf34 dp54 selected"
array label[8] = ["linear (Eqs 1-2)", "Euler", "RK2", "RK3", "RK4", "RKF3(4)", "DP5(4)", "selected (traced curve)"]
array dash[8] = [1, 3, 1, 3, 1, 3, 1, 1]
array colour[8] = ["#d62728", "#ff7f0e", "#bcbd22", "#2ca02c", "#17becf", "#1f77b4", "#9467bd", "#000000"]

set output 'figure2-drift.png'
set title 'Drift from a streamline of radius 50 mm, one lap at 1 kHz'
set xlabel 'speed of the probe (m/s)'
set ylabel 'drift in the first lap (mm)'
set logscale xy
set xrange [0.04:1.25]
set yrange [1e-14:1e2]
set format y '10^{%L}'
set xtics (0.05, 0.1, 0.2, 0.5, 1)
set key outside right top Left reverse spacing 1.3 samplen 2
plot for [i=1:8] 'figure2-drift.csv' every ::1 using (strcol(1) eq word(methods, i) ? $2 : NaN):3 \
  with linespoints linewidth 2.5 dashtype dash[i] pointtype 3+i pointsize 1.5 linecolor rgb colour[i] title label[i]

set output 'figure2-path.png'
set title 'The linear follow mode leaves the streamline: 8 laps at 1 m/s, 1 kHz'
unset logscale
set format y '%g'
set xlabel 'x (mm)'
set ylabel 'y (mm)'
set size ratio -1
set xrange [-85:85]
set yrange [-85:85]
set xtics autofreq
set key outside right top Left reverse spacing 1.3 samplen 2
plot 'figure2-path.csv' every ::1 using 5:6 with lines linewidth 1.5 linecolor rgb '#d62728' title 'linear (Eqs 1-2)', \
  '' every ::1 using 3:4 with lines linewidth 5 linecolor rgb '#aaaaaa' title 'streamline', \
  '' every ::1 using 7:8 with lines linewidth 1.5 dashtype 2 linecolor rgb '#000000' title 'selected (traced curve)'

set output 'figure2-tremor.png'
set title 'Probe at rest with a tremor of 1 mm at 10 Hz (below 10^{-15} mm plotted at 10^{-15})'
set size noratio
set xlabel 'time (s)'
set ylabel 'drift (mm)'
set logscale y
set format y '10^{%L}'
set xrange [0:60]
set yrange [1e-16:1e2]
plot for [i=1:8] 'figure2-tremor.csv' every ::1 using 1:(column(i+1) > 1e-15 ? column(i+1) : 1e-15) \
  with lines linewidth 2.5 dashtype dash[i] linecolor rgb colour[i] title label[i]
)gp";

}  // namespace

Outcome figure2(ResultsDir& folder) {
  ProgressLine progress("figure 2", 24 + 7);
  double done = 0;
  CATENA_CHECK(folder.add("figure2-drift.csv", drift_table(progress, done)));
  CATENA_CHECK(folder.add("figure2-path.csv", path_table()));
  CATENA_CHECK(folder.add("figure2-tremor.csv", tremor_table(progress, done)));
  CATENA_CHECK(folder.add("figure2.gp", make_figure_script("gnuplot figure2.gp: the plots of figure 2 from its tables", kFigure2Script)));
  return folder.add_plots("figure2.gp", {"figure2-drift.png", "figure2-path.png", "figure2-tremor.png"});
}

}  // namespace catena::app
