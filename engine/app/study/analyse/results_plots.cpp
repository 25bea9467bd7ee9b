// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "engine/app/study/analyse/analysis.h"
#include "engine/app/tuning/report/gnuplot_script.h"
#include "engine/base/numbers.h"

namespace catena::app::analysis {
namespace {

constexpr int kShapes[] = {7, 9, 5, 13, 11, 15};  ///< gnuplot point types: filled ones

std::string look(int condition) {
  return fmt::format("pt {} ps 0.7 lw 1.6 lc rgb '{}'", kShapes[static_cast<std::size_t>(condition) % std::size(kShapes)],
                     plot_color(condition));
}

/// Adds one plot of the means of a quantity: the tasks side by side, with the conditions within each.
void add_means_plot(const Study& study, const Analysis& analysis, Quantity q, const std::vector<int>& tasks, const std::string& title,
                    const std::string& axis, const std::string& file, Plots& plots) {
  const int conditions = static_cast<int>(study.conditions.size());
  PlotData data;
  for (int c = 0; c < conditions; ++c) {
    std::string rows;
    for (std::size_t i = 0; i < tasks.size(); ++i)
      for (const ConditionMean& m : analysis.means)
        if (m.quantity == q && m.task_condition == TaskCondition{tasks[i], c} && m.result)
          rows += fmt::format("{} {} {} {}\n", to_text(static_cast<double>(i) + 0.3 * ((c + 0.5) / conditions - 0.5)),
                              to_text(m.result->mean), to_text(m.result->low()), to_text(m.result->high()));
    data.add(
        fmt::format("$c{}", c), rows,
        "using 1:2:3:4 with yerrorbars " + look(c) + " title " + quote_for_gnuplot(study.conditions[static_cast<std::size_t>(c)].name));
  }
  if (data.plot_items.empty()) return;
  std::string tics;
  for (std::size_t i = 0; i < tasks.size(); ++i)
    tics += fmt::format("{}{} {}", i > 0 ? ", " : "", quote_for_gnuplot(study.tasks[static_cast<std::size_t>(tasks[i])].name), i);
  plots.script +=
      data.data_blocks + fmt::format(
                             "set output '{}'\nset title {}\nset ylabel {}\nset xtics ({})\nset xrange [-0.6:{}]\nset yrange "
                             "[{}:*]\nplot {}\nunset output\n",
                             file, quote_for_gnuplot(title), quote_for_gnuplot(axis), tics,
                             to_text(static_cast<double>(tasks.size()) - 0.4), q == Quantity::slope ? "*" : "0", data.plot_items);
  plots.files.push_back(file);
}

/// Data rows of two points of a straight line over the range of x.
std::string line_rows(const std::vector<double>& x, const std::vector<double>& y) {
  const auto line = statistics::regression(x, y);
  if (!line) return {};
  const auto [lo, hi] = std::minmax_element(x.begin(), x.end());
  std::string rows;
  for (const double at : {*lo, *hi}) rows += fmt::format("{} {}\n", to_text(at), to_text(line->intercept + line->slope * at));
  return rows;
}

void add_scatter(const Study& study, const Analysis& analysis, int task, const std::string& file, Plots& plots) {
  PlotData data;
  for (int c = 0; c < static_cast<int>(study.conditions.size()); ++c) {
    std::vector<double> x, y;
    std::string rows;
    for (std::size_t s = 0; s < analysis.subjects.size(); ++s) {
      const double time = analysis.value(s, {task, c}, Quantity::time), error = analysis.value(s, {task, c}, Quantity::error);
      if (!std::isfinite(time) || !std::isfinite(error)) continue;
      x.push_back(time);
      y.push_back(error);
      rows += fmt::format("{} {}\n", to_text(time), to_text(error));
    }
    std::string title = study.conditions[static_cast<std::size_t>(c)].name;
    for (const ConditionCorrelation& correlated : analysis.correlations)
      if (correlated.task_condition == TaskCondition{task, c} && correlated.result)
        title += fmt::format(", r = {:.2f}", correlated.result->r);
    data.add(fmt::format("$p{}", c), rows, "using 1:2 with points " + look(c) + " title " + quote_for_gnuplot(title));
    data.add(fmt::format("$l{}", c), line_rows(x, y), fmt::format("with lines lw 1.4 dt 2 lc rgb '{}' notitle", plot_color(c)));
  }
  if (data.plot_items.empty()) return;
  plots.script += data.data_blocks + fmt::format("set output '{}'\nset title {}\nplot {}\nunset output\n", file,
                                                 quote_for_gnuplot(study.tasks[static_cast<std::size_t>(task)].name), data.plot_items);
  plots.files.push_back(file);
}

std::vector<int> all_tasks(const Study& study, int dimensions) {
  std::vector<int> tasks;
  for (std::size_t t = 0; t < study.tasks.size(); ++t)
    if (dimensions == 0 || study.tasks[t].dimensions == dimensions) tasks.push_back(static_cast<int>(t));
  return tasks;
}

}  // namespace

Plots means_plots(const Study& study, const Analysis& analysis) {
  Plots plots{plot_preamble(440, 340), {}};
  for (const int dimensions : {2, 3}) {
    const std::vector<int> tasks = all_tasks(study, dimensions);
    if (tasks.empty()) continue;
    for (const auto& [q, axis] : {std::pair{Quantity::error, "position error, mm"}, {Quantity::time, "time, s"}})
      add_means_plot(study, analysis, q, tasks, fmt::format("{} tasks: {}", dimensions == 2 ? "2D" : "3D", quantity_label(q)), axis,
                     fmt::format("means{}{}.svg", dimensions, to_string(q)), plots);
  }
  return plots;
}

Plots correlation_plots(const Study& study, const Analysis& analysis) {
  Plots plots{plot_preamble(440, 340) + "set xlabel 'time, s'\nset ylabel 'position error, mm'\nset xrange [0:*]\nset yrange [0:*]\n", {}};
  for (const int t : all_tasks(study, 0)) add_scatter(study, analysis, t, fmt::format("scatter{}.svg", t), plots);
  return plots;
}

Plots tradeoff_plots(const Study& study, const Analysis& analysis) {
  Plots plots{plot_preamble(560, 380), {}};
  add_means_plot(study, analysis, Quantity::slope, all_tasks(study, 0), "speed-accuracy trade-off: slopes of the subjects",
                 "slope of log error on log time", "trade.svg", plots);
  return plots;
}

}  // namespace catena::app::analysis
