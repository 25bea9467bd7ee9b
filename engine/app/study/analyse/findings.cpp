/// Each finding of the study file, held against what these data say. A finding over several tasks or conditions is supported where all of
/// them support it; the numbers of each are given.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "engine/app/study/analyse/analysis.h"
#include "engine/statistics/distributions.h"

namespace catena::app::analysis {
namespace {

using study::Asks;
using study::Expect;
using study::Finding;

// Intervals that overlap say nothing where they had to. Large: J. Cohen, Statistical Power Analysis for the Behavioral Sciences, 1988.
constexpr double kLargeDifference = 0.8, kLeastPower = 0.8;

/// What the parts of a finding say, gathered.
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
  Judged judged() const {
    if (all == 0) return {Verdict::not_testable, {}, {"there is nothing to compare"}};
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
  return f.of_deviations ? (time ? Quantity::time_deviation : Quantity::error_deviation) : (time ? Quantity::time : Quantity::error);
}

/// Significant, and the first mean on that side of the second.
std::optional<bool> first_is(const Paired& paired, Expect expect) {
  if (!paired.test) return std::nullopt;
  return paired.corrected < kAlpha && (expect == Expect::lower) == (paired.test->difference < 0);
}

/// The power of a paired t-test of `n` subjects for a large difference: P(|T| > t), T noncentral with delta = d sqrt(n).
double power_of(double n) {
  if (n < 2) return 0;
  const double df = n - 1, delta = kLargeDifference * std::sqrt(n), t = statistics::t_quantile(1 - 0.5 * kAlpha, df);
  return statistics::noncentral_t_above(t, df, delta) + statistics::noncentral_t_below(-t, df, delta);
}

/// A correlation that is another's opposite is no weaker one.
bool is_reversed(const statistics::CorrelationDifference& x) {
  const double df = x.n - 2, t = x.second * std::sqrt(df / (1 - x.second * x.second));
  return x.first * x.second < 0 && statistics::two_sided_p(t, df) < kAlpha;
}

struct Judge {
  const Study& study;
  const Analysis& analysis;

  const std::string& task_name(int task) const { return study.tasks[static_cast<std::size_t>(task)].name; }

  Judged difference(const Finding& f) const {
    Parts parts;
    for (const int t : f.tasks)
      for (const int c : f.conditions) {
        const Paired* p = find_item(analysis.conditions, [&](const Paired& x) {
          return x.quantity == quantity_of(f) && x.second == Place{t, c};
        });
        // the condition lower: the baseline, which is first, higher
        parts.add(first_is(*p, f.expect == Expect::lower ? Expect::higher : Expect::lower), task_name(t) + ": " + paired_text(study, *p));
      }
    return parts.judged();
  }

  Judged intervals(const Finding& f) const {
    Parts parts;
    const auto mean_of = [&](const Place& place) {
      return find_item(analysis.means, [&](const Mean& x) { return x.quantity == quantity_of(f) && x.place == place; });
    };
    const auto words = [&](const Place& place) {
      const Mean& m = *mean_of(place);
      const std::string& name = study.conditions[static_cast<std::size_t>(place.condition)].name;
      return m.of ? fmt::format("{} {:.3g} to {:.3g} {}", name, m.of->low(), m.of->high(), unit_of(m.quantity)) : name + ": " + m.why_not;
    };
    for (const int t : f.tasks)
      for (const int c : f.conditions) {
        const Mean& m = *mean_of({t, c});
        const std::string text = fmt::format("{}: {}, {}", task_name(t), words({t, 0}), words({t, c}));
        const double power = m.of ? power_of(static_cast<double>(m.of->n)) : 0;
        if (!m.overlaps)
          parts.add(std::nullopt, text);
        else if (*m.overlaps && power < kLeastPower)
          parts.add(std::nullopt,
                    fmt::format("{} (overlap, but of {} subjects a difference of {} standard deviations is seen with a power of "
                                "{:.2f} only; {} was expected)",
                                text, m.of->n, kLargeDifference, power, kLeastPower));
        else
          parts.add(*m.overlaps == (f.expect == Expect::overlap), text + (*m.overlaps ? " (overlap)" : " (apart)"));
      }
    return parts.judged();
  }

  Judged tasks(const Finding& f) const {
    Parts parts;
    for (const int c : f.conditions) {
      const Paired* p = find_item(analysis.tasks, [&](const Paired& x) {
        return x.quantity == quantity_of(f) && x.first == Place{f.tasks[0], c} && x.second == Place{f.tasks[1], c};
      });
      parts.add(first_is(*p, f.expect), study.conditions[static_cast<std::size_t>(c)].name + ": " + paired_text(study, *p));
    }
    return parts.judged();
  }

  /// Of each place the one of `items` there: whether it bears the finding out, and what it says.
  template <class Item, class Holds, class Words>
  Judged at_places(const Finding& f, const std::vector<Item>& items, const Holds& holds, const Words& words) const {
    Parts parts;
    for (const int t : f.tasks)
      for (const int c : f.conditions) {
        const Item& x = *find_item(items, [&](const Item& y) { return y.place == Place{t, c}; });
        const std::string at = place_text(study, x.place) + ": ";
        if (x.of)
          parts.add(x.corrected < kAlpha && holds(*x.of), at + words(*x.of) + ", " + p_words(x.of->p, x.corrected));
        else
          parts.add(std::nullopt, at + x.why_not);
      }
    return parts.judged();
  }

  Judged correlation(const Finding& f) const {
    return at_places(
        f, analysis.correlations, [&](const statistics::Correlation& x) { return (x.r < 0) == (f.expect == Expect::negative); },
        [](const statistics::Correlation& x) { return fmt::format("r = {:.3f} ({:.2f} to {:.2f})", x.r, x.low, x.high); });
  }

  Judged weaker(const Finding& f) const {
    using Difference = statistics::CorrelationDifference;
    return at_places(
        f, analysis.changes, [](const Difference& x) { return std::fabs(x.second) < std::fabs(x.first) && !is_reversed(x); },
        [](const Difference& x) { return fmt::format("r = {:.3f}, baseline {:.3f}, z = {:.2f}", x.second, x.first, x.z); });
  }

  /// Gains of a task over those of every other one, paired over the subjects; a family of its own.
  Judged largest(const Finding& f) const {
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
      const std::vector<double> corrected = statistics::holm(p);
      for (std::size_t i = 0, k = 0; i < tests.size(); ++i) {
        const std::string name = "gain over that of " + task_name(others[i]) + ": ";
        if (!tests[i]) {
          parts.add(std::nullopt, name + tests[i].error().message);
          continue;
        }
        const statistics::PairedTest& t = *tests[i];
        parts.add(corrected[k] < kAlpha && t.difference > 0, fmt::format("{}{:.3g} {} ({:.3g} to {:.3g}), {}", name, t.difference,
                                                                         unit_of(q), t.low, t.high, p_words(t.p, corrected[k])));
        ++k;
      }
    }
    return parts.judged();
  }

  Judged rejections(const Finding& f) const {
    const Rejections all = analysis.all_rejected();
    if (all.trials == 0) return {Verdict::not_testable, {}, {"there are no trials"}};
    const statistics::Interval share = statistics::share_interval(all.rejected(), all.trials, kConfidence);
    const double theirs = static_cast<double>(f.rejected) / f.trials;
    return {share.contains(theirs) ? Verdict::supported : Verdict::not_supported,
            {},
            {fmt::format("{} of {} were left out, {:.1f} % ({:.1f} to {:.1f}); the share that is stated, {:.1f} %", all.rejected(),
                         all.trials, 100.0 * all.rejected() / all.trials, 100 * share.low, 100 * share.high, 100 * theirs)}};
  }

  Judged of(const Finding& f) const {
    switch (f.asks) {
      case Asks::difference:
        return difference(f);
      case Asks::intervals:
        return intervals(f);
      case Asks::tasks:
        return tasks(f);
      case Asks::correlation:
        return correlation(f);
      case Asks::weaker:
        return weaker(f);
      case Asks::largest:
        return largest(f);
      case Asks::rejections:
        return rejections(f);
      case Asks::none:
        break;
    }
    return {Verdict::not_testable, {}, {f.why}};
  }
};

}  // namespace

void judge_findings(const Study& study, const study::Inquiry& inquiry, Analysis& analysis) {
  const Judge judge{study, analysis};
  for (const Finding& finding : inquiry.findings) analysis.findings.push_back(judge.of(finding));
}

}  // namespace catena::app::analysis
