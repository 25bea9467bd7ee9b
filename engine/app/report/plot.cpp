#include "engine/app/report/plot.h"

#include <fmt/format.h>

#include <iterator>

#include "engine/base/text.h"

namespace catena::app {

std::string plot_head(int width, int height) {
  return fmt::format(
      "set terminal svg size {},{} dynamic noenhanced font 'sans-serif,13'\nset border lc rgb 'black'\nset format '%g'\n"
      "set grid lc rgb '#888888' lw 0.5\nset key outside bottom center horizontal samplen 1.5 maxcols 3\n",
      width, height);
}

std::string plot_color(int i) {
  constexpr const char* colors[] = {"#2a7de1", "#d9480f", "#2b9a4b", "#9c36b5", "#b8860b", "#0c8599", "#c2255c", "#868e96"};
  return colors[static_cast<std::size_t>(i) % std::size(colors)];
}

std::string quoted(const std::string& text) {
  std::string out = "'";
  for (const char c : one_line(text)) out += c == '\'' ? std::string("''") : std::string(1, c);
  return out + "'";
}

void PlotData::add(const std::string& name, const std::string& rows, const std::string& style) {
  if (rows.empty()) return;
  blocks += name + " << EOD\n" + rows + "EOD\n";
  items += (items.empty() ? "" : ", ") + name + " " + style;
}

}  // namespace catena::app
