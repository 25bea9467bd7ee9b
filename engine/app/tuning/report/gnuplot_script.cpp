// SPDX-License-Identifier: MIT
#include "engine/app/tuning/report/gnuplot_script.h"

#include <fmt/format.h>

#include <cmath>
#include <iterator>
#include <vector>

#include "engine/base/text.h"

namespace catena::app {

namespace {

std::string listed_tics(char axis, const std::vector<double>& tics) {
  std::string text;
  for (const double tic : tics) text += fmt::format("{}{:.6g}", text.empty() ? "" : ", ", tic);
  return fmt::format("set {}tics ({})\n", axis, text);
}

}  // namespace

std::string plot_preamble(int width, int height) {
  return fmt::format(
      "set terminal svg size {},{} dynamic noenhanced font 'sans-serif,13'\nset border lc rgb 'black'\nset format '%g'\n"
      "set grid lc rgb '#888888' lw 0.5\nset key outside top center horizontal samplen 1.5 spacing 1.35 maxcols 3\n",
      width, height);
}

std::string log_tics(char axis, double lo, double hi) {
  constexpr std::size_t kEnough = 3;
  if (!(lo > 0 && hi > lo) || hi / lo > 1e3) return fmt::format("set {}tics autofreq\n", axis);
  // increasingly dense ticks per decade: the first set with enough of them on the axis is used
  const std::vector<std::vector<double>> finer{{1}, {1, 3}, {1, 2, 5}, {1, 1.5, 2, 3, 4, 5, 6, 8}};
  for (const std::vector<double>& digits : finer) {
    std::vector<double> tics;
    for (int power = static_cast<int>(std::floor(std::log10(lo))); std::pow(10.0, power) <= hi; ++power)
      for (const double digit : digits)
        if (const double tic = digit * std::pow(10.0, power); tic >= lo && tic <= hi) tics.push_back(tic);
    if (tics.size() < kEnough) continue;
    return listed_tics(axis, tics);
  }
  // a narrow axis: explicit ticks at equal steps, since on a logarithmic axis gnuplot multiplies by a step
  const double step = std::pow(10.0, std::floor(std::log10((hi - lo) / 2)));
  std::vector<double> tics;
  for (const double wide : {5 * step, 2 * step, step, 0.5 * step}) {
    tics.clear();
    for (double k = std::ceil(lo / wide); k * wide <= hi; ++k) tics.push_back(k * wide);
    if (tics.size() >= kEnough) break;
  }
  return listed_tics(axis, tics);
}

std::string plot_color(int i) {
  constexpr const char* colors[] = {"#2a7de1", "#d9480f", "#2b9a4b", "#9c36b5", "#b8860b", "#0c8599", "#c2255c", "#868e96"};
  return colors[static_cast<std::size_t>(i) % std::size(colors)];
}

std::string quote_for_gnuplot(const std::string& text) {
  std::string out = "'";
  for (const char c : one_line(text)) out += c == '\'' ? std::string("''") : std::string(1, c);
  return out + "'";
}

void PlotData::add(const std::string& name, const std::string& rows, const std::string& style) {
  if (rows.empty()) return;
  data_blocks += name + " << EOD\n" + rows + "EOD\n";
  plot_items += (plot_items.empty() ? "" : ", ") + name + " " + style;
}

}  // namespace catena::app
