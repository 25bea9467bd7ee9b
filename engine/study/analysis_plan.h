// SPDX-License-Identifier: MIT
/// The analysis plan of a study: the task pairs to compare ("compare") and the paper's claims ("findings"), each with the test that would
/// support it. Read from the study file. Errors have the form "FILE:LINE: what; what was expected".
/// The kinds of test:
///   difference   every listed condition against the baseline, paired over subjects, in every listed task
///   intervals    whether the confidence interval of every listed condition's mean is apart from the baseline's or overlaps it
///   tasks        the first of two tasks against the second, paired over subjects, in every listed condition; the pair must be in "compare"
///   correlation  correlation of error and time over subjects, in every listed task and condition
///   weaker_correlation  that correlation is closer to 0 in every listed condition than in the baseline
///   largest      the gain over the baseline, in one task against every other task
///   rejections   the fraction of rejected trials, compared with `rejected` of `trials`
///   untestable   these data cannot test the claim; `reason` states why
#pragma once
#include <array>

#include "engine/study/study.h"

namespace catena::study {

/// Measured quantity of a trial.
enum class Measure { error, time };
/// Kind of test; the list above describes each.
enum class TestKind { difference, intervals, tasks, correlation, weaker_correlation, largest, rejections, untestable };
/// Alternative hypothesis of a test. from_test: the test's default, or none where the test has no choice.
enum class Alternative { from_test, lower, higher, apart, overlap, negative, positive };
/// The key of the study file: "difference", "intervals", ...
const char* to_string(TestKind test_kind);
/// The value in the study file: "lower", "higher", ...; "by_test" for from_test.
const char* to_string(Alternative alternative);

/// One claim of a paper with its test.
struct Finding {
  std::string claim;     ///< The claim, a sentence
  std::string reported;  ///< The claim's numbers as the paper prints them
  TestKind test = TestKind::untestable;
  Measure measure = Measure::error;
  bool uses_deviations = false;  ///< `difference`: compares the subjects' standard deviations over their trials instead of their means
  std::vector<int> tasks;        ///< Indices of tasks
  /// Indices of conditions; without the baseline (index 0) except in `tasks` and `correlation`
  std::vector<int> conditions;
  Alternative alternative = Alternative::from_test;  ///< After reading, from_test only where the test has no choice
  int rejected = 0, trials = 0;                      ///< `rejections`: counts that the paper reports
  std::string reason;                                ///< `untestable`: why these data cannot test the claim
  /// Source location in the study file, for messages.
  json::Node where;
};

/// The comparisons and findings of one study.
struct AnalysisPlan {
  std::vector<std::array<int, 2>> pairs;  ///< Pairs of task indices; differences are first - second
  std::vector<Finding> findings;
};

/// Reads "compare" and "findings" of a study. Error: unknown names or keys, or a test without the values that it needs.
Result<AnalysisPlan> read_analysis_plan(const Study& study);

/// The keys of "compare" and "findings", for the study file's schema and docs/reference/study.md.
std::vector<schema::Section> analysis_plan_components();

}  // namespace catena::study
