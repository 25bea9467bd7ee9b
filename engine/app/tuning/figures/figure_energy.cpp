// SPDX-License-Identifier: MIT
/// Energy of a chain: the gain over a slow closed loop of the probe, by the angle between two links, by the paper's sum of pulls and by
/// virtual work (haptics/chain/virtual_work.h). The loop is an ellipse near the intersection of the links; its speed does not matter. The
/// work is a trapezoid rule over the loop, refined until half the step changes it by less than 1e-10 K gap^2; gap is the largest distance
/// of the probe from the last proxy.
///   energy.csv  links, angle in degrees, force: paper or conservative; gain and omitted work (due to bounded derivatives), both by K gap^2
#include <fmt/format.h>

#include <cmath>
#include <numbers>

#include "engine/app/cli/command.h"
#include "engine/app/tuning/figures/figures.h"
#include "engine/base/numbers.h"

namespace catena::app {

namespace {

constexpr double kPairStiffness = 500, kConvergedWork = 1e-10;
constexpr int kFirstPlaces = 64, kMaxPlaces = 1 << 14;
constexpr double kPairAngles_deg[] = {0, 5, 10, 15, 20, 25, 30, 35, 40, 45, 50, 55, 60, 65, 70, 75, 80, 85, 90};

/// A pair of links that meet at (1, 0, 0) at an angle.
struct Pair {
  const char* name;
  std::string (*chain)(double angle);
};

std::string plane_of(const char* name, const Vec3& normal) {
  return fmt::format(R"({{"name": "{}", "type": "plane", "point": [1, 0, 0], "normal": {}}})", name, vector_to_json(normal));
}
std::string line_of(const char* name, const Vec3& way) {
  return fmt::format(R"({{"name": "{}", "type": "line", "point": [1, 0, 0], "direction": {}}})", name, vector_to_json(way));
}
const char* const kUnitSphere = R"({"name": "sphere", "type": "sphere", "center": [0, 0, 0], "radius": 1})";

const Pair kPairs[] = {
    {"plane then plane",
     [](double a) {
       return plane_of("first", {0, 0, 1}) + ", " + plane_of("second", {std::sin(a), 0, std::cos(a)});
     }},
    {"plane then line",
     [](double a) {
       return plane_of("first", {0, 0, 1}) + ", " + line_of("second", {std::cos(a), 0, std::sin(a)});
     }},
    {"line then line",
     [](double a) {
       return line_of("first", {1, 0, 0}) + ", " + line_of("second", {std::cos(a), std::sin(a), 0});
     }},
    {"sphere then line",
     [](double a) {
       return kUnitSphere + (", " + line_of("line", {std::sin(a), std::cos(a), 0}));
     }},
    {"line then sphere",
     [](double a) {
       return line_of("line", {std::sin(a), std::cos(a), 0}) + ", " + kUnitSphere;
     }},
    {"sphere then plane",
     [](double a) {
       return kUnitSphere + (", " + plane_of("plane", {std::cos(a), std::sin(a), 0}));
     }},
};

/// Point on an ellipse near the intersection, in a plane that contains neither link; `part`: fraction of a lap, 0 to 1.
Vec3 place_of_hand(double part) {
  const double u = 2 * std::numbers::pi * part;
  return Vec3(1.1, 0.05, 0.1) + Vec3(1, 0, 0.3) * (0.2 * std::cos(u)) + Vec3(0.2, 0.6, 0.9) * (0.2 * std::sin(u));
}

struct Gain {
  double gain = 0, left_out = 0;
};

Gain gain_of(const std::string& chain, const char* force) {
  Gain result;
  double before = std::nan("");
  for (int n = kFirstPlaces; n <= kMaxPlaces; n *= 2) {
    TickSimulation hand(fmt::format(R"({{"coupling": {{"stiffness": {}, "max_force": 1e9, "force": "{}"}}, "chain": [{}]}})",
                                    kPairStiffness, force, chain));
    double work = 0, gap = 0, left_out = 0;
    Vec3 last(0.0), last_force(0.0);
    // one lap to settle, one that is measured
    for (int k = 0; k <= 2 * n; ++k) {
      const Vec3 x = place_of_hand(static_cast<double>(k % n) / n);
      const HapticState& out = hand.step(1e-3 * k, x);
      if (k == n) left_out = out.omitted_work_j;
      if (k > n) {
        work += 0.5 * dot(out.force_n + last_force, x - last);
        gap = std::max(gap, norm(out.links[1].proxy - x));
        if (k == 2 * n) left_out = out.omitted_work_j - left_out;
      }
      last = x;
      last_force = out.force_n;
    }
    const double unit = kPairStiffness * gap * gap;
    // the error of the chord sum is proportional to the square of the step: halving the step removes three quarters of it
    const double gain = work / unit;
    const bool converged = std::fabs(gain - before) <= kConvergedWork;
    result = {std::isnan(before) ? gain : gain + (gain - before) / 3, left_out / unit};
    if (converged) break;
    before = gain;
  }
  return result;
}

constexpr const char* kEnergyScript = R"gp(set key outside right top Left reverse spacing 1.3 samplen 2
set title 'Energy gain of a slow closed loop of the probe from two links'
set xlabel 'angle between the links (degrees)'
set ylabel 'energy / (K gap^2)'
set output 'energy.png'
array pair[6] = ["plane then plane", "plane then line", "line then line", "sphere then line", "line then sphere", "sphere then plane"]
array colour[6] = ["#1f77b4", "#d62728", "#2ca02c", "#9467bd", "#ff7f0e", "#17becf"]
plot for [i=1:6] 'energy.csv' every 2::1 using (strcol(1) eq pair[i] ? $2 : NaN):4 \
    with linespoints linewidth 1.5 pointtype 7 linecolor rgb colour[i] title pair[i].', paper', \
  '' every 2::2 using 2:4 with points pointtype 2 pointsize 1.4 linecolor rgb '#000000' \
    title 'all, conservative'
)gp";

}  // namespace

Outcome figure_energy(ResultsDir& folder) {
  CsvTable table("links,angle_deg,force,gain_by_k_gap2,left_out_by_k_gap2");
  for (const Pair& pair : kPairs)
    for (const double degrees : kPairAngles_deg)
      for (const char* force : {"paper", "conservative"}) {
        const Gain gain = gain_of(pair.chain(degrees * std::numbers::pi / 180), force);
        table.add(pair.name).add(degrees).add(force).add(gain.gain).add(gain.left_out).end_row();
      }
  CATENA_CHECK(folder.add("energy.csv", table.text()));
  CATENA_CHECK(
      folder.add("energy.gp", make_figure_script("gnuplot energy.gp: the plot of figure \"energy\" from its table", kEnergyScript)));
  return folder.add_plots("energy.gp", {"energy.png"});
}

}  // namespace catena::app
