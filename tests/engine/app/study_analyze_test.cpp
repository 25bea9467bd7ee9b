// SPDX-License-Identifier: MIT
/// `catena study analyse` and `study power`: each kind of finding, rejected trials with their reasons, subjects with missing trials,
/// invalid rows, errors in the analysis plan, and the commands.
#include <filesystem>

#include "engine/base/json.h"
#include "engine/base/memory_limit.h"
#include "tests/engine/app/program_runs.h"
#include "tests/engine/app/trial_table_fixtures.h"

namespace study_analyze_test {

using namespace study_tables;
using test::has;
using test::run_ok;
using test::run_refused;

TEST(StudyFindings, AreJudgedByTheirTests) {
  std::mt19937_64 random(5);
  const Analysis clear = run_analysis(make_trial_table(random, {.effect = 3, .haste = -3}));
  for (const char* paper : {"held is more accurate", "the times' intervals overlap", "to follow is less accurate", "haste costs accuracy",
                            "less so when held", "the gain is largest when tracing"})
    EXPECT_EQ(find_finding(clear, paper).verdict, Verdict::supported) << paper << ": " << find_finding(clear, paper).text();
  EXPECT_EQ(find_finding(clear, "held is steadier").verdict, Verdict::not_supported);
  EXPECT_EQ(find_finding(clear, "1 of 400 was rejected").verdict, Verdict::supported);
  EXPECT_EQ(find_finding(clear, "they liked it").verdict, Verdict::not_testable);
  EXPECT_EQ(find_finding(clear, "they liked it").text(), "nobody was asked");
  EXPECT_TRUE(find_finding(clear, "the times' intervals overlap").text().starts_with("2 of 2: yes: trace: free "));

  // A difference in the opposite direction, and no difference.
  const Analysis turned = run_analysis(make_trial_table(random, {.effect = -3, .haste = 3})),
                 none = run_analysis(make_trial_table(random, {}));
  for (const Analysis* a : {&turned, &none})
    for (const char* paper : {"held is more accurate", "haste costs accuracy", "the gain is largest when tracing"})
      EXPECT_EQ(find_finding(*a, paper).verdict, Verdict::not_supported) << paper;
  // One subject: no finding can be tested.
  const Analysis one = run_analysis(make_trial_table(random, {.effect = 3, .subjects = 1}));
  for (const char* paper : {"held is more accurate", "to follow is less accurate", "haste costs accuracy", "less so when held",
                            "the gain is largest when tracing", "the times' intervals overlap"})
    EXPECT_EQ(find_finding(one, paper).verdict, Verdict::not_testable) << paper;
  EXPECT_TRUE(has(find_finding(one, "held is more accurate").text(), "at least 2 values are required, but there is 1"));
}

TEST(StudyRejections, AreCountedByReasonAndExcluded) {
  std::mt19937_64 random(6);
  std::vector<TrialRow> rows = make_trial_table(random, {});
  rows[0].error_mm = 31, rows[1].time_s = 12.5, rows[2].error_mm = 40, rows[2].time_s = 13, rows[3].reached_target = false,
  rows[3].time_s = 30;
  rows[4].training = true, rows[4].error_mm = 1e6;
  rows[5].error_mm = 30, rows[6].time_s = 12;  // at the limits, which are accepted
  const Analysis a = run_analysis(rows);
  const Rejections& r = a.rejections_in({0, 0});
  EXPECT_EQ(r.trials, 199);
  EXPECT_EQ(r.error, 1);
  EXPECT_EQ(r.time, 1);
  EXPECT_EQ(r.both, 1);
  EXPECT_EQ(r.unfinished, 1);
  EXPECT_EQ(a.training_count, 1);
  EXPECT_EQ(a.cell(0, {0, 0}).accepted, 5);
  EXPECT_LT(a.value(0, {0, 0}, Quantity::error), 30);
}

TEST(StudyMissingTrials, SubjectsWithoutTrialsAreExcludedByNumber) {
  std::mt19937_64 random(7);
  std::vector<TrialRow> rows = make_trial_table(random, {.subjects = 12});
  for (TrialRow& row : rows) {
    if (row.subject == 4 && row.task == "trace" && row.condition == "held") row.error_mm = 99;  // all rejected
    row.subject *= 10;
  }
  std::erase_if(rows, [](const TrialRow& row) { return row.subject == 70 && row.task == "follow"; });
  const Analysis a = run_analysis(rows);
  EXPECT_EQ(find_difference(a, Quantity::error, 0).excluded_subjects, std::vector<int>{40});
  EXPECT_EQ(find_difference(a, Quantity::error, 0).test->n, 11);
  EXPECT_EQ(find_difference(a, Quantity::time_deviation, 1).excluded_subjects, std::vector<int>{70});
  EXPECT_EQ(a.task_comparisons.front().excluded_subjects, std::vector<int>{70});       // free
  EXPECT_EQ(a.task_comparisons.back().excluded_subjects, (std::vector<int>{40, 70}));  // held
  ASSERT_EQ(a.missing_data.size(), 3u);
  EXPECT_EQ(a.missing_data[0], "subject 40: no accepted trial of trace, held (10 done)");
  EXPECT_EQ(a.missing_data[1], "subject 70: no accepted trial of follow, free (0 done)");
  EXPECT_TRUE(has(tests_csv(study_fixture().study, a), ",40 70,"));
}

TEST(StudyRows, RowsOfAnotherDesignAreRefusedInOneLine) {
  std::mt19937_64 random(8);
  const std::vector<TrialRow> good = make_trial_table(random, {.subjects = 2});
  const auto says = [&](const auto& change, const std::string& words) {
    std::vector<TrialRow> rows = good;
    change(rows[7]);
    const auto result = analyze(study_fixture().study, study_fixture().inquiry, rows, "DIR");
    ASSERT_FALSE(result) << words;
    EXPECT_TRUE(result.error().message.starts_with("DIR: subject ")) << result.error().message;
    EXPECT_TRUE(has(result.error().message, words));
    EXPECT_EQ(result.error().message.find('\n'), std::string::npos);
  };
  says([](TrialRow& row) { row.task = "tracce"; }, "no task \"tracce\" (did you mean \"trace\"?); trace or follow was expected");
  says([](TrialRow& row) { row.condition = "x\ny"; }, "no condition");
  says([](TrialRow& row) { row.dimensions = 3; }, "\"tracing\" in 3D; tracing in 2D was expected for the task \"trace\"");
  says([](TrialRow& row) { row.error_mm = -1; }, "the error or time is negative");
  says([](TrialRow& row) { row.index = 6; }, "the trial is repeated");
}

TEST(StudyRows, AHugeTableIsRefusedIfMemoryIsShort) {
  set_memory_limit(std::uint64_t{2} << 20);
  const auto rows = study::parse_rows(study::table_header() + std::string(100'000, '\n'), "DIR/trials.csv");
  set_memory_limit(std::nullopt);
  ASSERT_FALSE(rows);
  EXPECT_TRUE(rows.error().message.starts_with("DIR/trials.csv: a table of 100001 rows needs ")) << rows.error().message;
}

TEST(StudyAnalysisPlan, ErrorsNameTheLine) {
  const auto says = [&](const std::string& from, const std::string& to, const std::string& words) {
    std::string text = kStudy;
    ASSERT_NE(text.find(from), std::string::npos) << from;
    text.replace(text.find(from), from.size(), to);
    const auto study = study::parse_study(text, "s.json");
    ASSERT_FALSE(study) << to;
    EXPECT_TRUE(study.error().message.starts_with("s.json:")) << study.error().message;
    EXPECT_TRUE(has(study.error().message, words));
  };
  says("\"test\": \"weaker_correlation\"", "\"test\": \"weakest\"", "weaker_correlation");
  says("\"rejected\": 1, \"trials\": 400", "\"rejected\": 3, \"trials\": 2", "is no share");
  says("\"reason\": \"nobody was asked\"", "\"reported\": \"\"", "\"reason\" is missing");
  says("\"tasks\": [\"trace\"], \"conditions\": [\"free\"]", "\"tasks\": [\"trac\"]", "did you mean \"trace\"?");
  says("[\"follow\", \"trace\"], \"alternative\"", "[\"trace\", \"follow\"], \"alternative\"", "no pair that \"compare\" has");
  says("\"alternative\": \"overlap\"", "\"alternative\": \"lower\"", "apart or overlap was expected");
  says("\"test\": \"untestable\", ", "\"test\": \"untestable\", \"tasks\": [\"trace\"], ", "means nothing to the test \"untestable\"");
  says("\"of\": \"deviation\", ", "\"of\": \"deviation\", \"conditions\": [\"free\"], ", "names the first condition");
  says("{\"tasks\": [\"follow\", \"trace\"]}", "{\"tasks\": [\"follow\"]}", "names no two tasks");
  says("{\"tasks\": [\"follow\", \"trace\"]}", "{\"tasks\": [\"follow\", \"follow\"]}", "stands twice");
}

/// Writes a data folder as `study run` does.
void write_data(const std::string& folder, const std::vector<TrialRow>& rows) {
  std::filesystem::create_directories(folder);
  test::write_file(folder + "/study.json", kStudy);
  std::string text = study::table_header();
  for (const TrialRow& row : rows) text += study::format_row(row);
  test::write_file(folder + "/trials.csv", text);
}

TEST(StudyAnalyse, WritesTablesAndASelfContainedPage) {
  test::TemporaryFolder folder;
  std::mt19937_64 random(9);
  std::vector<TrialRow> rows = make_trial_table(random, {.effect = 3, .haste = -3});
  std::erase_if(rows, [](const TrialRow& row) { return row.subject == 5 && row.task == "follow"; });
  write_data(folder / "data", rows);
  std::filesystem::create_directories(folder / "data/questionnaire");
  for (const auto& [name, text] :
       {std::pair{"001", "hard,a bit\nhow,\"so, \"\"so\"\" <b>\"\n"}, {"003", "hard,a bit\n"}, {"004", "hard,yes\nho"}})
    test::write_file(folder / ("data/questionnaire/" + std::string(name) + ".csv"), "question,answer\n" + std::string(text));
  const auto run = run_ok({"study", "analyse", folder / "data", "-o", folder / "out"});
  EXPECT_TRUE(has(run.out, "20 subjects, 780 trials, 0 rejected"));
  EXPECT_TRUE(has(run.out, "supported: held is more accurate"));
  EXPECT_EQ(run.out.find("model"), std::string::npos) << run.out;

  const test::Table tests = test::Table::read(folder / "out/tests.csv");
  EXPECT_EQ(tests.rows(), 12u);
  EXPECT_EQ(tests.text(0, "family"), "conditions");
  EXPECT_EQ(tests.number(0, "n"), 20);
  EXPECT_NEAR(tests.number(0, "d_z"), tests.number(0, "t") / std::sqrt(20), 1e-12);
  EXPECT_EQ(tests.text(4, "left_out"), "5");
  EXPECT_EQ(test::Table::read(folder / "out/subjects.csv").rows(), 80u);
  EXPECT_EQ(test::read_file(folder / "out/trials.csv"), test::read_file(folder / "data/trials.csv"));
  const std::string json = test::read_file(folder / "out/results.json");
  ASSERT_TRUE(json::parse(json, "results.json"));
  EXPECT_TRUE(has(json, "\"simulated\": false"));
  EXPECT_TRUE(has(json, R"({"subject": 1, "question": "how", "answer": "so, \"so\" <b>"})"));

  EXPECT_NE(json.find(R"({"subject": 1, "question": "how", "answer": "so, \"so\" <b>"})"), std::string::npos);
  EXPECT_EQ(test::read_file(folder / "out/answers.csv"),
            "subject,question,answer\n1,hard,a bit\n1,how,so; \"so\" <b>\n3,hard,a bit\n4,hard,yes\n");

  const std::string page = test::read_file(folder / "out/report.html");
  for (const char* words : {"Was it &lt;hard&gt;?", "<td>no</td><td class=\"n\">0</td>", "<td>a bit</td><td class=\"n\">2</td>",
                            "<td>yes</td><td class=\"n\">1</td>", "<li>subject 1: so, &quot;so&quot; &lt;b&gt;</li>",
                            "prefers-color-scheme: dark", "subject 5: no accepted trial of follow, free", "1 of 400 was rejected"})
    EXPECT_TRUE(has(page, words));
  EXPECT_EQ(page.find("<script"), std::string::npos);
  for (const char* away : {"src=", "href=\"http", "url(", "@import"}) EXPECT_EQ(page.find(away), std::string::npos) << away;

  // The same data give bit-identical tables; results of a model are marked as such everywhere.
  test::write_file(folder / "data/simulated.json", "{}");
  const auto again = run_ok({"study", "analyse", folder / "data", "-o", folder / "again"});
  for (const char* name : {"tests.csv", "means.csv", "correlations.csv", "slopes.csv", "rejections.csv", "findings.csv", "subjects.csv"})
    EXPECT_EQ(test::read_file(folder / ("out/" + std::string(name))), test::read_file(folder / ("again/" + std::string(name)))) << name;
  for (const std::string& text : {again.out, test::read_file(folder / "again/report.html"), test::read_file(folder / "again/results.json")})
    EXPECT_TRUE(has(text, "do not replace results of people"));
}

TEST(StudyAnalyse, BadInputIsOneLineAndWritesNothing) {
  test::TemporaryFolder folder;
  std::mt19937_64 random(10);
  const std::vector<TrialRow> rows = make_trial_table(random, {.subjects = 2, .trials = 2});
  const auto refused = [&](const std::string& data, const std::string& out, const std::string& words) {
    run_refused({"study", "analyse", data, "-o", out}, words);
  };
  refused(folder / "nothing", folder / "out", "study.json");
  write_data(folder / "empty", {});
  refused(folder / "empty", folder / "out", "there are no trials");
  write_data(folder / "data", rows);
  refused(folder / "data", folder / "data", "trials.csv");
  const std::string text = test::read_file(folder / "data/trials.csv");
  test::write_file(folder / "data/trials.csv", text + "1,2,3\n");
  refused(folder / "data", folder / "out", "trials.csv:18: the row has 3 cells");
  std::string inf = text;
  inf.replace(inf.find(",target,") + 8, 1, "inf");
  test::write_file(folder / "data/trials.csv", inf);
  refused(folder / "data", folder / "out", "trials.csv:2: ");
  EXPECT_FALSE(test::exists(folder / "out"));
}

TEST(StudyPower, ReportsTheNumberOfSubjectsOfADesign) {
  test::TemporaryFolder folder;
  test::write_file(folder / "study.json", kStudy);
  const auto run = run_ok({"study", "power", folder / "study.json", "--effect", "0.5"});
  EXPECT_TRUE(has(run.out, "one test at alpha = 0.05: 34 subjects for a power of 0.8; the design's 20 subjects have a power of 0.565"));
  EXPECT_TRUE(has(run.out, "the strictest of 8 tests"));
  for (const auto& [option, value] :
       {std::pair{"--effect", "0"}, {"--effect", "nan"}, {"--power", "1"}, {"--alpha", "0"}, {"--power", "0.01"}}) {
    test::Words words{"study", "power", folder / "study.json", option, value};
    if (std::string(option) != "--effect") words = test::joined(words, {"--effect", "0.5"});
    run_refused(words, "expected");
  }
}

}  // namespace study_analyze_test
