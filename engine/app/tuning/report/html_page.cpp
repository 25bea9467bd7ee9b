// SPDX-License-Identifier: MIT
#include "engine/app/tuning/report/html_page.h"

#include <fmt/format.h>

#include <cmath>

#include "engine/base/text.h"
#include "engine/base/vtk_xml_writer.h"

namespace catena::app {
namespace {

// gnuplot writes black in two ways: both are replaced by the page's text color
constexpr const char* kHead = R"html(<!DOCTYPE html>
<html lang="en"><head><meta charset="utf-8"><meta name="viewport" content="width=device-width"><title>)html";
constexpr const char* kStyle = R"html(</title><style>
:root { color-scheme: light dark; --ink: #1c2024; --paper: #ffffff; --soft: #f1f3f5; --line: #ced4da; --good: #e3f6e8; }
@media (prefers-color-scheme: dark) { :root { --ink: #e4e7ea; --paper: #15181b; --soft: #22272c; --line: #454d55; --good: #163a22; } }
body { color: var(--ink); background: var(--paper); font: 16px/1.5 sans-serif; max-width: 76rem; margin: 2rem auto; padding: 0 1rem; }
h1, h2, h3 { line-height: 1.2; } h2 { margin-top: 3rem; border-bottom: 1px solid var(--line); } h3 { margin-top: 2.5rem; }
table { border-collapse: collapse; font-size: 0.88rem; } th, td { padding: 0.25rem 0.6rem; text-align: left; border-bottom: 1px solid var(--line); vertical-align: top; }
td.n, th.n { text-align: right; font-variant-numeric: tabular-nums; } td.n { white-space: nowrap; } td.n small { white-space: normal; } code { background: var(--soft); padding: 0 0.25rem; }
tr.chosen { background: var(--good); } .why { background: var(--good); padding: 0.5rem 0.8rem; } .plots { display: flex; flex-wrap: wrap; gap: 1rem; }
.plots svg { width: 31rem; max-width: 100%; height: auto; } .wide { overflow-x: auto; } .note { font-size: 0.88rem; }
svg :is([fill="black"], [fill="rgb(0,0,0)"], [fill="rgb(  0,   0,   0)"]) { fill: var(--ink); }
svg :is([stroke="black"], [stroke="rgb(  0,   0,   0)"]) { stroke: var(--ink); }
svg :is([color="black"], [color="rgb(  0,   0,   0)"]) { color: var(--ink); }
td:first-child { min-width: 9rem; } dt { font-weight: bold; } dd { margin: 0 0 0.5rem 1.5rem; }
details { margin: 0.6rem 0; }
</style></head><body>
)html";

}  // namespace

std::string escape_html(const std::string& text) { return escape_xml(one_line(text)); }

std::string format_short(double value) {
  if (!std::isfinite(value)) return "-";
  const bool plain = std::fabs(value) >= 1000 && std::fabs(value) < 1e7;
  return plain ? fmt::format("{:.0f}", value) : fmt::format("{:.3g}", value);
}

std::string html_page_head(const std::string& title) { return kHead + escape_html(title) + kStyle; }

std::string html_page_end() { return "</body></html>\n"; }

std::string plots_row(const std::vector<std::string>& plots) {
  std::string text = "<div class=\"plots\">";
  for (const std::string& plot : plots) text += plot;
  return text + "</div>\n";
}

}  // namespace catena::app
