// SPDX-License-Identifier: MIT
/// Building blocks of a self-contained HTML report page (no network access, light and dark mode), shared by `tradeoff` and `study analyse`.
#pragma once
#include <string>
#include <vector>

namespace catena::app {

/// Returns the page up to the first heading; `title` is escaped. CSS classes: `n` a table cell with a number, `wide` a scrollable block
/// around a table, `plots` a row of plots, `why` a highlighted sentence, `note` small print, `chosen` a highlighted table row.
std::string html_page_head(const std::string& title);
/// Returns the closing tags of the page.
std::string html_page_end();
/// Returns a block with the plots (SVG text from gnuplot) side by side.
std::string plots_row(const std::vector<std::string>& plots);

/// Returns untrusted text joined to one line, with its markup escaped.
std::string escape_html(const std::string& text);
/// Returns the number in short form ("1.2e-06", "0"), or "-" if it is not finite (not measured).
std::string format_short(double value);

}  // namespace catena::app
