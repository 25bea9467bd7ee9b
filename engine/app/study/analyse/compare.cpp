#include <fmt/format.h>

#include <cmath>

#include "engine/app/study/analyse/analysis.h"

namespace catena::app::analysis {
namespace {

/// Corrects the p-values of those that have one.
template <class Item, class P>
void correct_family(std::vector<Item>& family, const P& p_of) {
  std::vector<double> p;
  for (const Item& item : family)
    if (const std::optional<double> one = p_of(item)) p.push_back(*one);
  const std::vector<double> corrected = statistics::holm(p);
  std::size_t k = 0;
  for (Item& item : family)
    if (p_of(item)) item.corrected = corrected[k++];
}

template <class Item>
std::optional<double> p_of_result(const Item& item) {
  return item.of ? std::optional(item.of->p) : std::nullopt;
}

/// Fills `of` or `why_not`.
template <class Item, class T>
void keep_result(Item& item, Result<T>&& result) {
  if (result)
    item.of = *result;
  else
    item.why_not = result.error().message;
}

/// Mean errors and times of the subjects that have all of them in the places, one after the other: error, time, error, time ...
std::vector<std::vector<double>> measures(const Analysis& analysis, const std::vector<Place>& places, std::vector<int>* left_out) {
  std::vector<std::vector<double>> columns(2 * places.size());
  for (std::size_t s = 0; s < analysis.subjects.size(); ++s) {
    std::vector<double> row;
    for (const Place& p : places)
      for (const Quantity q : {Quantity::error, Quantity::time}) row.push_back(analysis.value(s, p, q));
    bool whole = true;
    for (const double v : row) whole = whole && std::isfinite(v);
    if (!whole) {
      if (left_out != nullptr) left_out->push_back(analysis.subjects[s]);
      continue;
    }
    for (std::size_t i = 0; i < row.size(); ++i) columns[i].push_back(row[i]);
  }
  return columns;
}

void add_means(Analysis& analysis, int task, Quantity q) {
  const std::size_t baseline = analysis.means.size();
  for (int c = 0; c < static_cast<int>(analysis.conditions_count); ++c) {
    Mean mean{q, {task, c}, {}, {}, {}};
    std::vector<double> values;
    for (std::size_t s = 0; s < analysis.subjects.size(); ++s)
      if (const double v = analysis.value(s, mean.place, q); std::isfinite(v)) values.push_back(v);
    keep_result(mean, statistics::summarise(values, kConfidence));
    if (c > 0 && mean.of && analysis.means[baseline].of)
      mean.overlaps = mean.of->low() <= analysis.means[baseline].of->high() && analysis.means[baseline].of->low() <= mean.of->high();
    analysis.means.push_back(std::move(mean));
  }
}

}  // namespace

Paired paired_over(const Analysis& analysis, Quantity quantity, const Place& first, const Place& second) {
  Paired paired{quantity, first, second, {}, {}, {}, {}, {}, kNone, {}};
  std::vector<double> a, b, differences;
  for (std::size_t s = 0; s < analysis.subjects.size(); ++s) {
    const double x = analysis.value(s, first, quantity), y = analysis.value(s, second, quantity);
    if (!std::isfinite(x) || !std::isfinite(y)) {
      paired.left_out.push_back(analysis.subjects[s]);
      continue;
    }
    a.push_back(x);
    b.push_back(y);
    differences.push_back(x - y);
  }
  if (const auto summary = statistics::summarise(a, kConfidence)) paired.of_first = *summary;
  if (const auto summary = statistics::summarise(b, kConfidence)) paired.of_second = *summary;
  auto test = statistics::paired_test(a, b, kConfidence);
  if (!test) {
    paired.why_not = test.error().message;
    return paired;
  }
  paired.test = *test;
  if (const auto flips = statistics::sign_flip_test(differences)) paired.flips = *flips;
  return paired;
}

void correct(std::vector<Paired>& family) {
  correct_family(family, [](const Paired& p) { return p.test ? std::optional(p.test->p) : std::nullopt; });
}

void compare(const Study& study, const study::Inquiry& inquiry, Analysis& analysis) {
  const int tasks = static_cast<int>(study.tasks.size()), conditions = static_cast<int>(study.conditions.size());
  for (int t = 0; t < tasks; ++t) {
    for (const Quantity q : {Quantity::error, Quantity::time, Quantity::slope}) add_means(analysis, t, q);
    for (int c = 1; c < conditions; ++c)
      for (const Quantity q : {Quantity::error, Quantity::time, Quantity::error_deviation, Quantity::time_deviation, Quantity::slope})
        (q == Quantity::slope ? analysis.trade : analysis.conditions).push_back(paired_over(analysis, q, {t, 0}, {t, c}));
    for (int c = 0; c < conditions; ++c) {
      Correlated correlated{{t, c}, {}, {}, kNone, {}};
      const auto columns = measures(analysis, {correlated.place}, &correlated.left_out);
      keep_result(correlated, statistics::pearson(columns[0], columns[1], kConfidence));
      analysis.correlations.push_back(std::move(correlated));
      if (c == 0) continue;
      Change change{{t, c}, {}, kNone, {}};
      const auto both = measures(analysis, {{t, 0}, {t, c}}, nullptr);
      keep_result(change, statistics::compare_correlations(both[0], both[1], both[2], both[3]));
      analysis.changes.push_back(std::move(change));
    }
  }
  for (const auto& [first, second] : inquiry.pairs)
    for (int c = 0; c < conditions; ++c)
      for (const Quantity q : {Quantity::error, Quantity::time})
        analysis.tasks.push_back(paired_over(analysis, q, {first, c}, {second, c}));
  correct(analysis.conditions);
  correct(analysis.tasks);
  correct(analysis.trade);
  correct_family(analysis.correlations, p_of_result<Correlated>);
  correct_family(analysis.changes, p_of_result<Change>);
}

}  // namespace catena::app::analysis
