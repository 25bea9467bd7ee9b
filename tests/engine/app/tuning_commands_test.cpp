// SPDX-License-Identifier: MIT
/// Tuning in the commands.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>

#include "engine/app/tuning/report/report.h"
#include "tests/support/run_program.h"
#include "tests/support/support.h"

namespace tuning_commands_test {

using namespace catena;

constexpr const char* kScene = R"({"fields": {"flow": {"analytic": "helix"}},
  "chain": [{"name": "curve", "type": "streamline", "field": "flow", "seed": [0.6, 0, -1.2]%s}],
  "workspace": {"metres_per_unit": 0.05}%s})";

/// The program with a separate cache folder.
class TuningCommand : public ::testing::Test {
 protected:
  void SetUp() override {
    const char* cache = std::getenv("XDG_CACHE_HOME");
    before_ = cache != nullptr ? cache : "";
    ::setenv("XDG_CACHE_HOME", (folder_ / "cache").c_str(), 1);
    std::string csv = "t,x,y,z\n";
    for (int k = 0; k < 300; ++k) csv += fmt::format("{},{},{},{}\n", 1e-3 * k, 0.6 + 1e-4 * k, 1e-3 * k, -1.2);
    test::write_file(folder_ / "p.csv", csv);
  }
  void TearDown() override {
    if (before_.empty())
      ::unsetenv("XDG_CACHE_HOME");
    else
      ::setenv("XDG_CACHE_HOME", before_.c_str(), 1);
  }
  std::string scene(const std::string& link = "", const std::string& more = "") const {
    std::string text = kScene;
    text.replace(text.find("%s"), 2, link);
    text.replace(text.find("%s"), 2, more);
    test::write_file(folder_ / "s.json", text);
    return folder_ / "s.json";
  }
  test::ProgramResult replay(const std::vector<std::string>& more) const {
    std::vector<std::string> all{"replay", folder_ / "s.json", "--probe", folder_ / "p.csv", "-o", folder_ / "out.csv"};
    all.insert(all.end(), more.begin(), more.end());
    return test::run_catena(all);
  }
  std::string only_file() const {
    std::string path;
    for (const auto& entry : std::filesystem::directory_iterator(folder_ / "cache/catena/plans")) {
      EXPECT_TRUE(path.empty());
      path = entry.path().string();
    }
    return path;
  }
  test::TemporaryFolder folder_;
  std::string before_;
};

TEST_F(TuningCommand, MeasuresOnceAndReportsExpectedAndObservedErrors) {
  scene("", R"(, "coupling": {"max_proxy_error": 1e-6})");
  const auto first = replay({});
  ASSERT_EQ(first.exit_code, 0) << first.err;
  EXPECT_NE(first.out.find("max_proxy_error 1e-06: curve "), std::string::npos) << first.out;
  EXPECT_LT(first.out.find("expected: error"), first.out.find("observed: error")) << first.out;
  const std::string cached = test::read_file(only_file());
  // Another target uses the same cached curves, and the cache is a readable tradeoff report.
  const auto second = replay({"--max-proxy-error", "1e-2"});
  ASSERT_EQ(second.exit_code, 0) << second.err;
  EXPECT_EQ(test::read_file(only_file()), cached);
  EXPECT_TRUE(app::tuning::is_report(only_file()));
  // A damaged cache is reported and measured again.
  test::write_file(only_file(), cached.substr(0, 1000));
  const auto third = replay({});
  ASSERT_EQ(third.exit_code, 0) << third.err;
  EXPECT_NE(third.out.find("the file is damaged; the file is ignored, and the costs are measured anew"), std::string::npos) << third.out;
  EXPECT_TRUE(app::tuning::read_report(only_file()));
}

TEST_F(TuningCommand, KeepsSettingsOfTheScene) {
  scene(R"(, "method": "rk4")");
  const auto pinned = replay({"--max-proxy-error", "1"});
  ASSERT_EQ(pinned.exit_code, 0) << pinned.err;
  EXPECT_NE(pinned.out.find("all streamline links state their settings"), std::string::npos) << pinned.out;
  scene(R"(, "method": "dp54")");
  const auto half = replay({"--max-proxy-error", "1e-5"});
  ASSERT_EQ(half.exit_code, 0) << half.err;
  EXPECT_NE(half.out.find("curve dp54, tolerance 1e-"), std::string::npos) << half.out;
  scene(R"(, "tolerance": 2e-6, "follow": "online")");
  const auto tolerance = replay({"--max-proxy-error", "1e-13"});
  ASSERT_EQ(tolerance.exit_code, 0) << tolerance.err;
  EXPECT_EQ(tolerance.out.find("selected"), std::string::npos) << tolerance.out;
  EXPECT_EQ(tolerance.out.find("1e-07"), std::string::npos) << tolerance.out;
}

TEST_F(TuningCommand, ARecordingReplaysBitExactlyWithAnyCache) {
  const std::string path = scene("", R"(, "coupling": {"max_proxy_error": 1e-2})");
  const std::string log = folder_ / "r.catlog";
  const auto recorded = test::run_catena({"feel", path, "--device", "simulated", "--seconds", "0.3", "--realtime", "off", "--record", log});
  ASSERT_EQ(recorded.exit_code, 0) << recorded.err;
  EXPECT_NE(recorded.out.find("max_proxy_error 0.01: curve "), std::string::npos) << recorded.out;
  EXPECT_NE(recorded.out.find("observed: error"), std::string::npos) << recorded.out;
  const auto repeats = [&](const std::vector<std::string>& words) {
    const auto run = test::run_catena(words);
    EXPECT_EQ(run.exit_code, 0) << run.err;
    EXPECT_NE(run.out.find("all bit-identical"), std::string::npos) << run.out;
  };
  // A falsified cache: every setting is exact, and all times are changed.
  std::string falsified = test::read_file(only_file());
  for (std::size_t at = 0; (at = falsified.find("\"error\": ", at)) != std::string::npos; at += 9)
    if (const auto end = falsified.find_first_of(",}", at); falsified[at + 9] != 'n') falsified.replace(at + 9, end - at - 9, "1e-15");
  for (std::size_t at = 0; (at = falsified.find("\"median\": ", at)) != std::string::npos; at += 10) falsified.insert(at + 10, "9");
  test::write_file(only_file(), falsified);
  ASSERT_TRUE(app::tuning::read_report(only_file()));
  repeats({"replay", "--log", log});
  repeats({"replay", path, "--log", log});
  std::filesystem::remove_all(folder_ / "cache");
  repeats({"replay", "--log", log});
  EXPECT_FALSE(std::filesystem::exists(folder_ / "cache"));  // a replay measures nothing
  EXPECT_EQ(test::run_catena({"replay", "--log", log, "--max-proxy-error", "1"}).exit_code, 2);
}

TEST_F(TuningCommand, ASampledFieldBecomesCubicWhereThatReducesTheError) {
  ASSERT_EQ(test::run_catena({"generate", "lamb-oseen", "--resolution", "25", "-o", folder_ / "g.vdb"}).exit_code, 0);
  const auto scene_with = [&](const char* name, const std::string& field) {
    test::write_file(folder_ / name, R"({"fields": {"flow": )" + field + R"(}, "workspace": {"metres_per_unit": 0.05},
      "chain": [{"name": "curve", "type": "streamline", "field": "flow", "seed": [0.6, 0, 0]}], "coupling": {"max_proxy_error": 1e-4}})");
    return folder_ / name;
  };
  const auto last_proxy = [&](const std::string& scene) {
    const auto run = test::run_catena({"replay", scene, "--probe", folder_ / "p.csv", "-o", folder_ / "out.csv"});
    EXPECT_EQ(run.exit_code, 0) << run.err;
    const test::Table table = test::Table::read(folder_ / "out.csv");
    const auto last = [&](const char* column) { return table.number(table.rows() - 1, column); };
    return std::pair(run.out, Vec3{last("curve_x"), last("curve_y"), last("curve_z")});
  };
  const auto [exact, truth] = last_proxy(scene_with("exact.json", R"({"analytic": "lamb-oseen"})"));
  const auto [stated, linear] = last_proxy(scene_with("stated.json", R"({"file": "g.vdb", "interpolation": "linear"})"));
  const std::string open = scene_with("open.json", R"({"file": "g.vdb"})");
  const auto [planned, cubic] = last_proxy(open);
  EXPECT_EQ(exact.find("cubic"), std::string::npos) << exact;
  EXPECT_EQ(stated.find("cubic"), std::string::npos) << stated;
  EXPECT_NE(planned.find("field flow cubic"), std::string::npos) << planned;
  EXPECT_LT(norm(cubic - truth), 0.2 * norm(linear - truth));
  // The interpolation is chosen before the first tick and is part of the recording.
  const std::string log = folder_ / "r.catlog";
  const auto recorded = test::run_catena({"feel", open, "--device", "simulated", "--seconds", "0.2", "--realtime", "off", "--record", log});
  ASSERT_EQ(recorded.exit_code, 0) << recorded.err;
  std::filesystem::remove_all(folder_ / "cache");
  for (const auto& words : {std::vector<std::string>{"replay", "--log", log}, {"replay", open, "--log", log}}) {
    const auto again = test::run_catena(words);
    EXPECT_EQ(again.exit_code, 0) << again.err;
    EXPECT_NE(again.out.find("all bit-identical"), std::string::npos) << again.out;
  }
}

TEST_F(TuningCommand, BadTargetsAreOneLine) {
  const std::string path = scene();
  const auto refused = [&](const std::vector<std::string>& words) {
    const auto run = replay(words);
    EXPECT_EQ(run.exit_code, 2) << words.front();
    EXPECT_EQ(std::count(run.err.begin(), run.err.end(), '\n'), 1) << run.err;
    EXPECT_FALSE(test::exists(folder_ / "out.csv"));
    return run.err;
  };
  for (const char* value : {"", "0", "-1", "nan", "x"}) refused({"--max-proxy-error", value});
  refused({"--max-tick-us", "inf"});
  refused({"--max-proxy-error", "1", "--max-tick-us", "1"});
  EXPECT_NE(refused({"--plan", "error=2"}).find("is now \"--quality, --max-proxy-error or --max-tick-us\""), std::string::npos);
  for (const char* coupling : {R"({"max_proxy_error": 0})", R"({"max_tick_us": "x"})", R"({"max_proxy_error": 1, "max_tick_us": 1})"}) {
    scene("", std::string(", \"coupling\": ") + coupling);
    refused({"--field", "flow=none"});
  }
  EXPECT_EQ(test::run_catena({"render", path, "-o", folder_ / "x.png", "--max-tick-us", "5"}).exit_code, 2);  // no haptics in render
}

}  // namespace tuning_commands_test
