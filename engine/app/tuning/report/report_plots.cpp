// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "engine/app/tuning/report/gnuplot_script.h"
#include "engine/app/tuning/report/report.h"
#include "engine/base/numbers.h"

namespace catena::app::tuning {
namespace {

std::vector<std::string> series_of(const Curve& c) {
  std::vector<std::string> all;
  for (const Point& p : c.points)
    if (std::find(all.begin(), all.end(), p.series) == all.end()) all.push_back(p.series);
  return all;
}

/// One axis of costs: bytes in KiB or MiB, so that the numbers are short.
struct CostAxis {
  CostKind cost;
  double unit = 1;
  std::string name;
  double at(const Point& p) const { return get_cost(p, cost) / unit; }
};

CostAxis axis_of(CostKind cost, const std::string& name, double maximum) {
  if (cost != CostKind::bytes) return {cost, 1, name};
  const bool mega = maximum >= 1 << 20;
  return {cost, mega ? 1048576.0 : 1024.0, name + (mega ? ", MiB" : ", KiB")};
}

/// Data row "cost error low high" of a point with cost and error; an exact result is plotted at `minimum`.
std::string row(const Point& p, const CostAxis& axis, double minimum) {
  const double x = axis.at(p);
  if (!(x > 0) || !std::isfinite(p.error)) return {};
  const bool times = axis.cost == CostKind::time;
  return fmt::format("{} {} {} {}\n", to_text(x), to_text(std::max(p.error, minimum)), to_text(times ? p.time.lower_quartile : x),
                     to_text(times ? p.time.upper_quartile : x));
}

std::string rows(const Curve& c, const CostAxis& axis, double minimum, const std::string& series) {
  std::string text;
  for (const Point& p : c.points)
    if (p.series == series) text += row(p, axis, minimum);
  return text;
}

}  // namespace

PlotScript plot_script(const Curve& curve, const Curve* other, const std::string& prefix) {
  PlotScript script;
  script.text = plot_preamble(560, 420) + "set logscale xy\n";
  double minimum = std::numeric_limits<double>::infinity(), maximum = 0;
  for (const Curve* c : {&curve, other})
    if (c != nullptr)
      for (const Point& p : c->points)
        if (p.error > 0 && std::isfinite(p.error)) minimum = std::min(minimum, p.error), maximum = std::max(maximum, p.error);
  if (!(maximum > 0)) return script;  // all errors are zero
  for (const double level : {curve.discretization_error, curve.reference_error})
    if (level > 0) minimum = std::min(minimum, level), maximum = std::max(maximum, level);
  if (!std::isfinite(minimum) || !(maximum > 0) || curve.error_name.empty()) return script;
  minimum *= 0.3;
  for (const auto& [cost, name] :
       {std::pair{CostKind::time, &curve.time_name}, {CostKind::work, &curve.work_name}, {CostKind::bytes, &curve.bytes_name}}) {
    if (name->empty()) continue;
    PlotData drawn;
    int k = 0, points = 0;
    double lo = std::numeric_limits<double>::infinity(), hi = 0;
    for (const Curve* c : {&curve, other}) {
      if (c == nullptr) continue;
      for (const Point& p : c->points)
        if (get_cost(p, cost) > 0 && std::isfinite(p.error))
          lo = std::min(lo, get_cost(p, cost)), hi = std::max(hi, get_cost(p, cost)), ++points;
    }
    if (points < 2) continue;  // a plot of one point adds nothing to its number
    const CostAxis axis = axis_of(cost, *name, hi);
    lo *= 0.7 / axis.unit, hi *= 1.4 / axis.unit;
    if (cost == curve.cost && curve.front.size() > 1) {
      std::string front;
      for (const int i : curve.front) front += row(curve.points[static_cast<std::size_t>(i)], axis, minimum);
      drawn.add("$front", front, "using 1:2 with lines lw 9 lc rgb '#b0888888' title 'front'");
    }
    for (const Curve* c : {&curve, other}) {
      if (c == nullptr) continue;
      int color = 0;
      for (const std::string& series : series_of(*c)) {
        const std::string look = fmt::format("using 1:2:3:4 with xerrorlines lw 1.6 {} pt {} ps 0.5 lc rgb '{}' title {}",
                                             c == other ? "dt 3" : "dt 1", c == other ? 6 : 7, plot_color(color++),
                                             quote_for_gnuplot((series.empty() ? "measured" : series) + (c == other ? " (other)" : "")));
        drawn.add(fmt::format("$s{}", k++), rows(*c, axis, minimum, series), look);
      }
    }
    const auto level = [&](const char* block, double value, const std::string& look) {
      if (value > 0) drawn.add(block, fmt::format("{0} {2}\n{1} {2}\n", to_text(lo), to_text(hi), to_text(value)), look);
    };
    level("$floor", curve.discretization_error,
          "with lines lw 2 dt 2 lc rgb '#888888' title " + quote_for_gnuplot(curve.discretization_error_name));
    level("$reference", curve.reference_error, "with lines lw 1.2 dt 4 lc rgb '#888888' title 'error of the reference'");
    if (curve.current >= 0)
      drawn.add("$now", row(curve.points[static_cast<std::size_t>(curve.current)], axis, minimum),
                "using 1:2 with points pt 4 ps 1.7 lw 1.5 lc rgb 'black' title 'current'");
    if (curve.chosen >= 0)
      drawn.add("$chosen", row(curve.points[static_cast<std::size_t>(curve.chosen)], axis, minimum),
                "using 1:2 with points pt 6 ps 2.2 lw 2 lc rgb 'black' title 'chosen'");
    const std::string file = fmt::format("{}{}.svg", prefix, script.files.size());
    script.text +=
        drawn.data_blocks + log_tics('x', lo, hi) + log_tics('y', 0.7 * minimum, 3 * maximum) +
        fmt::format("set output '{}'\nset xlabel {}\nset ylabel {}\nset xrange [{}:{}]\nset yrange [{}:{}]\nplot {}\nunset output\n", file,
                    quote_for_gnuplot(axis.name), quote_for_gnuplot(curve.error_name), to_text(lo), to_text(hi), to_text(0.7 * minimum),
                    to_text(3 * maximum), drawn.plot_items);
    script.files.push_back(file);
  }
  return script;
}

}  // namespace catena::app::tuning
