// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "engine/app/study/analyse/analysis.h"
#include "engine/base/memory_limit.h"
#include "engine/base/text.h"

namespace catena::app::analysis {
namespace {

template <class Items>
std::vector<std::string_view> names_of_all(const Items& items) {
  std::vector<std::string_view> names;
  for (const auto& item : items) names.push_back(item.name);
  return names;
}

struct Reading {
  const Study& study;
  std::string where;
  std::vector<std::string_view> tasks = names_of_all(study.tasks), conditions = names_of_all(study.conditions);

  Error error(const study::TrialRow& row, const std::string& what) const {
    return Error{one_line(fmt::format("{}: subject {}, trial {}: {}", where, row.subject, row.index, what))};
  }
  Result<int> index(const study::TrialRow& row, const char* what, const std::string& name,
                    const std::vector<std::string_view>& names) const {
    const auto at = std::find(names.begin(), names.end(), name);
    if (at != names.end()) return static_cast<int>(at - names.begin());
    return error(row, fmt::format("the study has no {} {}{}; {} was expected", what, in_quotes(name), suggestion(name, names),
                                  join_alternatives(names)));
  }
  Result<TaskCondition> place(const study::TrialRow& row) const {
    TaskCondition p;
    CATENA_TRY(p.task, index(row, "task", row.task, tasks));
    CATENA_TRY(p.condition, index(row, "condition", row.condition, conditions));
    const study::Task& task = study.tasks[static_cast<std::size_t>(p.task)];
    if (row.kind != study::to_string(task.kind) || row.dimensions != task.dimensions)
      return error(row, fmt::format("the kind is {} in {}D; {} in {}D was expected for the task {}", in_quotes(row.kind), row.dimensions,
                                    study::to_string(task.kind), task.dimensions, in_quotes(task.name)));
    if (!(row.error_mm >= 0 && row.time_s >= 0)) return error(row, "the error or time is negative; numbers of at least 0 were expected");
    return p;
  }
};

/// Returns whether the trial is accepted, and counts the reason if it is not.
bool keep(const study::TrialRow& row, const study::Limits& limits, Rejections& counts) {
  ++counts.trials;
  const bool error = row.error_mm > limits.reject_error_mm, time = row.time_s > limits.reject_time_s;
  if (!row.reached_target)
    ++counts.unfinished;
  else if (error && time)
    ++counts.both;
  else if (error)
    ++counts.error;
  else if (time)
    ++counts.time;
  else
    return true;
  return false;
}

/// Errors and times of the accepted trials of one task/condition pair.
struct Kept {
  std::vector<double> errors, times;
};

void fill(const Kept& kept, Cell& cell) {
  const auto set = [&](Quantity q, double value) { cell.values[static_cast<std::size_t>(q)] = value; };
  cell.accepted = static_cast<int>(kept.errors.size());
  if (cell.accepted == 1) {
    set(Quantity::error, kept.errors[0]);
    set(Quantity::time, kept.times[0]);
  }
  if (const auto s = statistics::summarize(kept.errors)) set(Quantity::error, s->mean), set(Quantity::error_deviation, s->sd);
  if (const auto s = statistics::summarize(kept.times)) set(Quantity::time, s->mean), set(Quantity::time_deviation, s->sd);
  std::vector<double> x, y;
  for (std::size_t i = 0; i < kept.errors.size(); ++i) {
    if (!(kept.errors[i] > 0 && kept.times[i] > 0)) continue;  // the logarithm is undefined
    x.push_back(std::log(kept.times[i]));
    y.push_back(std::log(kept.errors[i]));
  }
  if (x.size() < 3) return;
  if (const auto line = statistics::regression(x, y)) set(Quantity::slope, line->slope);
}

}  // namespace

Rejections Analysis::total_rejections() const {
  Rejections sum;
  for (const Rejections& r : rejections) {
    sum.trials += r.trials;
    sum.error += r.error;
    sum.time += r.time;
    sum.both += r.both;
    sum.unfinished += r.unfinished;
  }
  return sum;
}

Outcome compute_descriptive_stats(const Study& study, const std::vector<study::TrialRow>& rows, const std::string& where,
                                  Analysis& analysis) {
  const Reading reading{study, where};
  analysis.task_count = study.tasks.size();
  analysis.condition_count = study.conditions.size();
  std::set<std::pair<int, int>> seen;
  for (const study::TrialRow& row : rows) {
    if (!seen.emplace(row.subject, row.index).second) return reading.error(row, "the trial is repeated; each trial was expected once");
    if (analysis.subjects.empty() || analysis.subjects.back() != row.subject) analysis.subjects.push_back(row.subject);
  }
  std::sort(analysis.subjects.begin(), analysis.subjects.end());
  analysis.subjects.erase(std::unique(analysis.subjects.begin(), analysis.subjects.end()), analysis.subjects.end());

  const std::size_t places = analysis.task_count * analysis.condition_count;
  const std::size_t count = analysis.subjects.size() * places;
  CATENA_CHECK(check_text_memory_available(
      one_line(fmt::format("{}: {} subjects in {} tasks and conditions", where, analysis.subjects.size(), places)),
      static_cast<double>(count) * (sizeof(Cell) + sizeof(Kept))));
  analysis.cells.resize(count);
  analysis.rejections.resize(places);
  std::vector<Kept> kept(analysis.cells.size());
  for (const study::TrialRow& row : rows) {
    CATENA_TRY(const TaskCondition p, reading.place(row));
    ++analysis.row_count;
    if (row.training) {
      ++analysis.training_count;
      continue;
    }
    const auto subject = std::lower_bound(analysis.subjects.begin(), analysis.subjects.end(), row.subject) - analysis.subjects.begin();
    const std::size_t place = static_cast<std::size_t>(p.task) * analysis.condition_count + static_cast<std::size_t>(p.condition);
    const std::size_t cell = static_cast<std::size_t>(subject) * places + place;
    ++analysis.cells[cell].trials;
    if (!keep(row, study.tasks[static_cast<std::size_t>(p.task)].limits, analysis.rejections[place])) continue;
    kept[cell].errors.push_back(row.error_mm);
    kept[cell].times.push_back(row.time_s);
  }
  for (std::size_t i = 0; i < kept.size(); ++i) {
    fill(kept[i], analysis.cells[i]);
    if (analysis.cells[i].accepted > 0) continue;
    const std::size_t place = i % places;
    analysis.missing_data.push_back(fmt::format("subject {}: no accepted trial of {} ({} done)", analysis.subjects[i / places],
                                                task_condition_label(study, {static_cast<int>(place / analysis.condition_count),
                                                                             static_cast<int>(place % analysis.condition_count)}),
                                                analysis.cells[i].trials));
  }
  return Done{};
}

Result<Analysis> analyze(const Study& study, const study::AnalysisPlan& inquiry, const std::vector<study::TrialRow>& rows,
                         const std::string& where) {
  Analysis analysis;
  CATENA_CHECK(compute_descriptive_stats(study, rows, where, analysis));
  run_paired_tests(study, inquiry, analysis);
  evaluate_findings(study, inquiry, analysis);
  return analysis;
}

}  // namespace catena::app::analysis
