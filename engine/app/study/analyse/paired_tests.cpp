// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <cmath>

#include "engine/app/study/analyse/analysis.h"

namespace catena::app::analysis {
namespace {

/// Corrects the p-values of the items that have one.
template <class Item, class P>
void correct_family(std::vector<Item>& family, const P& p_of) {
  std::vector<double> p;
  for (const Item& item : family)
    if (const std::optional<double> one = p_of(item)) p.push_back(*one);
  const std::vector<double> corrected = statistics::holm_correction(p);
  std::size_t k = 0;
  for (Item& item : family)
    if (p_of(item)) item.corrected_p = corrected[k++];
}

template <class Item>
std::optional<double> p_of_result(const Item& item) {
  return item.result ? std::optional(item.result->p) : std::nullopt;
}

/// Sets `result` or `skip_reason`.
template <class Item, class T>
void keep_result(Item& item, Result<T>&& result) {
  if (result)
    item.result = *result;
  else
    item.skip_reason = result.error().message;
}

/// Returns the mean errors and times of the subjects with data in all task/condition pairs, as columns: error, time, error, time ...
std::vector<std::vector<double>> measures(const Analysis& analysis, const std::vector<TaskCondition>& places, std::vector<int>* left_out) {
  std::vector<std::vector<double>> columns(2 * places.size());
  for (std::size_t s = 0; s < analysis.subjects.size(); ++s) {
    std::vector<double> row;
    for (const TaskCondition& p : places)
      for (const Quantity q : {Quantity::error, Quantity::time}) row.push_back(analysis.value(s, p, q));
    bool is_complete = true;
    for (const double v : row) is_complete = is_complete && std::isfinite(v);
    if (!is_complete) {
      if (left_out != nullptr) left_out->push_back(analysis.subjects[s]);
      continue;
    }
    for (std::size_t i = 0; i < row.size(); ++i) columns[i].push_back(row[i]);
  }
  return columns;
}

void add_means(Analysis& analysis, int task, Quantity q) {
  const std::size_t baseline = analysis.means.size();
  for (int c = 0; c < static_cast<int>(analysis.condition_count); ++c) {
    ConditionMean mean{q, {task, c}, {}, {}, {}};
    std::vector<double> values;
    for (std::size_t s = 0; s < analysis.subjects.size(); ++s)
      if (const double v = analysis.value(s, mean.task_condition, q); std::isfinite(v)) values.push_back(v);
    keep_result(mean, statistics::summarize(values, kConfidence));
    if (c > 0 && mean.result && analysis.means[baseline].result)
      mean.overlaps_baseline =
          mean.result->low() <= analysis.means[baseline].result->high() && analysis.means[baseline].result->low() <= mean.result->high();
    analysis.means.push_back(std::move(mean));
  }
}

}  // namespace

PairedComparison compare_paired(const Analysis& analysis, Quantity quantity, const TaskCondition& first, const TaskCondition& second) {
  PairedComparison paired{quantity, first, second, {}, {}, {}, {}, {}, kNotComputed, {}};
  std::vector<double> a, b, differences;
  for (std::size_t s = 0; s < analysis.subjects.size(); ++s) {
    const double x = analysis.value(s, first, quantity), y = analysis.value(s, second, quantity);
    if (!std::isfinite(x) || !std::isfinite(y)) {
      paired.excluded_subjects.push_back(analysis.subjects[s]);
      continue;
    }
    a.push_back(x);
    b.push_back(y);
    differences.push_back(x - y);
  }
  if (const auto summary = statistics::summarize(a, kConfidence)) paired.first_summary = *summary;
  if (const auto summary = statistics::summarize(b, kConfidence)) paired.second_summary = *summary;
  auto test = statistics::paired_test(a, b, kConfidence);
  if (!test) {
    paired.skip_reason = test.error().message;
    return paired;
  }
  paired.test = *test;
  if (const auto flips = statistics::sign_flip_test(differences)) paired.sign_flip_test = *flips;
  return paired;
}

void apply_holm_correction(std::vector<PairedComparison>& family) {
  correct_family(family, [](const PairedComparison& p) { return p.test ? std::optional(p.test->p) : std::nullopt; });
}

void run_paired_tests(const Study& study, const study::AnalysisPlan& inquiry, Analysis& analysis) {
  const int tasks = static_cast<int>(study.tasks.size()), conditions = static_cast<int>(study.conditions.size());
  for (int t = 0; t < tasks; ++t) {
    for (const Quantity q : {Quantity::error, Quantity::time, Quantity::slope}) add_means(analysis, t, q);
    for (int c = 1; c < conditions; ++c)
      for (const Quantity q : {Quantity::error, Quantity::time, Quantity::error_deviation, Quantity::time_deviation, Quantity::slope})
        (q == Quantity::slope ? analysis.tradeoff_comparisons : analysis.condition_comparisons)
            .push_back(compare_paired(analysis, q, {t, 0}, {t, c}));
    for (int c = 0; c < conditions; ++c) {
      ConditionCorrelation correlated{{t, c}, {}, {}, kNotComputed, {}};
      const auto columns = measures(analysis, {correlated.task_condition}, &correlated.excluded_subjects);
      keep_result(correlated, statistics::pearson(columns[0], columns[1], kConfidence));
      analysis.correlations.push_back(std::move(correlated));
      if (c == 0) continue;
      CorrelationChange change{{t, c}, {}, kNotComputed, {}};
      const auto both = measures(analysis, {{t, 0}, {t, c}}, nullptr);
      keep_result(change, statistics::compare_correlations(both[0], both[1], both[2], both[3]));
      analysis.correlation_changes.push_back(std::move(change));
    }
  }
  for (const auto& [first, second] : inquiry.pairs)
    for (int c = 0; c < conditions; ++c)
      for (const Quantity q : {Quantity::error, Quantity::time})
        analysis.task_comparisons.push_back(compare_paired(analysis, q, {first, c}, {second, c}));
  apply_holm_correction(analysis.condition_comparisons);
  apply_holm_correction(analysis.task_comparisons);
  apply_holm_correction(analysis.tradeoff_comparisons);
  correct_family(analysis.correlations, p_of_result<ConditionCorrelation>);
  correct_family(analysis.correlation_changes, p_of_result<CorrelationChange>);
}

}  // namespace catena::app::analysis
