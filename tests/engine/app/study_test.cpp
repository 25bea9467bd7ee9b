// SPDX-License-Identifier: MIT
// `catena study`: simulate, shard, merge, continue after a kill, a custom study, and errors.
#include <filesystem>
#include <map>

#include "engine/base/json.h"
#include "tests/engine/app/program_runs.h"

namespace study_test {

using namespace catena;
using test::has;
using test::run_ok;
using test::run_refused;
namespace fs = std::filesystem;

class Study : public testing::Test {
 protected:
  /// Writes the paper's study with few trials, so that a session is short, and with one more text replaced; returns its path.
  std::string short_study(const std::string& from = "", const std::string& to = "") const {
    std::string text = test::read_file(paper_);
    for (const auto& [old, now] : {std::pair<std::string, std::string>{"\"trials\": 10", "\"trials\": 2"}, {from, to}}) {
      const auto at = text.find(old);
      EXPECT_NE(at, std::string::npos) << old;
      if (at != std::string::npos) text.replace(at, old.size(), now);
    }
    test::write_file(folder_ / "short.json", text);
    return folder_ / "short.json";
  }
  /// Arguments that simulate one subject into a folder.
  test::Words one_subject(const std::string& study, const std::string& out) const {
    return {"study", "simulate", study, "--subjects", "1", "-o", folder_ / out};
  }
  const std::string paper_ = test::source_dir() + "/assets/studies/proxy-chain.json";
  test::TemporaryFolder folder_;
};

TEST_F(Study, MergedShardsEqualTheWholeBitExactly) {
  const std::string path = short_study();
  const test::Words simulate{"study", "simulate", path, "--subjects", "2", "-o"};
  EXPECT_TRUE(has(run_ok(simulate, {folder_ / "whole"}).out, "2 simulated subjects, 32 trials"));
  run_ok(simulate, {folder_ / "part1", "--shard", "1/2"});
  run_ok(simulate, {folder_ / "part2", "--shard", "2/2"});
  fs::create_directories(folder_ / "part2/questionnaire");
  test::write_file(folder_ / "part2/questionnaire/002.csv", "question,answer\n");
  const test::Words merge{"study", "merge", folder_ / "part2", folder_ / "part1", "-o", folder_ / "merged"};
  run_ok(merge);
  const std::string table = test::read_file(folder_ / "whole/trials.csv");
  EXPECT_EQ(std::count(table.begin(), table.end(), '\n'), 33);
  EXPECT_EQ(table, test::read_file(folder_ / "merged/trials.csv"));
  EXPECT_EQ(test::read_file(folder_ / "whole/subjects/002.csv"), test::read_file(folder_ / "merged/subjects/002.csv"));
  EXPECT_EQ(test::read_file(folder_ / "merged/study.json"), test::read_file(path));
  EXPECT_EQ(test::read_file(folder_ / "merged/questionnaire/002.csv"), "question,answer\n");
  // A repeated merge changes nothing; folders with different trials are refused.
  run_ok(merge);
  std::string other = test::read_file(folder_ / "part1/subjects/001.csv");
  other.replace(other.rfind(",target,"), 8, ",limit,");
  fs::create_directories(folder_ / "bad/subjects");
  test::write_file(folder_ / "bad/study.json", test::read_file(path));
  test::write_file(folder_ / "bad/subjects/001.csv", other);
  const test::Words mixed{"study", "merge", folder_ / "part1", folder_ / "bad", "-o", folder_ / "never"};
  run_refused(mixed, "trials of a model");
  test::write_file(folder_ / "bad/simulated.json", "{}");
  run_refused(mixed, "the trials of subject 1 differ");
  EXPECT_FALSE(test::exists(folder_ / "never"));
}

TEST_F(Study, ContinuesAfterTheLastCompleteTrial) {
  const std::string path = short_study();
  run_ok(one_subject(path, "a"));
  const std::string whole = test::read_file(folder_ / "a/subjects/001.csv");
  // The state after a kill: nine trials and a part of the tenth.
  std::size_t at = 0;
  for (int line = 0; line < 10; ++line) at = whole.find('\n', at) + 1;
  fs::create_directories(folder_ / "b/subjects");
  test::write_file(folder_ / "b/study.json", test::read_file(path));
  test::write_file(folder_ / "b/subjects/001.csv", whole.substr(0, at + 17));
  run_refused(one_subject(path, "b"));  // a person's session is not finished by a model
  test::write_file(folder_ / "b/simulated.json", "{}");
  EXPECT_TRUE(has(run_ok(one_subject(path, "b")).out, "16 trials, 7 of them computed in this run"));
  EXPECT_EQ(test::read_file(folder_ / "b/subjects/001.csv"), whole);
}

TEST_F(Study, ACustomStudyRuns) {
  fs::copy_file(test::source_dir() + "/assets/studies/friction.json", folder_ / "friction.json");
  run_refused(one_subject(folder_ / "friction.json", "d"), "flow.vdb");
  EXPECT_FALSE(test::exists(folder_ / "d")) << "no incomplete file";
  run_ok({"generate", "abc", "-o", folder_ / "flow.vdb", "--resolution", "32"});
  run_ok(one_subject(folder_ / "friction.json", "d"));
  const test::Table table = test::Table::read(folder_ / "d/trials.csv");
  ASSERT_EQ(table.rows(), 18u);
  std::map<std::string, double> force;
  for (std::size_t i = 0; i < table.rows(); ++i) force[table.text(i, "condition")] += table.number(i, "peak_force_n");
  ASSERT_EQ(force.size(), 3u);
  EXPECT_EQ(force["none"], 0);
  EXPECT_GT(force["drag"], 1);
  EXPECT_GT(force["across"], 0.1);
}

TEST_F(Study, TheSchemaHasTheKeysOfTheBundledStudies) {
  const auto schema = json::parse(run_ok({"study", "keys", "--schema"}).out, "schema");
  ASSERT_TRUE(schema) << schema.error().message;
  const json::Node& properties = *schema->find("properties");
  for (const char* name : {"proxy-chain", "friction"}) {
    const auto file = json::read(test::source_dir() + "/assets/studies/" + name + ".json");
    ASSERT_TRUE(file);
    for (const auto& [key, value] : file->members) EXPECT_NE(properties.find(key), nullptr) << key;
    const json::Node& task = *properties.find("tasks")->find("items")->find("properties");
    for (const auto& [key, value] : file->find("tasks")->items[0].members) EXPECT_NE(task.find(key), nullptr) << key;
  }
}

TEST_F(Study, ATrialIsWrittenAsAScene) {
  for (const char* trial : {"0", "30", "55", "80"}) {
    run_ok({"study", "scene", paper_, "--subject", "3", "--trial", trial, "-o", folder_ / "t.json"});
    const auto info = run_ok({"info", folder_ / "t.json"});
    EXPECT_TRUE(has(info.out, "field flow: vector vortices"));
    EXPECT_TRUE(has(info.out, "1 world unit is 0.05 m"));
  }
  run_refused({"study", "scene", paper_, "--trial", "96", "-o", folder_ / "u.json"});
  EXPECT_FALSE(test::exists(folder_ / "u.json"));
}

TEST_F(Study, ARecordedTrialReplaysBitExactly) {
  run_ok(one_subject(short_study("\"trials\": 2", "\"trials\": 1"), "d"), {"--record"});
  const test::Table table = test::Table::read(folder_ / "d/trials.csv");
  for (std::size_t i = 0; i < table.rows(); i += 3)
    run_ok({"replay", "--log", folder_ / fmt::format("d/recordings/001-{:03}.catlog", static_cast<int>(table.number(i, "index")))});
}

TEST_F(Study, AnotherModelInTheSameFolderIsRefused) {
  const std::string path = short_study();
  run_ok(one_subject(path, "d"), {"--model", "depth_noise_mm=0", "--model", "tremor_mm=0.1"});
  const std::string stored_study = test::read_file(folder_ / "d/study.json");
  EXPECT_TRUE(has(stored_study, "\"depth_noise_mm\": 0,"));
  EXPECT_TRUE(has(stored_study, "\"tremor_mm\": 0.1,"));
  run_refused(one_subject(path, "d"), "another study");
}

TEST_F(Study, ImpossibleValuesInTheFileAreRefused) {
  for (const auto& [from, to, part] : {std::tuple{"\"name\": \"iso\"", "\"name\": \"i\\nso\"", "\"name\""},
                                       {"\"name\": \"iso\"", "\"name\": \"\"", "\"name\""},
                                       {"\"metres_per_unit\": 0.05", "\"metres_per_unit\": 1e-9", "times the diagonal of the field's box"},
                                       {"\"stimulus\": {", "\"stimulus\": {\"turn_deg\": 180, \"candidates\": 1, ", "turn too little"}}) {
    run_refused({"study", "scene", short_study(from, to), "-o", folder_ / "d.json"}, part);
    EXPECT_FALSE(test::exists(folder_ / "d.json")) << to;
  }
}

TEST_F(Study, WithoutContextStreamlinesTheSceneIsValid) {
  run_ok({"study", "scene", short_study("\"context_streamlines\": 14", "\"context_streamlines\": 0"), "-o", folder_ / "d.json"});
  run_ok({"info", folder_ / "d.json"});
}

TEST_F(Study, ErrorsAreOneLine) {
  const std::string path = short_study();
  const auto refused = [&](const test::Words& words) {
    run_refused(test::joined({"study"}, words));
    EXPECT_FALSE(test::exists(folder_ / "d")) << testing::PrintToString(words);
  };
  refused({"simulate", folder_ / "none.json", "-o", folder_ / "d"});
  refused({"simulate", path, "--subjects", "0", "-o", folder_ / "d"});
  for (const char* shard : {"3/2", "half", ""}) refused({"simulate", path, "--subjects", "1", "--shard", shard, "-o", folder_ / "d"});
  for (const char* model : {"tremor_mm=1e300", "tremor_mm", "tremor=1", "tremor_mm=-1"})
    refused({"simulate", path, "--subjects", "1", "--model", model, "-o", folder_ / "d"});
  refused({"merge", folder_ / "nothing", "-o", folder_ / "d"});
  refused({"keys", "taks"});
  refused({});
}

}  // namespace study_test
