/// A report as one page of HTML that opens without a network, in light and dark: what the pages of `tradeoff` and `study analyse` share.
#pragma once
#include <string>
#include <vector>

namespace catena::app {

/// All up to the first heading. Classes of the style: `n` a cell with a number, `wide` around a table that may scroll, `plots`, `why` a
/// sentence that matters, `note` small print, `chosen` a row that matters.
std::string html_page_head(const std::string& title);
std::string html_page_end();
/// Pictures (SVG of gnuplot's) side by side.
std::string plots_row(const std::vector<std::string>& plots);

/// Text that is not ours, on one line, with its markup escaped.
std::string escape_html(const std::string& text);
/// "1.2e-06", "0", "-" for what was not measured.
std::string format_short(double value);

}  // namespace catena::app
