#include <fmt/format.h>

#include <cmath>

#include "engine/app/report/machine.h"
#include "engine/app/report/page.h"
#include "engine/app/study/analyse/analysis.h"

namespace catena::app::analysis {
namespace {

std::string cell(const std::string& text) { return "<td>" + escaped(text) + "</td>"; }
std::string number_cell(const std::string& text) { return "<td class=\"n\">" + escaped(text) + "</td>"; }
std::string number_cell(double value) { return number_cell(short_number(value)); }
std::string interval_cell(double low, double high) { return number_cell(short_number(low) + " .. " + short_number(high)); }

/// A header row: names of columns of numbers begin with a blank.
std::string table_head(const std::vector<std::string>& names) {
  std::string text = "<div class=\"wide\"><table><tr>";
  for (const std::string& name : names)
    text += name.starts_with(' ') ? "<th class=\"n\">" + escaped(name.substr(1)) + "</th>" : "<th>" + escaped(name) + "</th>";
  return text + "</tr>\n";
}
constexpr const char* kTableEnd = "</table></div>\n";

std::string csv_note(const char* name) { return fmt::format("<p class=\"note\">As a table: <code>{}</code></p>\n", name); }

/// "2, 7 and 12"
std::string numbers_words(const std::vector<int>& numbers) {
  std::string text;
  for (std::size_t i = 0; i < numbers.size(); ++i)
    text += (i == 0 ? "" : i + 1 == numbers.size() ? " and " : ", ") + std::to_string(numbers[i]);
  return text;
}

/// A line a part.
std::string parts_cell(const Judged& judged) {
  std::string text = "<td class=\"told\">" + (judged.count.empty() ? "" : escaped(judged.count) + "<br>");
  for (std::size_t i = 0; i < judged.numbers.size(); ++i) text += (i > 0 ? "<br>" : "") + escaped(judged.numbers[i]);
  return text + "</td>";
}

std::string findings_table(const study::Inquiry& inquiry, const Analysis& analysis) {
  std::string text = table_head({"finding", "as reported", "these data", "numbers of these data"});
  for (std::size_t i = 0; i < inquiry.findings.size(); ++i) {
    const study::Finding& f = inquiry.findings[i];
    const Judged& judged = analysis.findings[i];
    text += fmt::format("<tr{}><td class=\"says\">{}</td>{}<td><b>{}</b></td>{}</tr>\n",
                        judged.verdict == Verdict::supported ? " class=\"chosen\"" : "", escaped(f.paper), cell(f.reported),
                        verdict_word(judged.verdict), parts_cell(judged));
  }
  return text + kTableEnd + csv_note("findings.csv");
}

std::string means_table(const Study& study, const Analysis& analysis) {
  std::string text =
      table_head({"task, condition", "measure", " subjects", " mean", " deviation", " 95 % interval", "with the baseline's"});
  for (const Mean& m : analysis.means) {
    if (m.quantity == Quantity::slope) continue;
    text += "<tr>" + cell(place_text(study, m.place)) + cell(std::string(quantity_name(m.quantity)) + ", " + unit_of(m.quantity));
    if (m.of)
      text += number_cell(std::to_string(m.of->n)) + number_cell(m.of->mean) + number_cell(m.of->sd) +
              interval_cell(m.of->low(), m.of->high()) +
              cell(!m.overlaps   ? ""
                   : *m.overlaps ? "overlaps"
                                 : "apart");
    else
      text += "<td colspan=\"5\">" + escaped(m.why_not) + "</td>";
    text += "</tr>\n";
  }
  return text + kTableEnd + csv_note("means.csv");
}

std::string tests_table(const Study& study, const std::vector<Paired>& tests, const std::string& measure) {
  std::string text = table_head({"", "first - second", measure, " first", " second", " difference", " 95 % interval", " t(df)", " p",
                                 " corrected", " sign flips", " d_z", " 95 % interval", "left out"});
  for (const Paired& p : tests) {
    text += p.test && p.corrected < kAlpha ? "<tr class=\"chosen\">" : "<tr>";
    const std::string unit = unit_of(p.quantity);
    const bool tasks = p.first.task != p.second.task;
    text += cell(tasks ? study.conditions[static_cast<std::size_t>(p.first.condition)].name
                       : study.tasks[static_cast<std::size_t>(p.first.task)].name);
    text += "<td class=\"whole\">" + escaped(difference_text(study, p)) + "</td>";
    text +=
        "<td class=\"whole\">" + (measure.empty() ? "" : escaped(quantity_name(p.quantity) + (unit.empty() ? "" : ", " + unit))) + "</td>";
    if (p.test) {
      const statistics::PairedTest& t = *p.test;
      text += number_cell(p.of_first.mean) + number_cell(p.of_second.mean) + number_cell(t.difference) + interval_cell(t.low, t.high) +
              number_cell(fmt::format("{:.2f} ({:g})", t.t, t.df)) + number_cell(p_text(t.p)) + number_cell(p_text(p.corrected)) +
              number_cell(p.flips ? p_text(p.flips->p) : "-") + number_cell(fmt::format("{:.2f}", t.effect)) +
              number_cell(fmt::format("{:.2f} .. {:.2f}", t.effect_low, t.effect_high));
    } else {
      text += "<td colspan=\"10\">" + escaped(p.why_not) + "</td>";
    }
    text += cell(numbers_words(p.left_out)) + "</tr>\n";
  }
  return text + kTableEnd;
}

std::string correlations_table(const Study& study, const Analysis& analysis) {
  std::string text = table_head({"task, condition", " subjects", " r", " 95 % interval", " t(df)", " p", " corrected",
                                 " beside the baseline's: z", " p", " corrected"});
  for (const Correlated& x : analysis.correlations) {
    text += x.of && x.corrected < kAlpha ? "<tr class=\"chosen\">" : "<tr>";
    text += cell(place_text(study, x.place));
    if (x.of)
      text += number_cell(std::to_string(x.of->n)) + number_cell(fmt::format("{:.3f}", x.of->r)) +
              number_cell(fmt::format("{:.2f} .. {:.2f}", x.of->low, x.of->high)) +
              number_cell(fmt::format("{:.2f} ({:g})", x.of->t, x.of->df)) + number_cell(p_text(x.of->p)) +
              number_cell(p_text(x.corrected));
    else
      text += "<td colspan=\"6\">" + escaped(x.why_not) + "</td>";
    const Change* change = nullptr;
    for (const Change& other : analysis.changes)
      if (other.place == x.place) change = &other;
    if (change != nullptr && change->of)
      text +=
          number_cell(fmt::format("{:.2f}", change->of->z)) + number_cell(p_text(change->of->p)) + number_cell(p_text(change->corrected));
    else
      text += "<td colspan=\"3\">" + escaped(change != nullptr ? change->why_not : "") + "</td>";
    text += "</tr>\n";
  }
  return text + kTableEnd + csv_note("correlations.csv");
}

std::string rejections_table(const Study& study, const Analysis& analysis) {
  std::string text = table_head({"task, condition", " trials", " left out", " error", " time", " both", " not finished"});
  const auto row = [&](const std::string& name, const Rejections& r) {
    text += "<tr>" + cell(name);
    for (const int n : {r.trials, r.rejected(), r.error, r.time, r.both, r.unfinished}) text += number_cell(std::to_string(n));
    text += "</tr>\n";
  };
  for (int t = 0; t < static_cast<int>(analysis.tasks_count); ++t)
    for (int c = 0; c < static_cast<int>(analysis.conditions_count); ++c) row(place_text(study, {t, c}), analysis.rejected({t, c}));
  row("all", analysis.all_rejected());
  return text + kTableEnd + csv_note("rejections.csv");
}

std::string list_of(const std::vector<std::string>& lines) {
  std::string text = "<ul>\n";
  for (const std::string& line : lines) text += "<li>" + escaped(line) + "</li>\n";
  return text + "</ul>\n";
}

/// Where one condition lost many more trials than another, those that are left are not alike.
std::string uneven_shares(const Study& study, const Analysis& analysis) {
  constexpr double kUneven = 0.1;
  std::vector<std::string> lines;
  for (int t = 0; t < static_cast<int>(analysis.tasks_count); ++t)
    for (int c = 1; c < static_cast<int>(analysis.conditions_count); ++c) {
      const Rejections &a = analysis.rejected({t, 0}), &b = analysis.rejected({t, c});
      if (a.trials == 0 || b.trials == 0) continue;
      const double share_a = static_cast<double>(a.rejected()) / a.trials, share_b = static_cast<double>(b.rejected()) / b.trials;
      if (std::fabs(share_a - share_b) > kUneven)
        lines.push_back(
            fmt::format("{}: {:.0f} %; {}: {:.0f} %", place_text(study, {t, 0}), 100 * share_a, place_text(study, {t, c}), 100 * share_b));
    }
  if (lines.empty()) return {};
  return "<p class=\"why\">So many more trials were left out under one condition than under the other that what is left is not a fair "
         "sample of both:</p>\n" +
         list_of(lines);
}

std::string section(const char* heading, const std::string& what, const std::vector<std::string>& plots = {}) {
  return fmt::format("<h2>{}</h2>\n<p>{}</p>\n", heading, escaped(what)) + (plots.empty() ? "" : plots_row(plots));
}

std::string limits_words(const Study& study) {
  std::string text;
  for (const study::Task& t : study.tasks)
    text += fmt::format("{}{} {:g} mm or {:g} s", text.empty() ? "" : ", ", t.name, t.limits.reject_error_mm, t.limits.reject_time_s);
  return text;
}

/// In short: how much data there is, and what it says.
std::string summary(const Study& study, const Analysis& analysis, const Source& source) {
  const Rejections all = analysis.all_rejected();
  int counts[3] = {};
  for (const Judged& j : analysis.findings) ++counts[static_cast<int>(j.verdict)];
  std::string text = "<table>";
  const auto row = [&](const char* what, const std::string& value) { text += fmt::format("<tr><th>{}</th>{}</tr>\n", what, cell(value)); };
  row("data", fmt::format("{}{}", source.folder, source.simulated ? ", simulated" : ""));
  row("subjects", fmt::format("{} (the design is for {})", analysis.subjects.size(), study.subjects));
  row("trials", fmt::format("{}, of which {} ({:.1f} %) were left out; training, {}, is not counted", all.trials, all.rejected(),
                            all.trials > 0 ? 100.0 * all.rejected() / all.trials : 0.0, analysis.training));
  row("findings", fmt::format("{} supported, {} not supported, {} not testable", counts[0], counts[1], counts[2]));
  for (const auto& [key, value] : about_this_machine())
    if (key == "version" || key == "date") row(key.c_str(), value);
  return text + "</table>\n";
}

constexpr const char* kHow =
    "<h2>How it was computed</h2>\n<ul>\n"
    "<li>Errors are those of the device's position, which is also the drawn cursor, never of a proxy.</li>\n"
    "<li>A subject's value in a task and condition is the mean, or the standard deviation, over its kept trials. All intervals and tests "
    "are "
    "over subjects.</li>\n"
    "<li>Tests are two-sided paired t-tests. d_z is the mean difference by the standard deviation of the differences, its interval by the "
    "noncentral t distribution.</li>\n"
    "<li>p-values are corrected by Holm's method within a table; rows below 0.05 after correction are marked. &ldquo;Sign flips&rdquo; is "
    "the "
    "permutation test of the same differences, which does not assume that they are normal: exact up to 32 subjects; it is not "
    "corrected.</li>\n"
    "<li>A finding over several tasks or conditions is supported where all of them bear it out after correction. &ldquo;Not "
    "supported&rdquo; says that these data do not show it, not that it is wrong.</li>\n"
    "<li>Correlations are Pearson's over the subjects' means, their intervals Fisher's; two of the same subjects are compared by the test "
    "of "
    "Raghunathan, Rosenthal and Rubin (1996).</li>\n</ul>\n";

constexpr const char* kPageStyle =
    "<style>td.says { min-width: 13rem; white-space: normal !important; } td.told { min-width: 45rem; } td.whole { white-space: nowrap; "
    "}</style>\n";

}  // namespace

std::string to_html(const Study& study, const study::Inquiry& inquiry, const Analysis& analysis, const Source& source,
                    const std::vector<Answered>& answers, const Drawn& drawn) {
  std::string text = page_head(study.name + ": what its trials say") + kPageStyle;
  text += fmt::format("<h1>{}: what its trials say</h1>\n", escaped(study.name));
  if (source.simulated) text += fmt::format("<p class=\"why\"><b>Simulated.</b> {}</p>\n", kModelSentence);
  text += summary(study, analysis, source);
  if (!inquiry.findings.empty())
    text +=
        section("Findings", "Each finding that the study file names, and what these data say of it.") + findings_table(inquiry, analysis);
  text +=
      section(
          "Conditions: means",
          "Means over the subjects with their 95 % intervals. Every subject did all conditions, so that whether they differ is what the "
          "paired tests below say: their means may differ where intervals overlap.",
          drawn.means) +
      means_table(study, analysis);
  text += section("Conditions: paired tests", "Means and standard deviations of every subject in one condition against another, paired.") +
          tests_table(study, analysis.conditions, "measure") + csv_note("tests.csv");
  if (!analysis.tasks.empty())
    text += section("Tasks", "One task against another, paired.") + tests_table(study, analysis.tasks, "measure") + csv_note("tests.csv");
  text += section("Error and time", "A point is a subject: its mean error over its mean time.", drawn.correlations) +
          correlations_table(study, analysis);
  text +=
      section("The trade",
              "Within a subject: the slope of log error on log time over its trials. -1 says that half the time doubles the error, 0 that "
              "haste costs nothing.",
              drawn.trade) +
      tests_table(study, analysis.trade, "") + csv_note("slopes.csv");
  text +=
      section("Trials that were left out", "Beyond the study's limits: " + limits_words(study) + "; or not finished within the trial.") +
      rejections_table(study, analysis);
  text += uneven_shares(study, analysis);
  text += answers_html(study, answers);
  if (!analysis.notes.empty()) text += "<h2>Not as designed</h2>\n" + list_of(analysis.notes);
  if (!analysis.gaps.empty()) {
    text += "<h2>Missing</h2>\n" + list_of(analysis.gaps);
  }
  if (drawn.means.empty())
    text += "<p>There are no plots: there is nothing to draw, or the program gnuplot is missing. The tables are complete.</p>\n";
  return text + kHow + page_end();
}

}  // namespace catena::app::analysis
