// SPDX-License-Identifier: MIT
/// Figure 3: a penetrable surface (free above, releases at 0.05) and a curve that meets it at an angle. The probe moves along the
/// curve, from the free side in, 0.2 m/s at 1 kHz.
///   flat    a line of the field `uniform` through the level set of the field `plane`
///   curved  a helix of the field `helix` through the level set |x| = 1 of the field `sphere`
///   figure3-release.csv  for every scene, angle and method: the probe's depth at release, and the distances of the proxies
///   figure3-series.csv   flat, 30 degrees: every tick
///                        (off_curve_at_release_depth: when the probe depth equals the release distance)
/// One proxy: both residuals are those of this proxy. Chain: the curve's residual is that of the curve's proxy, the surface's that of the
/// surface's proxy.
#include <cmath>
#include <numbers>

#include "engine/app/cli/command.h"
#include "engine/app/tuning/figures/figures.h"
#include "engine/base/numbers.h"

namespace catena::app {

namespace {

constexpr double kRelease = 0.05, kBefore = 0.03, kDeepest = 0.125, kStep = 2e-4, kFigure3Tick_s = 1e-3,
                 kWeakLine = 10;  // N/m: 2 % of the coupling's
constexpr double kAngles_deg[] = {5, 10, 15, 20, 25, 30, 35, 40, 45, 50, 55, 60, 65, 70, 75, 80, 85, 90};
constexpr double kSeriesAngle_deg = 30;
constexpr const char* kFigure3Methods[] = {"chain", "pipe", "balance", "closest", "linear"};

/// A curve by its arc length s, 0 where it meets the surface, negative inside; and the scene in which it is measured.
struct Case {
  std::string name, fields, surface;
  bool helix = false;
  double angle = 0;
  double radius = 0, height = 0;  // of the helix; height at which it meets the sphere

  Vec3 at(double s) const {
    if (!helix) return {s * std::cos(angle), 0, s * std::sin(angle)};
    const double theta = theta_at(s);
    return {radius * std::cos(theta), radius * std::sin(theta), kPitch * theta};
  }
  double depth(const Vec3& p) const { return helix ? 1 - norm(p) : -p.z; }
  double off_surface(const Vec3& p) const { return std::fabs(depth(p)); }
  /// Distance from the curve of a point near at(s).
  double off_curve(const Vec3& p, double s) const {
    if (!helix) return std::hypot(p.y, std::cos(angle) * p.z - std::sin(angle) * p.x);
    double theta = theta_at(s);
    Vec3 e(0.0);
    for (int k = 0; k < 50; ++k) {
      const Vec3 round(std::cos(theta), std::sin(theta), 0), along(-radius * round.y, radius * round.x, kPitch);
      e = p - Vec3(radius * round.x, radius * round.y, kPitch * theta);
      const double step = dot(e, along) / std::max(dot(along, along) + radius * dot(e, round), 0.5 * dot(along, along));
      theta += step;
      if (std::fabs(step) < 1e-15) break;
    }
    return norm(e);
  }
  static constexpr double kPitch = 0.25;  // of the field (-2y, 2x, 1/2)

 private:
  double theta_at(double s) const { return height / kPitch + s / std::hypot(radius, kPitch); }
};

Case flat_case(double degrees) {
  Case c;
  c.name = "flat";
  c.angle = degrees * std::numbers::pi / 180;
  c.fields = R"("v": {"analytic": "uniform", "direction": )" + vector_to_json(c.at(1)) + R"(}, "s": {"analytic": "plane"})";
  c.surface = "0";
  return c;
}

Case curved_case(double degrees) {
  Case c;
  c.name = "curved";
  c.helix = true;
  c.angle = degrees * std::numbers::pi / 180;
  c.fields = R"("v": {"analytic": "helix"}, "s": {"analytic": "sphere"})";
  c.surface = "1";
  // the helix (R cos, R sin, z) meets the unit sphere at height z with sin(angle) = t . n = pitch z / sqrt(R^2 + pitch^2)
  const double sine2 = std::sin(c.angle) * std::sin(c.angle), pitch2 = Case::kPitch * Case::kPitch;
  c.height = std::min(1.0, std::sqrt(sine2 * (1 + pitch2) / (pitch2 + sine2)));
  c.radius = degrees < 90 ? std::sqrt(std::max(0.0, (1 - c.height) * (1 + c.height))) : 0;
  return c;
}

TickSimulation hand_for(const Case& c, const std::string& method) {
  const std::string weak = method == "balance" ? R"(, "stiffness": )" + to_text(kWeakLine) : "";
  return TickSimulation(R"({"fields": {)" + c.fields + R"(}, "coupling": {"stiffness": 500, "max_force": 1000, "method": ")" + method +
                        R"("},
    "chain": [{"name": "curve", "type": "streamline", "field": "v", "seed": )" +
                        vector_to_json(c.at(0)) + weak + R"(},
      {"name": "surface", "type": "isosurface", "field": "s", "level": )" +
                        c.surface + R"(, "free": "above", "release": )" + to_text(kRelease) + "}]}");
}

/// Ticks until the probe is well past the release depth, or as deep as a helix goes.
int ticks_of(const Case& c) {
  int k = 0;
  for (; k < 20000; ++k) {
    const Vec3 p = c.at(kBefore - kStep * k);
    if (c.depth(p) > kDeepest || (c.helix && p.z <= 0)) break;
  }
  return k;
}

void add_release_row(const Case& c, double degrees, const std::string& method, CsvTable& table) {
  TickSimulation hand = hand_for(c, method);
  const int ticks = ticks_of(c);
  bool held = false, released = false;
  double release_depth = std::nan(""), release_travel = release_depth, at_depth = release_depth, off_curve = 0, off_surface = 0, force = 0,
         off_after = 0;
  int maximum = 0;
  for (int k = 0; k <= ticks; ++k) {
    const double s = kBefore - kStep * k;
    const Vec3 probe = c.at(s);
    const auto& out = hand.step(k * kFigure3Tick_s, probe);
    const LinkReport &curve = out.links[0], &surface = out.links[1];
    maximum = std::max(maximum, curve.evaluations + surface.evaluations);
    if (std::isnan(at_depth) && c.depth(probe) >= (1 - 1e-12) * kRelease) at_depth = c.off_curve(curve.proxy, s);
    const bool let_go = surface.status == LinkStatus::released;
    if (let_go && !released) {
      released = true;
      release_depth = c.depth(probe);
      release_travel = -s;
    }
    if (released) {
      off_after = c.off_curve(curve.proxy, s);
      continue;
    }
    if (surface.status == LinkStatus::free || !(surface.weight > 0)) continue;
    held = true;
    off_curve = std::max(off_curve, c.off_curve(curve.proxy, s));
    off_surface = std::max(off_surface, c.off_surface(surface.proxy));
    force = std::max(force, norm(out.force_n));
  }
  table.add(c.name).add(degrees).add(method).add(released ? 1 : 0).add(release_depth).add(release_travel);
  table.add(off_curve)
      .add(held ? off_surface : std::nan(""))
      .add(at_depth)
      .add(released ? off_after : std::nan(""))
      .add(force)
      .add(maximum)
      .end_row();
}

std::string release_table(ProgressLine& progress) {
  CsvTable table(
      "scene,angle_deg,method,released,release_depth,release_travel,off_curve_while_held,off_surface_while_held,off_curve_at_release_depth,"
      "off_curve_at_end,"
      "force_while_held_n,evaluations_max");
  double done = 0;
  for (const bool curved : {false, true})
    for (const char* method : kFigure3Methods) {
      for (const double degrees : kAngles_deg) add_release_row(curved ? curved_case(degrees) : flat_case(degrees), degrees, method, table);
      progress.update(++done);
    }
  return table.text();
}

std::string series_table() {
  const Case c = flat_case(kSeriesAngle_deg);
  std::string header = "t_s,travel,depth,probe_x,probe_z,chain_curve_x,chain_curve_z";
  std::vector<TickSimulation> hands;
  for (const char* method : kFigure3Methods) {
    for (const char* column : {"_x", "_z", "_force_n", "_active"}) header += std::string(",") + method + column;
    hands.push_back(hand_for(c, method));
  }
  CsvTable table(header);
  const int ticks = ticks_of(c);
  for (int k = 0; k <= ticks; ++k) {
    const double s = kBefore - kStep * k;
    const Vec3 probe = c.at(s);
    for (std::size_t m = 0; m < hands.size(); ++m) {
      const auto& out = hands[m].step(k * kFigure3Tick_s, probe);
      if (m == 0) {
        for (const double value : {k * kFigure3Tick_s, -s, c.depth(probe), probe.x, probe.z, out.links[0].proxy.x, out.links[0].proxy.z})
          table.add(value);
      }
      table.add(out.links[1].proxy.x).add(out.links[1].proxy.z).add(norm(out.force_n)).add(out.links[1].active ? 1 : 0);
    }
    table.end_row();
  }
  return table.text();
}

constexpr const char* kFigure3Script = R"gp(# gnuplot figure3.gp: the plots of figure 3 from its tables
set datafile separator ','
set terminal pngcairo size 1200,700 font 'DejaVu Sans,13' linewidth 1.5
set border linewidth 1.2
set grid linecolor rgb '#bbbbbb'
release = 0.05
methods = "chain pipe balance closest linear"
array label[5] = ["proxy chain", "constraint pipe", "force balance", "closest constraint", "linear, one proxy"]
array dash[5] = [1, 1, 1, 1, 2]
array colour[5] = ["#1f77b4", "#d62728", "#2ca02c", "#9467bd", "#ff7f0e"]

do for [scene in "flat curved"] {
  set output 'figure3-release-'.scene.'.png'
  set title (scene eq "flat" ? 'A line through a plane' : 'A helix through a sphere').': depth of the probe at release'
  set xlabel 'angle between curve and surface (degrees)'
  set ylabel 'depth at release (world units)'
  set xrange [0:95]
  set yrange [0:0.125]
  set xtics 15
  set key outside right top Left reverse spacing 1.3 samplen 2
  plot release with lines linewidth 1 dashtype 2 linecolor rgb '#555555' title 'release distance', \
    release*sin(x*pi/180) with lines linewidth 1 dashtype 3 linecolor rgb '#555555' title 'release sin(angle)', \
    for [i in "2 5 3 1"] 'figure3-release.csv' every ::1 \
    using (strcol(1) eq scene && strcol(3) eq word(methods, int(i)) ? $2 : NaN):5 with linespoints linewidth 2 \
    pointtype 4+int(i) pointsize (int(i) == 5 ? 2.2 : 1.3) linecolor rgb colour[int(i)] title label[int(i)]
}

set output 'figure3-off-curve.png'
set title 'A helix through a sphere: distance of the proxy from the helix while the surface holds (0 plotted at 10^{-17})'
set ylabel 'distance from the curve (world units)'
set logscale y
set yrange [1e-18:1]
set format y '10^{%L}'
plot for [i in "3 5 2 1"] 'figure3-release.csv' every ::1 \
  using (strcol(1) eq 'curved' && strcol(3) eq word(methods, int(i)) ? $2 : NaN):($7 > 1e-17 ? $7 : 1e-17) with linespoints linewidth 2 \
  pointtype 4+int(i) pointsize 1.3 linecolor rgb colour[int(i)] title label[int(i)]
unset logscale
set format y '%g'

set output 'figure3-force.png'
set title 'A line through a plane at 30 degrees: force on the hand'
set xlabel 'depth of the probe (world units)'
set ylabel 'force (N)'
set xrange [-0.015:0.125]
set yrange [-1:30]
set xtics autofreq
plot for [i in "2 5 3 4 1"] 'figure3-series.csv' every ::1 using 3:(column(8+4*(int(i)-1)+2)) with lines linewidth 2.5 \
  dashtype dash[int(i)] linecolor rgb colour[int(i)] title label[int(i)]

set output 'figure3-path.png'
set terminal pngcairo size 1500,480 font 'DejaVu Sans,12' linewidth 1.5
unset title
set multiplot layout 1,3 title "A line through a plane at 30 degrees: the probe moves down the line" font ',15' margins 0.06,0.985,0.31,0.83 spacing 0.06,0.1
set key outside bottom center horizontal spacing 1.2
set xrange [-0.22:0.03]
set yrange [-0.13:0.03]
set xtics 0.05
set xlabel 'x (world units)'
set ylabel 'z (world units)'
set size ratio -1
array heading[3] = ["(a) constraint pipe", "(b) force balance, line of 2 % stiffness", "(c) proxy chain"]
array method[3] = [2, 3, 1]
do for [k=1:3] {
  set title heading[k]
  m = 8+4*(method[k]-1)
  plot 0 with lines linewidth 3 linecolor rgb '#bbbbbb' title 'surface', \
    'figure3-series.csv' every ::1 using 4:5 with lines linewidth 1 dashtype 2 linecolor rgb '#000000' title 'probe', \
    '' every ::1 using (k == 3 ? $6 : NaN):7 with lines linewidth 2.5 linecolor rgb '#ff7f0e' \
      title (k == 3 ? 'curve proxy' : ''), \
    '' every ::1 using (column(m+3) == 1 ? column(m) : NaN):(column(m+1)) with points pointtype 7 pointsize 0.6 \
      linecolor rgb colour[method[k]] title (k == 3 ? 'surface proxy' : 'proxy'), \
    '' every 40::1 using (column(m+3) == 0 ? column(m) : NaN):(column(m+1)) with points pointtype 6 pointsize 1.2 \
      linecolor rgb colour[method[k]] title 'release'
}
unset multiplot
)gp";

}  // namespace

Outcome figure3(ResultsDir& folder) {
  ProgressLine progress("figure 3", 2 * std::size(kFigure3Methods));
  CATENA_CHECK(folder.add("figure3-release.csv", release_table(progress)));
  CATENA_CHECK(folder.add("figure3-series.csv", series_table()));
  CATENA_CHECK(folder.add("figure3.gp", kFigure3Script));
  return folder.add_plots("figure3.gp", {"figure3-release-flat.png", "figure3-release-curved.png", "figure3-off-curve.png",
                                         "figure3-force.png", "figure3-path.png"});
}

}  // namespace catena::app
