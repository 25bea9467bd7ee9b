/// The tables: a number that cannot be had is an empty cell, which R and Python read as missing.
#include <fmt/format.h>

#include <cmath>

#include "engine/app/report/folder.h"
#include "engine/app/study/analyse/analysis.h"

namespace catena::app::analysis {
namespace {

void add_number(CsvTable& table, double value) {
  if (std::isfinite(value))
    table.add(value);
  else
    table.add("");
}

void add_place(CsvTable& table, const Study& study, const Place& place) {
  table.add(study.tasks[static_cast<std::size_t>(place.task)].name);
  table.add(study.conditions[static_cast<std::size_t>(place.condition)].name);
}

/// "7 12"
std::string numbers_text(const std::vector<int>& numbers) {
  std::string text;
  for (const int n : numbers) text += (text.empty() ? "" : " ") + std::to_string(n);
  return text;
}

constexpr const char* kTestColumns =
    "n,first_mean,first_sd,second_mean,second_sd,difference,low,high,t,df,p,p_holm,d_z,d_z_low,d_z_high,p_sign_flips,sign_flips_exact,"
    "left_out,why_not";

void add_test(CsvTable& table, const Paired& p) {
  const bool is = p.test.has_value();
  table.add(is ? p.test->n : 0);
  for (const statistics::Summary* s : {&p.of_first, &p.of_second}) {
    add_number(table, s->n > 0 ? s->mean : kNone);
    add_number(table, s->n > 0 ? s->sd : kNone);
  }
  const statistics::PairedTest t = p.test.value_or(statistics::PairedTest{});
  for (const double value : {t.difference, t.low, t.high, t.t, t.df, t.p, p.corrected, t.effect, t.effect_low, t.effect_high})
    add_number(table, is ? value : kNone);
  add_number(table, p.flips ? p.flips->p : kNone);
  table.add(!p.flips ? "" : p.flips->exact ? "1" : "0");
  table.add(numbers_text(p.left_out)).add(csv_words(p.why_not));
}

}  // namespace

std::string subjects_csv(const Study& study, const Analysis& analysis) {
  CsvTable table("subject,task,condition,trials,kept,error_mean_mm,time_mean_s,error_sd_mm,time_sd_s,slope");
  for (std::size_t s = 0; s < analysis.subjects.size(); ++s)
    for (int t = 0; t < static_cast<int>(analysis.tasks_count); ++t)
      for (int c = 0; c < static_cast<int>(analysis.conditions_count); ++c) {
        const Cell& cell = analysis.cell(s, {t, c});
        table.add(analysis.subjects[s]);
        add_place(table, study, {t, c});
        table.add(cell.trials).add(cell.kept);
        for (const double value : cell.values) add_number(table, value);
        table.end_row();
      }
  return table.text();
}

std::string means_csv(const Study& study, const Analysis& analysis) {
  CsvTable table("measure,task,condition,n,mean,sd,low,high,overlaps_baseline");
  for (const Mean& m : analysis.means) {
    table.add(quantity_word(m.quantity));
    add_place(table, study, m.place);
    const statistics::Summary s = m.of.value_or(statistics::Summary{});
    table.add(s.n);
    for (const double value : {s.mean, s.sd, s.low(), s.high()}) add_number(table, m.of ? value : kNone);
    table.add(!m.overlaps ? "" : *m.overlaps ? "1" : "0");
    table.end_row();
  }
  return table.text();
}

std::string tests_csv(const Study& study, const Analysis& analysis) {
  CsvTable table(std::string("family,measure,first_task,first_condition,second_task,second_condition,") + kTestColumns);
  for (const auto& [family, tests] : {std::pair{"conditions", &analysis.conditions}, {"tasks", &analysis.tasks}})
    for (const Paired& p : *tests) {
      table.add(family).add(quantity_word(p.quantity));
      add_place(table, study, p.first);
      add_place(table, study, p.second);
      add_test(table, p);
      table.end_row();
    }
  return table.text();
}

std::string slopes_csv(const Study& study, const Analysis& analysis) {
  CsvTable table(std::string("task,baseline,condition,") + kTestColumns);
  for (const Paired& p : analysis.trade) {
    add_place(table, study, p.first);
    table.add(study.conditions[static_cast<std::size_t>(p.second.condition)].name);
    add_test(table, p);
    table.end_row();
  }
  return table.text();
}

std::string correlations_csv(const Study& study, const Analysis& analysis) {
  CsvTable table("task,condition,n,r,low,high,t,df,p,p_holm,left_out,change_z,change_p,change_p_holm,why_not");
  for (const Correlated& x : analysis.correlations) {
    add_place(table, study, x.place);
    const statistics::Correlation c = x.of.value_or(statistics::Correlation{});
    table.add(c.n);
    for (const double value : {c.r, c.low, c.high, c.t, c.df, c.p, x.corrected}) add_number(table, x.of ? value : kNone);
    table.add(numbers_text(x.left_out));
    const Change* change = nullptr;
    for (const Change& other : analysis.changes)
      if (other.place == x.place) change = &other;
    const bool has = change != nullptr && change->of;
    for (const double value : {has ? change->of->z : kNone, has ? change->of->p : kNone, has ? change->corrected : kNone})
      add_number(table, value);
    table.add(csv_words(x.why_not));
    table.end_row();
  }
  return table.text();
}

std::string rejections_csv(const Study& study, const Analysis& analysis) {
  CsvTable table("task,condition,trials,rejected,by_error,by_time,by_both,unfinished");
  for (int t = 0; t < static_cast<int>(analysis.tasks_count); ++t)
    for (int c = 0; c < static_cast<int>(analysis.conditions_count); ++c) {
      const Rejections& r = analysis.rejected({t, c});
      add_place(table, study, {t, c});
      table.add(r.trials).add(r.rejected()).add(r.error).add(r.time).add(r.both).add(r.unfinished);
      table.end_row();
    }
  return table.text();
}

std::string findings_csv(const study::Inquiry& inquiry, const Analysis& analysis) {
  CsvTable table("verdict,test,paper,reported,numbers");
  for (std::size_t i = 0; i < inquiry.findings.size(); ++i) {
    const study::Finding& f = inquiry.findings[i];
    table.add(verdict_word(analysis.findings[i].verdict)).add(study::asks_word(f.asks));
    table.add(csv_words(f.paper)).add(csv_words(f.reported)).add(csv_words(analysis.findings[i].text()));
    table.end_row();
  }
  return table.text();
}

}  // namespace catena::app::analysis
