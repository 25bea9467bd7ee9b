// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "engine/app/cli/command.h"
#include "engine/app/tuning/measure/format_number.h"
#include "engine/app/tuning/measure/pareto_choice.h"
#include "engine/app/tuning/report/glossary.h"
#include "engine/app/tuning/report/html_page.h"
#include "engine/app/tuning/report/report.h"

namespace catena::app::tuning {
namespace {

std::string number(double value) { return with_short_exponent(format_short(value)); }

std::string time_text(const Timing& t) {
  return std::isfinite(t.median) ? fmt::format("{:.4g} <small>({:.4g} .. {:.4g})</small>", t.median, t.lower_quartile, t.upper_quartile)
                                 : "-";
}

const Point* same(const Curve* other, const Point& p) {
  if (other == nullptr) return nullptr;
  for (const Point& theirs : other->points)
    if (theirs.setting == p.setting) return &theirs;
  return nullptr;
}

/// Configuration text of a point as HTML: code throughout, or only between backquotes.
std::string ask(const Point& p) {
  if (p.config_text.find('`') == std::string::npos) return p.config_text.empty() ? "" : "<code>" + escape_html(p.config_text) + "</code>";
  std::string text;
  bool code = false;
  for (std::size_t at = 0; at <= p.config_text.size(); code = !code) {
    const std::size_t end = std::min(p.config_text.find('`', at), p.config_text.size());
    const std::string part = escape_html(p.config_text.substr(at, end - at));
    text += code ? "<code>" + part + "</code>" : part;
    at = end + 1;
  }
  return text;
}

/// Formats a cost such as "481.4 us of processor time per second".
std::string cost_text(const Curve& c, const Point& p) {
  const std::string& unit = c.cost == CostKind::time ? c.time_name : c.cost == CostKind::work ? c.work_name : c.bytes_name;
  return fmt::format("{} <small>{}</small>", c.cost == CostKind::bytes ? format_bytes(p.bytes) : number(get_cost(p, c.cost)),
                     escape_html(unit));
}

std::string points_table(const Curve& c, const Curve* other) {
  // a column is omitted if no row has a value
  const bool asked = std::any_of(c.points.begin(), c.points.end(), [](const Point& p) { return !p.config_text.empty(); });
  std::string text = "<div class=\"wide\"><table><tr><th>setting</th>";
  if (asked) text += "<th>option or key</th>";
  if (!c.front.empty()) text += "<th>front</th>";
  const auto column = [&](const std::string& name) {
    if (!name.empty()) text += "<th class=\"n\">" + escape_html(name) + "</th>";
  };
  column(c.error_name);
  column(c.time_name);
  if (other != nullptr && !c.time_name.empty()) text += "<th class=\"n\">time of the other report</th><th class=\"n\">other / this</th>";
  if (other != nullptr && !c.error_name.empty()) text += "<th class=\"n\">error of the other report</th>";
  column(c.work_name);
  column(c.bytes_name);
  for (const std::string& name : c.extra_columns) column(name);
  text += "</tr>\n";
  for (std::size_t i = 0; i < c.points.size(); ++i) {
    const Point& p = c.points[i];
    const Point* theirs = same(other, p);
    const int index = static_cast<int>(i);
    text += fmt::format("<tr{}><td>{}{}{}</td>", index == c.chosen ? " class=\"chosen\"" : "", escape_html(p.setting),
                        index == c.chosen ? " <b>(chosen)</b>" : "", index == c.current ? " <b>(current)</b>" : "");
    if (asked) text += "<td>" + ask(p) + "</td>";
    if (!c.front.empty()) text += fmt::format("<td>{}</td>", is_on_front(c, index) ? "&#9679;" : "");
    const auto cell = [&](const std::string& value) { text += "<td class=\"n\">" + value + "</td>"; };
    if (!c.error_name.empty()) cell(number(p.error));
    if (!c.time_name.empty()) cell(time_text(p.time));
    if (other != nullptr && !c.time_name.empty()) {
      cell(theirs != nullptr ? time_text(theirs->time) : "-");
      cell(theirs != nullptr ? number(theirs->time.median / p.time.median) : "-");
    }
    if (other != nullptr && !c.error_name.empty()) cell(theirs != nullptr ? number(theirs->error) : "-");
    if (!c.work_name.empty()) cell(number(p.work));
    if (!c.bytes_name.empty()) cell(std::isfinite(p.bytes) ? format_bytes(p.bytes) : "-");
    for (const double value : p.extra_values) cell(number(value));
    text += "</tr>\n";
  }
  return text + "</table></div>\n";
}

/// Returns whether the chosen setting is the scene's own or can be written into the scene.
bool can_be_had(const Curve& c) { return c.chosen >= 0 && (c.chosen == c.current || !c.points[c.chosen].config_text.empty()); }

std::string section(const Curve& c, const Curve* other, const std::vector<std::string>& plots) {
  std::string text =
      fmt::format("<h3 id=\"{0}\">{1}</h3>\n<p>{2}</p>\n", escape_html(c.id), escape_html(c.title), escape_html(c.description));
  if (c.chosen >= 0) {
    const Point& p = c.points[c.chosen];
    text += fmt::format("<p class=\"why\"><b>{}: {}.</b> {}", can_be_had(c) ? "Choose" : "Best choice, which no single setting selects",
                        escape_html(p.setting), escape_html(c.choice_reason));
    if (c.chosen == c.current)
      text += " <b>The scene has this setting.</b>";
    else if (!p.config_text.empty())
      text += " <b>Set</b> " + ask(p) + ".";
    else if (c.category == "eye")  // the tuning searches all rendering settings
      text += fmt::format(" <code>--quality error={:.2g}</code> finds the fastest settings of that accuracy.",
                          std::max(p.error, min_resolvable_error(c)));
    text += "</p>\n";
  } else if (!c.choice_reason.empty())
    text += "<p class=\"why\">" + escape_html(c.choice_reason) + "</p>\n";
  text += plots_row(plots) + points_table(c, other) + "<p class=\"note\">";
  if (std::isfinite(c.discretization_error))
    text += fmt::format("Dashed line: {}; {}. ", escape_html(describe_discretization_error(c)), escape_html(c.discretization_error_method));
  else if (!c.discretization_error_method.empty())
    text += escape_html(c.discretization_error_method) + " ";
  if (!c.reference.empty()) text += fmt::format("The reference is {}. ", escape_html(c.reference));
  return text + fmt::format("As a table: <code>{}.csv</code></p>\n", escape_html(c.id));
}

std::string summary(const Report& report) {
  std::string text =
      "<div class=\"wide\"><table><tr><th>setting</th><th>current</th><th>recommended</th><th>option or key</th><th "
      "class=\"n\">error</th><th class=\"n\">discretization error, or limit</th><th class=\"n\">cost</th></tr>\n";
  for (const Curve& c : report.curves) {
    if (!can_be_had(c)) continue;
    const Point& p = c.points[c.chosen];
    text += fmt::format(
        "<tr><td><a href=\"#{}\">{}</a></td><td>{}</td><td>{}</td><td>{}</td><td class=\"n\">{} <small>{}</small></td><td "
        "class=\"n\">{}</td><td class=\"n\">{}</td></tr>\n",
        escape_html(c.id), escape_html(c.title), c.current >= 0 ? escape_html(c.points[c.current].setting) : "-", escape_html(p.setting),
        c.chosen == c.current ? "no change" : ask(p), number(p.error), escape_html(c.error_name), number(c.discretization_error),
        cost_text(c, p));
  }
  return text + "</table></div>\n";
}

/// The list of terms at the end of the page.
std::string words_used(const Report& report) {
  std::string all;
  for (const Curve& c : report.curves) {
    for (const std::string* words : {&c.title, &c.description, &c.error_name, &c.work_name, &c.time_name, &c.choice_reason,
                                     &c.discretization_error_method, &c.reference})
      all += *words + "\n";
    for (const std::string& name : c.extra_columns) all += name + "\n";
    for (const Point& p : c.points) all += p.setting + "\n";
  }
  std::string text = "<h2 id=\"words\">Glossary</h2>\n<dl>\n";
  for (const GlossaryEntry& word : report_glossary())
    if (word.trigger == nullptr || all.find(word.trigger) != std::string::npos)
      text += fmt::format("<dt>{}</dt><dd>{}</dd>\n", escape_html(word.term), escape_html(word.definition));
  return text + "</dl>\n";
}

std::string about_table(const Report& report, const Report* other) {
  std::string text = "<table>";
  if (other != nullptr) text += "<tr><th></th><th>this report</th><th>other report</th></tr>";
  for (const auto& [key, value] : report.metadata) {
    text += fmt::format("<tr><th>{}</th><td>{}</td>", escape_html(key), escape_html(value));
    if (other != nullptr) {
      const auto found = std::find_if(other->metadata.begin(), other->metadata.end(), [&](const auto& item) { return item.first == key; });
      text += "<td>" + (found != other->metadata.end() ? escape_html(found->second) : "-") + "</td>";
    }
    text += "</tr>\n";
  }
  return text + "</table>\n";
}

}  // namespace

std::string to_html(const Report& report, const Report* other, const std::vector<std::vector<std::string>>& plots) {
  std::string text = html_page_head("Accuracy against cost");
  text += fmt::format("<h1>{}: accuracy against cost</h1>\n", escape_html(report.source));
  text +=
      "<p>The settings below were measured on this scene and this machine, one kind of setting at a time, with the others fixed. In the "
      "plots, lower is more accurate and further left is cheaper. The dashed line is the discretization error: accuracy below this line "
      "shows nothing that was measured. <b>(current)</b> marks the setting of the scene, <b>(chosen)</b> the recommended setting. Times "
      "are "
      "medians of interleaved repetitions, with their quartiles in brackets and as bars. \"Keys\" belong to the scene file, at the link, "
      "field or part that they refer to; --options belong to the command line. The <a href=\"#words\">glossary</a> at the end explains the "
      "terms.</p>\n";
  if (other != nullptr && other->source != report.source)
    text += "<p class=\"why\">The other report is of another scene, " + escape_html(other->source) +
            ": only settings with the same name are compared.</p>\n";
  text += "<h2>Summary</h2>\n" + summary(report) + "<h2>Machine</h2>\n" + about_table(report, other);
  bool drawn = false;
  for (const auto& [part, heading] : {std::pair{"data", "Data"}, {"hand", "Haptics"}, {"eye", "Rendering"}}) {
    bool begun = false;
    for (std::size_t i = 0; i < report.curves.size(); ++i) {
      const Curve& c = report.curves[i];
      if (c.category != part) continue;
      if (!begun) text += fmt::format("<h2>{}</h2>\n", heading);
      begun = true;
      drawn = drawn || (i < plots.size() && !plots[i].empty());
      text += section(c, find_curve(other, c.id), i < plots.size() ? plots[i] : std::vector<std::string>());
    }
  }
  if (!report.skipped.empty() || !drawn) text += "<h2>Not measured</h2>\n<ul>\n";
  if (!drawn) text += "<li>Plots: gnuplot is not installed, or there is no curve to plot; the tables are complete.</li>\n";
  for (const std::string& sentence : report.skipped) text += "<li>" + escape_html(sentence) + "</li>\n";
  if (!report.skipped.empty() || !drawn) text += "</ul>\n";
  return text + words_used(report) + html_page_end();
}

}  // namespace catena::app::tuning
