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
enum class Asks { difference, intervals, tasks, correlation, weaker, largest, rejections, none };
enum class Expect { by_test, lower, higher, apart, overlap, negative, positive };
const char* asks_word(Asks asks);
const char* expect_word(Expect expect);

struct Finding {
  std::string paper;     ///< the sentence
  std::string reported;  ///< its numbers, as it prints them
  Asks asks = Asks::none;
  Measure measure = Measure::error;
  bool of_deviations = false;       ///< a subject's standard deviation over its trials, instead of its mean
  std::vector<int> tasks;           ///< indices
  std::vector<int> conditions;      ///< indices; of `difference`, `intervals`, `weaker` and `largest` never the baseline
  Expect expect = Expect::by_test;  ///< once read, one of the others where the test has a choice
  int rejected = 0, trials = 0;     ///< of `rejections`
  std::string why;                  ///< of `none`
  json::Node where;
};

struct Inquiry {
  std::vector<std::array<int, 2>> pairs;  ///< of tasks
  std::vector<Finding> findings;
};

Result<Inquiry> read_inquiry(const Study& study);

/// Their keys, for the study file's schema and docs/study.md.
std::vector<schema::Component> inquiry_components();

}  // namespace catena::study
