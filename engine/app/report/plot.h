/// Parts of gnuplot scripts that draw SVG for a page. Black is drawn in the page's ink (report/page.h); colours are read on white and on
/// black.
#pragma once
#include <string>

namespace catena::app {

/// Terminal, border, grid and key of pictures of so many pixels.
std::string plot_head(int width, int height);
/// "#rrggbb"; after the last one the first follows again.
std::string plot_color(int i);
/// In single quotes, as gnuplot has them.
std::string quoted(const std::string& text);

/// The data of one plot and what is drawn of them.
struct PlotData {
  std::string blocks, items;
  /// `rows` as a block of that name ("$a"), drawn as "NAME STYLE"; nothing where there are no rows.
  void add(const std::string& name, const std::string& rows, const std::string& style);
};

}  // namespace catena::app
