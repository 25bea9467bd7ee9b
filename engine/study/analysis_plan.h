/// What the data of a study are asked: "compare", pairs of tasks, and "findings", sentences of a paper, each with the test that would bear
/// it out. Read from the study file; errors are FILE:LINE: what; what was expected.
///   difference   every condition named against the baseline, paired over subjects, in every task named
///   intervals    the intervals of the means of the same, apart from the baseline's or overlapping it
///   tasks        the first of two tasks against the second, paired over subjects, in every condition named; a pair of "compare"
///   correlation  of error and time over subjects, in every task and condition named
///   weaker       that correlation, nearer 0 in every condition named than in the baseline
///   largest      the gain over the baseline, in one task against every other task
///   rejections   the share of trials that were left out, beside `rejected` of `trials`
///   none         these data cannot say; `why`
#pragma once
#include <array>

#include "engine/study/study.h"

namespace catena::study {

enum class Measure { error, time };
enum class TestKind { difference, intervals, tasks, correlation, weaker, largest, rejections, none };
enum class Alternative { from_test, lower, higher, apart, overlap, negative, positive };
const char* to_string(TestKind asks);
const char* to_string(Alternative expect);

struct Finding {
  std::string claim;     ///< the sentence
  std::string reported;  ///< its numbers, as it prints them
  TestKind test = TestKind::none;
  Measure measure = Measure::error;
  bool uses_deviations = false;                      ///< a subject's standard deviation over its trials, instead of its mean
  std::vector<int> tasks;                            ///< indices
  std::vector<int> conditions;                       ///< indices; of `difference`, `intervals`, `weaker` and `largest` never the baseline
  Alternative alternative = Alternative::from_test;  ///< once read, one of the others where the test has a choice
  int rejected = 0, trials = 0;                      ///< of `rejections`
  std::string why;                                   ///< of `none`
  json::Node where;
};

struct AnalysisPlan {
  std::vector<std::array<int, 2>> pairs;  ///< of tasks
  std::vector<Finding> findings;
};

Result<AnalysisPlan> read_analysis_plan(const Study& study);

/// Their keys, for the study file's schema and docs/study.md.
std::vector<schema::Section> analysis_plan_components();

}  // namespace catena::study
