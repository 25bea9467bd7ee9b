/// Impl of gnuplot scripts that draw SVG for a page. Black is drawn in the page's ink (report/page.h); colours are read on white and on
/// black.
#pragma once
#include <string>

namespace catena::app {

/// Terminal, border, grid and key of pictures of so many pixels.
std::string plot_preamble(int width, int height);
/// gnuplot's tics of a logarithmic axis from `lo` to `hi`, `axis` x or y: of less than three decades with numbers between the powers of
/// ten, so that the shortest axis has some.
std::string log_tics(char axis, double lo, double hi);
/// "#rrggbb"; after the last one the first follows again.
std::string plot_color(int i);
/// In single quotes, as gnuplot has them.
std::string quote_for_gnuplot(const std::string& text);

/// The data of one plot and what is drawn of them.
struct PlotData {
  std::string data_blocks, plot_items;
  /// `rows` as a block of that name ("$a"), drawn as "NAME STYLE"; nothing where there are no rows.
  void add(const std::string& name, const std::string& rows, const std::string& style);
};

}  // namespace catena::app
