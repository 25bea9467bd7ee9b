// SPDX-License-Identifier: MIT
/// Hostile trial tables and queries: a table that is read can be written and read again; otherwise an error in one line.
#include <gtest/gtest.h>

#include <cmath>

#include "engine/study/analysis_plan.h"
#include "engine/study/trial_table.h"
#include "tests/fuzz/mutate.h"

namespace catena::trial_table_fuzz_test {

const std::string kRows =
    study::table_header() +
    "1,0,0,trace,tracing,2,free,0,17,0,target,4.25,3.5,104.2,1.75,12,-3,0\r\n1,1,0,trace,tracing,2,held,0,17,1,limit,30,1e-3,4,0,0,0,0\n"
    "12,7,1,follow,advection,3,free,9,2000000000,0,target,0.125,99.5,1e3,10,-1e-300,2,3\n";

const std::string kStudy = R"({"name": "s", "tasks": [
 {"name": "trace", "kind": "tracing", "dimensions": 2, "field": "f", "scene": {"fields": {"f": {"analytic": "vortices"}},
  "camera": {"position": [0, 0, 8], "target": [0, 0, 0]}, "workspace": {"metres_per_unit": 0.05}}},
 {"name": "other", "kind": "tracing", "dimensions": 2, "field": "f", "scene": {"fields": {"f": {"analytic": "vortices"}},
  "camera": {"position": [0, 0, 8], "target": [0, 0, 0]}, "workspace": {"metres_per_unit": 0.05}}}],
 "conditions": [{"name": "free", "chain": []}, {"name": "held", "chain": []}], )";
const std::string kAsked = R"("compare": [{"tasks": ["trace", "other"]}], "findings": [
 {"claim": "p", "reported": "r", "test": "difference", "measure": "time", "of": "deviation", "alternative": "higher", "conditions": ["held"]},
 {"claim": "p", "test": "tasks", "tasks": ["trace", "other"]}, {"claim": "p", "test": "largest", "tasks": ["trace"]},
 {"claim": "p", "test": "rejections", "rejected": 3, "trials": 9}, {"claim": "p", "test": "untestable", "reason": "w"}]})";

bool check(const std::string& text) {
  const auto rows = study::parse_rows(text, "t.csv");
  if (!rows) {
    test::expect_error_line(rows.error().message, "t.csv:", text, 600, "");
    return false;
  }
  std::string again = study::table_header();
  for (const study::TrialRow& row : *rows) {
    EXPECT_TRUE(std::isfinite(row.time_s) && std::isfinite(row.error_mm) && row.subject >= 0 && !row.task.empty()) << text;
    again += study::format_row(row);
  }
  const auto back = study::parse_rows(again, "t.csv");
  EXPECT_TRUE(back && *back == *rows) << text;
  return true;
}

bool check_inquiry(const std::string& text) {
  const auto study = study::parse_study(text, "s.json");
  if (!study) {
    test::expect_error_line(study.error().message, "s.json:", text, 600, "");
    return false;
  }
  const auto inquiry = study::read_analysis_plan(*study);
  for (const study::Finding& f : inquiry->findings)
    for (const int task : f.tasks) EXPECT_TRUE(task >= 0 && task < 2) << text;
  return true;
}

TEST(TrialTableFuzz, TheSeedsAreValid) {
  EXPECT_TRUE(check(kRows));
  EXPECT_EQ(study::parse_rows(kRows, "t.csv")->size(), 3u);
  EXPECT_TRUE(check_inquiry(kStudy + kAsked));
}

TEST(TrialTableFuzz, EveryTruncationAndEveryByteFlip) { test::truncate_and_flip(kRows, check); }

TEST(TrialTableFuzz, Mutations) {
  const std::string header = study::table_header(), rows = kRows.substr(header.size());
  // mostly in the rows, because a broken header hides them
  test::fuzz(10000, 29, [&](test::Random& random, std::uint64_t) {
    return check(random.below(8) == 0 ? test::mutate(kRows, random) : header + test::mutate(rows, random));
  });
}

TEST(TrialTableFuzz, MutationsOfQueries) {
  test::fuzz(2000, 30, [](test::Random& random, std::uint64_t) { return check_inquiry(kStudy + test::mutate(kAsked, random)); });
}

TEST(TrialTableFuzz, LongTexts) {
  EXPECT_FALSE(check(study::table_header() + std::string(1000000, ',')));
  EXPECT_FALSE(check(std::string(1000000, ',')));
  EXPECT_FALSE(check(study::table_header() + std::string(1000000, '9')));
  EXPECT_TRUE(check(study::table_header() + std::string(100000, '\n')));
}

}  // namespace catena::trial_table_fuzz_test
