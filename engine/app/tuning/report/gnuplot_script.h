// SPDX-License-Identifier: MIT
/// Helpers for gnuplot scripts that draw SVG plots for an HTML page. Black is replaced by the page's text color (report/html_page.h); the
/// plot colors are legible on white and on black.
#pragma once
#include <string>

namespace catena::app {

/// Returns the gnuplot commands for terminal, border, grid and key; size in pixels.
std::string plot_preamble(int width, int height);
/// Returns the gnuplot command for the tics of a logarithmic axis from `lo` to `hi`; `axis` is 'x' or 'y'. An axis of less than three
/// decades gets additional tics between the powers of ten, so that even a short axis has some.
std::string log_tics(char axis, double lo, double hi);
/// Returns the i-th plot color, "#rrggbb"; the palette repeats.
std::string plot_color(int i);
/// Returns the text as a single-quoted gnuplot string.
std::string quote_for_gnuplot(const std::string& text);

/// The data blocks of one plot and the items of its plot command.
struct PlotData {
  std::string data_blocks, plot_items;
  /// Adds `rows` as a data block with that name ("$a"), plotted as "NAME STYLE"; does nothing if `rows` is empty.
  void add(const std::string& name, const std::string& rows, const std::string& style);
};

}  // namespace catena::app
