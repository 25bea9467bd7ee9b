// SPDX-License-Identifier: MIT
// `catena study`: simulate, shard, merge, continue after a kill, a custom study, and errors.
#include <gtest/gtest.h>

#include <filesystem>

#include "engine/base/json.h"
#include "tests/support/run_program.h"
#include "tests/support/support.h"

namespace study_test {

using namespace catena;
namespace fs = std::filesystem;

/// Writes the paper's study with few trials, so that a session is short, and returns its path.
std::string short_study(const test::TemporaryFolder& folder) {
  std::string text = test::read_file(test::source_dir() + "/assets/studies/proxy-chain.json");
  const auto replace = [&](const std::string& from, const std::string& to) { text.replace(text.find(from), from.size(), to); };
  replace("\"trials\": 10", "\"trials\": 2");
  const std::string path = folder / "short.json";
  test::write_file(path, text);
  return path;
}

test::ProgramResult study(std::vector<std::string> arguments) {
  arguments.insert(arguments.begin(), "study");
  return test::run_catena(arguments);
}

TEST(Study, MergedShardsEqualTheWholeBitExactly) {
  const test::TemporaryFolder folder;
  const std::string path = short_study(folder);
  const auto whole = study({"simulate", path, "--subjects", "2", "-o", folder / "whole"});
  ASSERT_EQ(whole.exit_code, 0) << whole.err;
  EXPECT_NE(whole.out.find("2 simulated subjects, 32 trials"), std::string::npos) << whole.out;
  for (const char* shard : {"1/2", "2/2"}) {
    const auto part = study({"simulate", path, "--subjects", "2", "-o", folder / ("part" + std::string(1, shard[0])), "--shard", shard});
    ASSERT_EQ(part.exit_code, 0) << part.err;
  }
  fs::create_directories(folder / "part2/questionnaire");
  test::write_file(folder / "part2/questionnaire/002.csv", "question,answer\n");
  const auto merged = study({"merge", folder / "part2", folder / "part1", "-o", folder / "merged"});
  ASSERT_EQ(merged.exit_code, 0) << merged.err;
  const std::string table = test::read_file(folder / "whole/trials.csv");
  EXPECT_EQ(std::count(table.begin(), table.end(), '\n'), 33);
  EXPECT_EQ(table, test::read_file(folder / "merged/trials.csv"));
  EXPECT_EQ(test::read_file(folder / "whole/subjects/002.csv"), test::read_file(folder / "merged/subjects/002.csv"));
  EXPECT_EQ(test::read_file(folder / "merged/study.json"), test::read_file(path));
  EXPECT_EQ(test::read_file(folder / "merged/questionnaire/002.csv"), "question,answer\n");
  // A repeated merge changes nothing; folders with different trials are refused.
  EXPECT_EQ(study({"merge", folder / "part2", folder / "part1", "-o", folder / "merged"}).exit_code, 0);
  std::string other = test::read_file(folder / "part1/subjects/001.csv");
  other.replace(other.rfind(",target,"), 8, ",limit,");
  fs::create_directories(folder / "bad/subjects");
  test::write_file(folder / "bad/study.json", test::read_file(path));
  test::write_file(folder / "bad/subjects/001.csv", other);
  const auto mixed = study({"merge", folder / "part1", folder / "bad", "-o", folder / "never"});
  EXPECT_EQ(mixed.exit_code, 2);
  EXPECT_NE(mixed.err.find("trials of a model"), std::string::npos) << mixed.err;
  test::write_file(folder / "bad/simulated.json", "{}");
  const auto refused = study({"merge", folder / "part1", folder / "bad", "-o", folder / "never"});
  EXPECT_EQ(refused.exit_code, 2);
  EXPECT_NE(refused.err.find("the trials of subject 1 differ"), std::string::npos) << refused.err;
  EXPECT_FALSE(test::exists(folder / "never"));
}

TEST(Study, ContinuesAfterTheLastCompleteTrial) {
  const test::TemporaryFolder folder;
  const std::string path = short_study(folder);
  ASSERT_EQ(study({"simulate", path, "--subjects", "1", "-o", folder / "a"}).exit_code, 0);
  const std::string whole = test::read_file(folder / "a/subjects/001.csv");
  // The state after a kill: nine trials and a part of the tenth.
  std::size_t at = 0;
  for (int line = 0; line < 10; ++line) at = whole.find('\n', at) + 1;
  fs::create_directories(folder / "b/subjects");
  test::write_file(folder / "b/study.json", test::read_file(path));
  test::write_file(folder / "b/subjects/001.csv", whole.substr(0, at + 17));
  EXPECT_EQ(study({"simulate", path, "--subjects", "1", "-o", folder / "b"}).exit_code, 2)
      << "a person's session is not finished by a model";
  test::write_file(folder / "b/simulated.json", "{}");
  const auto on = study({"simulate", path, "--subjects", "1", "-o", folder / "b"});
  ASSERT_EQ(on.exit_code, 0) << on.err;
  EXPECT_NE(on.out.find("16 trials, 7 of them computed in this run"), std::string::npos) << on.out;
  EXPECT_EQ(test::read_file(folder / "b/subjects/001.csv"), whole);
}

TEST(Study, ACustomStudyRuns) {
  const test::TemporaryFolder folder;
  fs::copy_file(test::source_dir() + "/assets/studies/friction.json", folder / "friction.json");
  const auto missing = study({"simulate", folder / "friction.json", "--subjects", "1", "-o", folder / "d"});
  EXPECT_EQ(missing.exit_code, 2);
  EXPECT_NE(missing.err.find("flow.vdb"), std::string::npos) << missing.err;
  EXPECT_FALSE(test::exists(folder / "d")) << "no incomplete file";
  ASSERT_EQ(test::run_catena({"generate", "abc", "-o", folder / "flow.vdb", "--resolution", "32"}).exit_code, 0);
  const auto run = study({"simulate", folder / "friction.json", "--subjects", "1", "-o", folder / "d"});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  const test::Table table = test::Table::read(folder / "d/trials.csv");
  ASSERT_EQ(table.rows(), 18u);
  std::map<std::string, double> force;
  for (std::size_t i = 0; i < table.rows(); ++i) force[table.text(i, "condition")] += table.number(i, "peak_force_n");
  ASSERT_EQ(force.size(), 3u);
  EXPECT_EQ(force["none"], 0);
  EXPECT_GT(force["drag"], 1);
  EXPECT_GT(force["across"], 0.1);
}

TEST(Study, TheSchemaHasTheKeysOfTheBundledStudies) {
  const auto printed = study({"keys", "--schema"});
  ASSERT_EQ(printed.exit_code, 0) << printed.err;
  const auto schema = json::parse(printed.out, "schema");
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

TEST(Study, ATrialIsWrittenAsAScene) {
  const test::TemporaryFolder folder;
  const std::string path = test::source_dir() + "/assets/studies/proxy-chain.json";
  for (const char* trial : {"0", "30", "55", "80"}) {
    const auto made = study({"scene", path, "--subject", "3", "--trial", trial, "-o", folder / "t.json"});
    ASSERT_EQ(made.exit_code, 0) << made.err;
    const auto info = test::run_catena({"info", folder / "t.json"});
    EXPECT_EQ(info.exit_code, 0) << info.err;
    EXPECT_NE(info.out.find("field flow: vector vortices"), std::string::npos) << info.out;
    EXPECT_NE(info.out.find("1 world unit is 0.05 m"), std::string::npos) << info.out;
  }
  EXPECT_EQ(study({"scene", path, "--trial", "96", "-o", folder / "u.json"}).exit_code, 2);
  EXPECT_FALSE(test::exists(folder / "u.json"));
}

TEST(Study, ARecordedTrialReplaysBitExactly) {
  const test::TemporaryFolder folder;
  std::string text = test::read_file(short_study(folder));
  text.replace(text.find("\"trials\": 2"), 11, "\"trials\": 1");
  test::write_file(folder / "one.json", text);
  ASSERT_EQ(study({"simulate", folder / "one.json", "--subjects", "1", "-o", folder / "d", "--record"}).exit_code, 0);
  const test::Table table = test::Table::read(folder / "d/trials.csv");
  for (std::size_t i = 0; i < table.rows(); i += 3) {
    const std::string name = fmt::format("d/recordings/001-{:03}.catlog", static_cast<int>(table.number(i, "index")));
    const auto again = test::run_catena({"replay", "--log", folder / name});
    EXPECT_EQ(again.exit_code, 0) << again.err;
  }
}

TEST(Study, AnotherModelInTheSameFolderIsRefused) {
  const test::TemporaryFolder folder;
  const std::string path = short_study(folder);
  const auto calm =
      study({"simulate", path, "--subjects", "1", "-o", folder / "d", "--model", "depth_noise_mm=0", "--model", "tremor_mm=0.1"});
  ASSERT_EQ(calm.exit_code, 0) << calm.err;
  const std::string stored_study = test::read_file(folder / "d/study.json");
  EXPECT_NE(stored_study.find("\"depth_noise_mm\": 0,"), std::string::npos);
  EXPECT_NE(stored_study.find("\"tremor_mm\": 0.1,"), std::string::npos);
  const auto other = study({"simulate", path, "--subjects", "1", "-o", folder / "d"});
  EXPECT_EQ(other.exit_code, 2);
  EXPECT_NE(other.err.find("another study"), std::string::npos) << other.err;
}

/// Replaces a text in the paper's study, and returns the error of `study scene`.
std::string refusal(const test::TemporaryFolder& folder, const std::string& from, const std::string& to) {
  std::string text = test::read_file(short_study(folder));
  const auto at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  text.replace(at, from.size(), to);
  test::write_file(folder / "changed.json", text);
  const auto run = study({"scene", folder / "changed.json", "-o", folder / "d.json"});
  EXPECT_EQ(run.exit_code, 2) << to << run.err;
  EXPECT_EQ(std::count(run.err.begin(), run.err.end(), '\n'), 1) << run.err;
  EXPECT_FALSE(test::exists(folder / "d.json"));
  return run.err;
}

TEST(Study, ImpossibleValuesInTheFileAreRefused) {
  const test::TemporaryFolder folder;
  EXPECT_NE(refusal(folder, "\"name\": \"iso\"", "\"name\": \"i\\nso\"").find("\"name\""), std::string::npos);
  EXPECT_NE(refusal(folder, "\"name\": \"iso\"", "\"name\": \"\"").find("\"name\""), std::string::npos);
  EXPECT_NE(refusal(folder, "\"metres_per_unit\": 0.05", "\"metres_per_unit\": 1e-9").find("times the diagonal of the field's box"),
            std::string::npos);
  EXPECT_NE(refusal(folder, "\"stimulus\": {", "\"stimulus\": {\"turn_deg\": 180, \"candidates\": 1, ").find("turn too little"),
            std::string::npos);
}

TEST(Study, WithoutContextStreamlinesTheSceneIsValid) {
  const test::TemporaryFolder folder;
  std::string text = test::read_file(short_study(folder));
  text.replace(text.find("\"context_streamlines\": 14"), 25, "\"context_streamlines\": 0");
  test::write_file(folder / "none.json", text);
  const auto run = study({"scene", folder / "none.json", "-o", folder / "d.json"});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  const auto info = test::run_catena({"info", folder / "d.json"});
  EXPECT_EQ(info.exit_code, 0) << info.err;
}

TEST(Study, ErrorsAreOneLine) {
  const test::TemporaryFolder folder;
  const std::string path = short_study(folder);
  const std::vector<std::vector<std::string>> mistakes = {
      {"simulate", folder / "none.json", "-o", folder / "d"},
      {"simulate", path, "--subjects", "0", "-o", folder / "d"},
      {"simulate", path, "--subjects", "1", "--shard", "3/2", "-o", folder / "d"},
      {"simulate", path, "--subjects", "1", "--shard", "half", "-o", folder / "d"},
      {"simulate", path, "--subjects", "1", "--shard", "", "-o", folder / "d"},
      {"simulate", path, "--subjects", "1", "--model", "tremor_mm=1e300", "-o", folder / "d"},
      {"simulate", path, "--subjects", "1", "--model", "tremor_mm", "-o", folder / "d"},
      {"simulate", path, "--subjects", "1", "--model", "tremor=1", "-o", folder / "d"},
      {"simulate", path, "--subjects", "1", "--model", "tremor_mm=-1", "-o", folder / "d"},
      {"merge", folder / "nothing", "-o", folder / "d"},
      {"keys", "taks"},
      {},
  };
  for (const auto& mistake : mistakes) {
    const auto run = study(mistake);
    EXPECT_EQ(run.exit_code, 2) << run.err;
    EXPECT_EQ(std::count(run.err.begin(), run.err.end(), '\n'), 1) << run.err;
    EXPECT_FALSE(test::exists(folder / "d")) << run.err;
  }
}

}  // namespace study_test
