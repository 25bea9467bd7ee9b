// SPDX-License-Identifier: MIT
/// Writes the tables of results: a missing number is an empty cell, which R and Python read as missing.
#include <fmt/format.h>

#include <cmath>

#include "engine/app/study/analyse/analysis.h"
#include "engine/app/tuning/report/results_dir.h"

namespace catena::app::analysis {
namespace {

void add_number(CsvTable& table, double value) {
  if (std::isfinite(value))
    table.add(value);
  else
    table.add("");
}

void add_place(CsvTable& table, const Study& study, const TaskCondition& place) {
  table.add(study.tasks[static_cast<std::size_t>(place.task)].name);
  table.add(study.conditions[static_cast<std::size_t>(place.condition)].name);
}

/// Formats a list such as "7 12".
std::string numbers_text(const std::vector<int>& numbers) {
  std::string text;
  for (const int n : numbers) text += (text.empty() ? "" : " ") + std::to_string(n);
  return text;
}

constexpr const char* kTestColumns =
    "n,first_mean,first_sd,second_mean,second_sd,difference,low,high,t,df,p,p_holm,d_z,d_z_low,d_z_high,p_sign_flips,sign_flips_exact,"
    "left_out,why_not";

void add_test(CsvTable& table, const PairedComparison& p) {
  const bool is = p.test.has_value();
  table.add(is ? p.test->n : 0);
  for (const statistics::Summary* s : {&p.first_summary, &p.second_summary}) {
    add_number(table, s->n > 0 ? s->mean : kNotComputed);
    add_number(table, s->n > 0 ? s->sd : kNotComputed);
  }
  const statistics::PairedTest t = p.test.value_or(statistics::PairedTest{});
  for (const double value : {t.difference, t.low, t.high, t.t, t.df, t.p, p.corrected_p, t.effect, t.effect_low, t.effect_high})
    add_number(table, is ? value : kNotComputed);
  add_number(table, p.sign_flip_test ? p.sign_flip_test->p : kNotComputed);
  table.add(!p.sign_flip_test ? "" : p.sign_flip_test->exact ? "1" : "0");
  table.add(numbers_text(p.excluded_subjects)).add(csv_text(p.skip_reason));
}

}  // namespace

std::string subjects_csv(const Study& study, const Analysis& analysis) {
  CsvTable table("subject,task,condition,trials,kept,error_mean_mm,time_mean_s,error_sd_mm,time_sd_s,slope");
  for (std::size_t s = 0; s < analysis.subjects.size(); ++s)
    for (int t = 0; t < static_cast<int>(analysis.task_count); ++t)
      for (int c = 0; c < static_cast<int>(analysis.condition_count); ++c) {
        const Cell& cell = analysis.cell(s, {t, c});
        table.add(analysis.subjects[s]);
        add_place(table, study, {t, c});
        table.add(cell.trials).add(cell.accepted);
        for (const double value : cell.values) add_number(table, value);
        table.end_row();
      }
  return table.text();
}

std::string means_csv(const Study& study, const Analysis& analysis) {
  CsvTable table("measure,task,condition,n,mean,sd,low,high,overlaps_baseline");
  for (const ConditionMean& m : analysis.means) {
    table.add(to_string(m.quantity));
    add_place(table, study, m.task_condition);
    const statistics::Summary s = m.result.value_or(statistics::Summary{});
    table.add(s.n);
    for (const double value : {s.mean, s.sd, s.low(), s.high()}) add_number(table, m.result ? value : kNotComputed);
    table.add(!m.overlaps_baseline ? "" : *m.overlaps_baseline ? "1" : "0");
    table.end_row();
  }
  return table.text();
}

std::string tests_csv(const Study& study, const Analysis& analysis) {
  CsvTable table(std::string("family,measure,first_task,first_condition,second_task,second_condition,") + kTestColumns);
  for (const auto& [family, tests] : {std::pair{"conditions", &analysis.condition_comparisons}, {"tasks", &analysis.task_comparisons}})
    for (const PairedComparison& p : *tests) {
      table.add(family).add(to_string(p.quantity));
      add_place(table, study, p.first);
      add_place(table, study, p.second);
      add_test(table, p);
      table.end_row();
    }
  return table.text();
}

std::string slopes_csv(const Study& study, const Analysis& analysis) {
  CsvTable table(std::string("task,baseline,condition,") + kTestColumns);
  for (const PairedComparison& p : analysis.tradeoff_comparisons) {
    add_place(table, study, p.first);
    table.add(study.conditions[static_cast<std::size_t>(p.second.condition)].name);
    add_test(table, p);
    table.end_row();
  }
  return table.text();
}

std::string correlations_csv(const Study& study, const Analysis& analysis) {
  CsvTable table("task,condition,n,r,low,high,t,df,p,p_holm,left_out,change_z,change_p,change_p_holm,why_not");
  for (const ConditionCorrelation& x : analysis.correlations) {
    add_place(table, study, x.task_condition);
    const statistics::Correlation c = x.result.value_or(statistics::Correlation{});
    table.add(c.n);
    for (const double value : {c.r, c.low, c.high, c.t, c.df, c.p, x.corrected_p}) add_number(table, x.result ? value : kNotComputed);
    table.add(numbers_text(x.excluded_subjects));
    const CorrelationChange* change = nullptr;
    for (const CorrelationChange& other : analysis.correlation_changes)
      if (other.task_condition == x.task_condition) change = &other;
    const bool has = change != nullptr && change->result;
    for (const double value :
         {has ? change->result->z : kNotComputed, has ? change->result->p : kNotComputed, has ? change->corrected_p : kNotComputed})
      add_number(table, value);
    table.add(csv_text(x.skip_reason));
    table.end_row();
  }
  return table.text();
}

std::string rejections_csv(const Study& study, const Analysis& analysis) {
  CsvTable table("task,condition,trials,rejected,by_error,by_time,by_both,unfinished");
  for (int t = 0; t < static_cast<int>(analysis.task_count); ++t)
    for (int c = 0; c < static_cast<int>(analysis.condition_count); ++c) {
      const Rejections& r = analysis.rejections_in({t, c});
      add_place(table, study, {t, c});
      table.add(r.trials).add(r.total()).add(r.error).add(r.time).add(r.both).add(r.unfinished);
      table.end_row();
    }
  return table.text();
}

std::string findings_csv(const study::AnalysisPlan& inquiry, const Analysis& analysis) {
  CsvTable table("verdict,test,paper,reported,numbers");
  for (std::size_t i = 0; i < inquiry.findings.size(); ++i) {
    const study::Finding& f = inquiry.findings[i];
    table.add(to_string(analysis.findings[i].verdict)).add(study::to_string(f.test));
    table.add(csv_text(f.claim)).add(csv_text(f.reported)).add(csv_text(analysis.findings[i].text()));
    table.end_row();
  }
  return table.text();
}

}  // namespace catena::app::analysis
