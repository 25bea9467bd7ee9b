// SPDX-License-Identifier: MIT
/// Tests each finding of the study file against the data. A finding over several tasks or conditions is supported where all of
/// them support it; the numbers of each are given.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "engine/app/study/analyse/analysis.h"
#include "engine/study/statistics/distributions.h"

namespace catena::app::analysis {
namespace {

using study::Alternative;
using study::Finding;
using study::TestKind;

// Overlapping intervals are inconclusive without enough power. Large difference: J. Cohen, Statistical Power Analysis for the Behavioral
// Sciences, 1988.
constexpr double kLargeDifference = 0.8, kMinPower = 0.8;

/// Collects the results of the parts of a finding.
struct Parts {
  int all = 0, borne_out = 0, untested = 0;
  std::vector<std::string> numbers;
  std::vector<bool> bears;

  void add(std::optional<bool> says, const std::string& text) {
    ++all;
    untested += !says;
    borne_out += says.value_or(false);
    numbers.push_back(text);
    bears.push_back(says.value_or(false));
  }
  FindingResult judged() const {
    if (all == 0) return {Verdict::not_testable, {}, {"there are no data to compare"}};
    if (untested > 0) return {Verdict::not_testable, {}, numbers};
    if (all == 1) return {borne_out == 1 ? Verdict::supported : Verdict::not_supported, {}, numbers};
    std::vector<std::string> marked = numbers;
    for (std::size_t i = 0; i < marked.size(); ++i) marked[i] = (bears[i] ? "yes: " : "no: ") + marked[i];
    return {borne_out == all ? Verdict::supported : Verdict::not_supported, fmt::format("{} of {}", borne_out, all), marked};
  }
};

template <class Items, class Same>
const typename Items::value_type* find_item(const Items& items, const Same& same) {
  const auto at = std::find_if(items.begin(), items.end(), same);
  return at == items.end() ? nullptr : &*at;
}

Quantity quantity_of(const Finding& f) {
  const bool time = f.measure == study::Measure::time;
  return f.uses_deviations ? (time ? Quantity::time_deviation : Quantity::error_deviation) : (time ? Quantity::time : Quantity::error);
}

/// Returns whether the difference is significant with the first mean on the expected side of the second; std::nullopt if untested.
std::optional<bool> first_is(const PairedComparison& paired, Alternative expect) {
  if (!paired.test) return std::nullopt;
  return paired.corrected_p < kAlpha && (expect == Alternative::lower) == (paired.test->difference < 0);
}

/// Power of a paired t-test of `n` subjects for a large difference: P(|T| > t), T noncentral with delta = d sqrt(n).
double power_of(double n) {
  if (n < 2) return 0;
  const double df = n - 1, delta = kLargeDifference * std::sqrt(n), t = statistics::t_quantile(1 - 0.5 * kAlpha, df);
  return statistics::noncentral_t_survival(t, df, delta) + statistics::noncentral_t_cdf(-t, df, delta);
}

/// Returns whether the second correlation is significant with the opposite sign of the first: such a correlation is not a weaker one.
bool is_reversed(const statistics::CorrelationDifference& x) {
  const double df = x.n - 2, t = x.second * std::sqrt(df / (1 - x.second * x.second));
  return x.first * x.second < 0 && statistics::two_sided_p(t, df) < kAlpha;
}

struct Judge {
  const Study& study;
  const Analysis& analysis;

  const std::string& task_name(int task) const { return study.tasks[static_cast<std::size_t>(task)].name; }

  FindingResult difference(const Finding& f) const {
    Parts parts;
    for (const int t : f.tasks)
      for (const int c : f.conditions) {
        const PairedComparison* p = find_item(analysis.condition_comparisons, [&](const PairedComparison& x) {
          return x.quantity == quantity_of(f) && x.second == TaskCondition{t, c};
        });
        // the baseline comes first in the pair: "condition lower" means "baseline higher"
        parts.add(first_is(*p, f.alternative == Alternative::lower ? Alternative::higher : Alternative::lower),
                  task_name(t) + ": " + comparison_text(study, *p));
      }
    return parts.judged();
  }

  FindingResult intervals(const Finding& f) const {
    Parts parts;
    const auto mean_of = [&](const TaskCondition& place) {
      return find_item(analysis.means, [&](const ConditionMean& x) { return x.quantity == quantity_of(f) && x.task_condition == place; });
    };
    const auto words = [&](const TaskCondition& place) {
      const ConditionMean& m = *mean_of(place);
      const std::string& name = study.conditions[static_cast<std::size_t>(place.condition)].name;
      return m.result ? fmt::format("{} {:.3g} to {:.3g} {}", name, m.result->low(), m.result->high(), quantity_unit(m.quantity))
                      : name + ": " + m.skip_reason;
    };
    for (const int t : f.tasks)
      for (const int c : f.conditions) {
        const ConditionMean& m = *mean_of({t, c});
        const std::string text = fmt::format("{}: {}, {}", task_name(t), words({t, 0}), words({t, c}));
        const double power = m.result ? power_of(static_cast<double>(m.result->n)) : 0;
        if (!m.overlaps_baseline)
          parts.add(std::nullopt, text);
        else if (*m.overlaps_baseline && power < kMinPower)
          parts.add(std::nullopt,
                    fmt::format("{} (overlap; but with {} subjects, the power to find a difference of {} standard deviations is only "
                                "{:.2f}; {} was expected)",
                                text, m.result->n, kLargeDifference, power, kMinPower));
        else
          parts.add(*m.overlaps_baseline == (f.alternative == Alternative::overlap),
                    text + (*m.overlaps_baseline ? " (overlap)" : " (no overlap)"));
      }
    return parts.judged();
  }

  FindingResult tasks(const Finding& f) const {
    Parts parts;
    for (const int c : f.conditions) {
      const PairedComparison* p = find_item(analysis.task_comparisons, [&](const PairedComparison& x) {
        return x.quantity == quantity_of(f) && x.first == TaskCondition{f.tasks[0], c} && x.second == TaskCondition{f.tasks[1], c};
      });
      parts.add(first_is(*p, f.alternative), study.conditions[static_cast<std::size_t>(c)].name + ": " + comparison_text(study, *p));
    }
    return parts.judged();
  }

  /// Evaluates the item of `items` at each task/condition pair of the finding: whether it supports the finding, and its numbers.
  template <class Item, class Holds, class Words>
  FindingResult at_places(const Finding& f, const std::vector<Item>& items, const Holds& holds, const Words& words) const {
    Parts parts;
    for (const int t : f.tasks)
      for (const int c : f.conditions) {
        const Item& x = *find_item(items, [&](const Item& y) { return y.task_condition == TaskCondition{t, c}; });
        const std::string at = task_condition_label(study, x.task_condition) + ": ";
        if (x.result)
          parts.add(x.corrected_p < kAlpha && holds(*x.result), at + words(*x.result) + ", " + format_p_values(x.result->p, x.corrected_p));
        else
          parts.add(std::nullopt, at + x.skip_reason);
      }
    return parts.judged();
  }

  FindingResult correlation(const Finding& f) const {
    return at_places(
        f, analysis.correlations, [&](const statistics::Correlation& x) { return (x.r < 0) == (f.alternative == Alternative::negative); },
        [](const statistics::Correlation& x) { return fmt::format("r = {:.3f} ({:.2f} to {:.2f})", x.r, x.low, x.high); });
  }

  FindingResult weaker(const Finding& f) const {
    using Difference = statistics::CorrelationDifference;
    return at_places(
        f, analysis.correlation_changes, [](const Difference& x) { return std::fabs(x.second) < std::fabs(x.first) && !is_reversed(x); },
        [](const Difference& x) { return fmt::format("r = {:.3f}, baseline {:.3f}, z = {:.2f}", x.second, x.first, x.z); });
  }

  /// Compares the gains of a task with those of every other one, paired over the subjects; a test family of its own.
  FindingResult largest(const Finding& f) const {
    Parts parts;
    const Quantity q = quantity_of(f);
    for (const int c : f.conditions) {
      std::vector<Result<statistics::PairedTest>> tests;
      std::vector<int> others;
      std::vector<double> p;
      for (int other = 0; other < static_cast<int>(study.tasks.size()); ++other) {
        if (other == f.tasks[0]) continue;
        std::vector<double> mine, theirs;
        for (std::size_t s = 0; s < analysis.subjects.size(); ++s) {
          const double a = analysis.value(s, {f.tasks[0], 0}, q) - analysis.value(s, {f.tasks[0], c}, q);
          const double b = analysis.value(s, {other, 0}, q) - analysis.value(s, {other, c}, q);
          if (std::isfinite(a) && std::isfinite(b)) mine.push_back(a), theirs.push_back(b);
        }
        others.push_back(other);
        tests.push_back(statistics::paired_test(mine, theirs, kConfidence));
        if (tests.back()) p.push_back(tests.back()->p);
      }
      const std::vector<double> corrected = statistics::holm_correction(p);
      for (std::size_t i = 0, k = 0; i < tests.size(); ++i) {
        const std::string name = "gain minus the gain of " + task_name(others[i]) + ": ";
        if (!tests[i]) {
          parts.add(std::nullopt, name + tests[i].error().message);
          continue;
        }
        const statistics::PairedTest& t = *tests[i];
        parts.add(corrected[k] < kAlpha && t.difference > 0,
                  fmt::format("{}{:.3g} {} ({:.3g} to {:.3g}), {}", name, t.difference, quantity_unit(q), t.low, t.high,
                              format_p_values(t.p, corrected[k])));
        ++k;
      }
    }
    return parts.judged();
  }

  FindingResult rejections(const Finding& f) const {
    const Rejections all = analysis.total_rejections();
    if (all.trials == 0) return {Verdict::not_testable, {}, {"there are no trials"}};
    const statistics::Interval share = statistics::proportion_interval(all.total(), all.trials, kConfidence);
    const double theirs = static_cast<double>(f.rejected) / f.trials;
    return {share.contains(theirs) ? Verdict::supported : Verdict::not_supported,
            {},
            {fmt::format("{} of {} were rejected, {:.1f} % ({:.1f} to {:.1f}); reported: {:.1f} %", all.total(), all.trials,
                         100.0 * all.total() / all.trials, 100 * share.low, 100 * share.high, 100 * theirs)}};
  }

  FindingResult of(const Finding& f) const {
    switch (f.test) {
      case TestKind::difference:
        return difference(f);
      case TestKind::intervals:
        return intervals(f);
      case TestKind::tasks:
        return tasks(f);
      case TestKind::correlation:
        return correlation(f);
      case TestKind::weaker_correlation:
        return weaker(f);
      case TestKind::largest:
        return largest(f);
      case TestKind::rejections:
        return rejections(f);
      case TestKind::untestable:
        break;
    }
    return {Verdict::not_testable, {}, {f.reason}};
  }
};

}  // namespace

void evaluate_findings(const Study& study, const study::AnalysisPlan& inquiry, Analysis& analysis) {
  const Judge judge{study, analysis};
  for (const Finding& finding : inquiry.findings) analysis.findings.push_back(judge.of(finding));
}

}  // namespace catena::app::analysis
