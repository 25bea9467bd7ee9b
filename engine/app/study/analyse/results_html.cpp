// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <cmath>

#include "engine/app/study/analyse/analysis.h"
#include "engine/app/tuning/report/html_page.h"
#include "engine/app/tuning/report/system_info.h"

namespace catena::app::analysis {
namespace {

std::string cell(const std::string& text) { return "<td>" + escape_html(text) + "</td>"; }
std::string number_cell(const std::string& text) { return "<td class=\"n\">" + escape_html(text) + "</td>"; }
std::string number_cell(double value) { return number_cell(format_short(value)); }
std::string interval_cell(double low, double high) { return number_cell(format_short(low) + " .. " + format_short(high)); }

/// A header row: names of numeric columns begin with a blank.
std::string table_head(const std::vector<std::string>& names) {
  std::string text = "<div class=\"wide\"><table><tr>";
  for (const std::string& name : names)
    text += name.starts_with(' ') ? "<th class=\"n\">" + escape_html(name.substr(1)) + "</th>" : "<th>" + escape_html(name) + "</th>";
  return text + "</tr>\n";
}
constexpr const char* kTableEnd = "</table></div>\n";

std::string csv_note(const char* name) { return fmt::format("<p class=\"note\">As a table: <code>{}</code></p>\n", name); }

/// Formats a list such as "2, 7 and 12".
std::string numbers_words(const std::vector<int>& numbers) {
  std::string text;
  for (std::size_t i = 0; i < numbers.size(); ++i)
    text += (i == 0 ? "" : i + 1 == numbers.size() ? " and " : ", ") + std::to_string(numbers[i]);
  return text;
}

/// Table cell with one line per part of the finding.
std::string parts_cell(const FindingResult& judged) {
  std::string text = "<td class=\"told\">" + (judged.supported_count.empty() ? "" : escape_html(judged.supported_count) + "<br>");
  for (std::size_t i = 0; i < judged.details.size(); ++i) text += (i > 0 ? "<br>" : "") + escape_html(judged.details[i]);
  return text + "</td>";
}

std::string findings_table(const study::AnalysisPlan& inquiry, const Analysis& analysis) {
  std::string text = table_head({"finding", "reported", "result", "numbers"});
  for (std::size_t i = 0; i < inquiry.findings.size(); ++i) {
    const study::Finding& f = inquiry.findings[i];
    const FindingResult& judged = analysis.findings[i];
    text += fmt::format("<tr{}><td class=\"says\">{}</td>{}<td><b>{}</b></td>{}</tr>\n",
                        judged.verdict == Verdict::supported ? " class=\"chosen\"" : "", escape_html(f.claim), cell(f.reported),
                        to_string(judged.verdict), parts_cell(judged));
  }
  return text + kTableEnd + csv_note("findings.csv");
}

std::string means_table(const Study& study, const Analysis& analysis) {
  std::string text =
      table_head({"task, condition", "measure", " subjects", " mean", " deviation", " 95 % interval", "overlaps the baseline's interval"});
  for (const ConditionMean& m : analysis.means) {
    if (m.quantity == Quantity::slope) continue;
    text += "<tr>" + cell(task_condition_label(study, m.task_condition)) +
            cell(std::string(quantity_label(m.quantity)) + ", " + quantity_unit(m.quantity));
    if (m.result)
      text += number_cell(std::to_string(m.result->n)) + number_cell(m.result->mean) + number_cell(m.result->sd) +
              interval_cell(m.result->low(), m.result->high()) +
              cell(!m.overlaps_baseline   ? ""
                   : *m.overlaps_baseline ? "overlaps"
                                          : "apart");
    else
      text += "<td colspan=\"5\">" + escape_html(m.skip_reason) + "</td>";
    text += "</tr>\n";
  }
  return text + kTableEnd + csv_note("means.csv");
}

std::string tests_table(const Study& study, const std::vector<PairedComparison>& tests, const std::string& measure) {
  std::string text = table_head({"", "first - second", measure, " first", " second", " difference", " 95 % interval", " t(df)", " p",
                                 " corrected", " sign flips", " d_z", " 95 % interval", "excluded subjects"});
  for (const PairedComparison& p : tests) {
    text += p.test && p.corrected_p < kAlpha ? "<tr class=\"chosen\">" : "<tr>";
    const std::string unit = quantity_unit(p.quantity);
    const bool tasks = p.first.task != p.second.task;
    text += cell(tasks ? study.conditions[static_cast<std::size_t>(p.first.condition)].name
                       : study.tasks[static_cast<std::size_t>(p.first.task)].name);
    text += "<td class=\"whole\">" + escape_html(difference_label(study, p)) + "</td>";
    text += "<td class=\"whole\">" + (measure.empty() ? "" : escape_html(quantity_label(p.quantity) + (unit.empty() ? "" : ", " + unit))) +
            "</td>";
    if (p.test) {
      const statistics::PairedTest& t = *p.test;
      text += number_cell(p.first_summary.mean) + number_cell(p.second_summary.mean) + number_cell(t.difference) +
              interval_cell(t.low, t.high) + number_cell(fmt::format("{:.2f} ({:g})", t.t, t.df)) + number_cell(format_p(t.p)) +
              number_cell(format_p(p.corrected_p)) + number_cell(p.sign_flip_test ? format_p(p.sign_flip_test->p) : "-") +
              number_cell(fmt::format("{:.2f}", t.effect)) + number_cell(fmt::format("{:.2f} .. {:.2f}", t.effect_low, t.effect_high));
    } else {
      text += "<td colspan=\"10\">" + escape_html(p.skip_reason) + "</td>";
    }
    text += cell(numbers_words(p.excluded_subjects)) + "</tr>\n";
  }
  return text + kTableEnd;
}

std::string correlations_table(const Study& study, const Analysis& analysis) {
  std::string text = table_head({"task, condition", " subjects", " r", " 95 % interval", " t(df)", " p", " corrected",
                                 " compared with the baseline: z", " p", " corrected"});
  for (const ConditionCorrelation& x : analysis.correlations) {
    text += x.result && x.corrected_p < kAlpha ? "<tr class=\"chosen\">" : "<tr>";
    text += cell(task_condition_label(study, x.task_condition));
    if (x.result)
      text += number_cell(std::to_string(x.result->n)) + number_cell(fmt::format("{:.3f}", x.result->r)) +
              number_cell(fmt::format("{:.2f} .. {:.2f}", x.result->low, x.result->high)) +
              number_cell(fmt::format("{:.2f} ({:g})", x.result->t, x.result->df)) + number_cell(format_p(x.result->p)) +
              number_cell(format_p(x.corrected_p));
    else
      text += "<td colspan=\"6\">" + escape_html(x.skip_reason) + "</td>";
    const CorrelationChange* change = nullptr;
    for (const CorrelationChange& other : analysis.correlation_changes)
      if (other.task_condition == x.task_condition) change = &other;
    if (change != nullptr && change->result)
      text += number_cell(fmt::format("{:.2f}", change->result->z)) + number_cell(format_p(change->result->p)) +
              number_cell(format_p(change->corrected_p));
    else
      text += "<td colspan=\"3\">" + escape_html(change != nullptr ? change->skip_reason : "") + "</td>";
    text += "</tr>\n";
  }
  return text + kTableEnd + csv_note("correlations.csv");
}

std::string rejections_table(const Study& study, const Analysis& analysis) {
  std::string text = table_head({"task, condition", " trials", " rejected", " error", " time", " both", " not finished"});
  const auto row = [&](const std::string& name, const Rejections& r) {
    text += "<tr>" + cell(name);
    for (const int n : {r.trials, r.total(), r.error, r.time, r.both, r.unfinished}) text += number_cell(std::to_string(n));
    text += "</tr>\n";
  };
  for (int t = 0; t < static_cast<int>(analysis.task_count); ++t)
    for (int c = 0; c < static_cast<int>(analysis.condition_count); ++c)
      row(task_condition_label(study, {t, c}), analysis.rejections_in({t, c}));
  row("all", analysis.total_rejections());
  return text + kTableEnd + csv_note("rejections.csv");
}

std::string list_of(const std::vector<std::string>& lines) {
  std::string text = "<ul>\n";
  for (const std::string& line : lines) text += "<li>" + escape_html(line) + "</li>\n";
  return text + "</ul>\n";
}

/// Returns a warning for conditions with many more rejected trials than others, whose remaining trials are not comparable.
std::string uneven_shares(const Study& study, const Analysis& analysis) {
  constexpr double kUneven = 0.1;
  std::vector<std::string> lines;
  for (int t = 0; t < static_cast<int>(analysis.task_count); ++t)
    for (int c = 1; c < static_cast<int>(analysis.condition_count); ++c) {
      const Rejections &a = analysis.rejections_in({t, 0}), &b = analysis.rejections_in({t, c});
      if (a.trials == 0 || b.trials == 0) continue;
      const double share_a = static_cast<double>(a.total()) / a.trials, share_b = static_cast<double>(b.total()) / b.trials;
      if (std::fabs(share_a - share_b) > kUneven)
        lines.push_back(fmt::format("{}: {:.0f} %; {}: {:.0f} %", task_condition_label(study, {t, 0}), 100 * share_a,
                                    task_condition_label(study, {t, c}), 100 * share_b));
    }
  if (lines.empty()) return {};
  return "<p class=\"why\">Many more trials were rejected in one condition than in the other, so that the remaining trials are not "
         "comparable:</p>\n" +
         list_of(lines);
}

std::string section(const char* heading, const std::string& what, const std::vector<std::string>& plots = {}) {
  return fmt::format("<h2>{}</h2>\n<p>{}</p>\n", heading, escape_html(what)) + (plots.empty() ? "" : plots_row(plots));
}

std::string limits_words(const Study& study) {
  std::string text;
  for (const study::Task& t : study.tasks)
    text += fmt::format("{}{} {:g} mm or {:g} s", text.empty() ? "" : ", ", t.name, t.limits.reject_error_mm, t.limits.reject_time_s);
  return text;
}

/// Summary: the amount of data and the main results.
std::string summary(const Study& study, const Analysis& analysis, const DataSource& source) {
  const Rejections all = analysis.total_rejections();
  int counts[3] = {};
  for (const FindingResult& j : analysis.findings) ++counts[static_cast<int>(j.verdict)];
  std::string text = "<table>";
  const auto row = [&](const char* what, const std::string& value) { text += fmt::format("<tr><th>{}</th>{}</tr>\n", what, cell(value)); };
  row("data", fmt::format("{}{}", source.folder, source.is_simulated ? ", simulated" : ""));
  row("subjects", fmt::format("{} (design: {})", analysis.subjects.size(), study.subjects));
  row("trials", fmt::format("{}, of which {} ({:.1f} %) were rejected; {} training trials are not counted", all.trials, all.total(),
                            all.trials > 0 ? 100.0 * all.total() / all.trials : 0.0, analysis.training_count));
  row("findings", fmt::format("{} supported, {} not supported, {} not testable", counts[0], counts[1], counts[2]));
  for (const auto& [key, value] : system_info())
    if (key == "version" || key == "date") row(key.c_str(), value);
  return text + "</table>\n";
}

constexpr const char* kHow =
    "<h2>Methods</h2>\n<ul>\n"
    "<li>Errors are measured at the position of the device, which is also the position of the cursor in the image, not at a proxy.</li>\n"
    "<li>The value of a subject in a task and condition is the mean, or the standard deviation, over the accepted trials. All intervals "
    "and "
    "tests are over subjects.</li>\n"
    "<li>Tests are two-sided paired t-tests. d_z is the mean difference divided by the standard deviation of the differences; its interval "
    "follows from the noncentral t distribution.</li>\n"
    "<li>p-values are corrected by Holm's method within a table; rows below 0.05 after correction are marked. &ldquo;Sign flips&rdquo; is "
    "the permutation test of the same differences, which does not assume a normal distribution: exact up to 32 subjects; it is not "
    "corrected.</li>\n"
    "<li>A finding over several tasks or conditions is supported if all of them support it after correction. &ldquo;Not "
    "supported&rdquo; means that these data do not show the finding, not that the finding is wrong.</li>\n"
    "<li>Correlations are Pearson's, over the means of the subjects, with Fisher's intervals; two correlations of the same subjects are "
    "compared by the test of Raghunathan, Rosenthal and Rubin (1996).</li>\n</ul>\n";

constexpr const char* kPageStyle =
    "<style>td.says { min-width: 13rem; white-space: normal !important; } td.told { min-width: 45rem; } td.whole { white-space: nowrap; "
    "}</style>\n";

}  // namespace

std::string to_html(const Study& study, const study::AnalysisPlan& inquiry, const Analysis& analysis, const DataSource& source,
                    const std::vector<SubjectAnswers>& answers, const PlotImages& images) {
  std::string text = html_page_head(study.name + ": results") + kPageStyle;
  text += fmt::format("<h1>{}: results</h1>\n", escape_html(study.name));
  if (source.is_simulated) text += fmt::format("<p class=\"why\"><b>Simulated.</b> {}</p>\n", kSimulatedDataNotice);
  text += summary(study, analysis, source);
  if (!inquiry.findings.empty())
    text += section("Findings", "The findings that the study file states, and the results of their tests on these data.") +
            findings_table(inquiry, analysis);
  text +=
      section("Conditions: means",
              "Means over the subjects with 95 % intervals. Every subject did all conditions, so that the paired tests below show whether "
              "conditions differ: means may differ significantly although their intervals overlap.",
              images.means) +
      means_table(study, analysis);
  text += section("Conditions: paired tests", "Paired comparison of two conditions by the means and standard deviations of the subjects.") +
          tests_table(study, analysis.condition_comparisons, "measure") + csv_note("tests.csv");
  if (!analysis.task_comparisons.empty())
    text += section("Tasks", "Paired comparison of two tasks.") + tests_table(study, analysis.task_comparisons, "measure") +
            csv_note("tests.csv");
  text += section("Error and time", "Each point is a subject: mean error over mean time.", images.correlations) +
          correlations_table(study, analysis);
  text += section("Speed-accuracy trade-off",
                  "Slope of log error on log time over the trials of a subject. -1: half the time doubles the error; 0: the error does not "
                  "depend on the time.",
                  images.tradeoffs) +
          tests_table(study, analysis.tradeoff_comparisons, "") + csv_note("slopes.csv");
  text +=
      section("Rejected trials", "Trials beyond the study's limits (" + limits_words(study) + "), or not finished within the time limit.") +
      rejections_table(study, analysis);
  text += uneven_shares(study, analysis);
  text += answers_html(study, answers);
  if (!analysis.notes.empty()) text += "<h2>Deviations from the design</h2>\n" + list_of(analysis.notes);
  if (!analysis.missing_data.empty()) {
    text += "<h2>Missing data</h2>\n" + list_of(analysis.missing_data);
  }
  if (images.means.empty())
    text += "<p>There are no plots: there are no data to plot, or the program gnuplot is not installed. The tables are complete.</p>\n";
  return text + kHow + html_page_end();
}

}  // namespace catena::app::analysis
