// SPDX-License-Identifier: MIT
/// Tuning in the commands.
#include <fmt/format.h>

#include <filesystem>

#include "engine/app/tuning/report/report.h"
#include "engine/base/vec.h"
#include "tests/engine/app/environment_variable.h"
#include "tests/engine/app/program_in_folder.h"

namespace tuning_commands_test {

using namespace catena;
using test::expect_parts;

constexpr const char* kScene = R"({"fields": {"flow": {"analytic": "helix"}},
  "chain": [{"name": "curve", "type": "streamline", "field": "flow", "seed": [0.6, 0, -1.2]%s}],
  "workspace": {"metres_per_unit": 0.05}%s})";

/// The program with a separate cache folder.
class TuningCommand : public test::ProgramInFolder {
 protected:
  void SetUp() override {
    std::string csv = "t,x,y,z\n";
    for (int k = 0; k < 300; ++k) csv += fmt::format("{},{},{},{}\n", 1e-3 * k, 0.6 + 1e-4 * k, 1e-3 * k, -1.2);
    write("p.csv", csv);
  }
  void scene(const std::string& link = "", const std::string& more = "") const {
    std::string text = kScene;
    text.replace(text.find("%s"), 2, link);
    text.replace(text.find("%s"), 2, more);
    write("s.json", text);
  }
  std::string replay(const std::string& options) const { return succeed("replay {s.json} --probe {p.csv} -o {out.csv} " + options).out; }
  void expect_repeats(const std::string& line) const { expect_parts(succeed(line).out, {"all bit-identical"}); }
  std::string only_file() const {
    std::string path;
    for (const auto& entry : std::filesystem::directory_iterator(folder_ / "cache/catena/plans")) {
      EXPECT_TRUE(path.empty());
      path = entry.path().string();
    }
    return path;
  }
  const test::EnvironmentVariable cache_{"XDG_CACHE_HOME", folder_ / "cache"};
};

TEST_F(TuningCommand, MeasuresOnceAndReportsExpectedAndObservedErrors) {
  scene("", R"(, "coupling": {"max_proxy_error": 1e-6})");
  const std::string first = replay("");
  expect_parts(first, {"max_proxy_error 1e-06: curve "});
  EXPECT_LT(first.find("expected: error"), first.find("observed: error")) << first;
  const std::string cached = test::read_file(only_file());
  // Another target uses the same cached curves, and the cache is a readable tradeoff report.
  replay("--max-proxy-error 1e-2");
  EXPECT_EQ(test::read_file(only_file()), cached);
  EXPECT_TRUE(app::tuning::is_report(only_file()));
  // A damaged cache is reported and measured again.
  test::write_file(only_file(), cached.substr(0, 1000));
  expect_parts(replay(""), {"the file is damaged; the file is ignored, and the costs are measured anew"});
  EXPECT_TRUE(app::tuning::read_report(only_file()));
}

TEST_F(TuningCommand, KeepsSettingsOfTheScene) {
  scene(R"(, "method": "rk4")");
  expect_parts(replay("--max-proxy-error 1"), {"all streamline links state their settings"});
  scene(R"(, "method": "dp54")");
  expect_parts(replay("--max-proxy-error 1e-5"), {"curve dp54, tolerance 1e-"});
  scene(R"(, "tolerance": 2e-6, "follow": "online")");
  const std::string tolerance = replay("--max-proxy-error 1e-13");
  for (const char* other : {"selected", "1e-07"}) EXPECT_EQ(tolerance.find(other), std::string::npos) << tolerance;
}

TEST_F(TuningCommand, ARecordingReplaysBitExactlyWithAnyCache) {
  scene("", R"(, "coupling": {"max_proxy_error": 1e-2})");
  const auto recorded = succeed("feel {s.json} --device simulated --seconds 0.3 --realtime off --record {r.catlog}");
  expect_parts(recorded.out, {"max_proxy_error 0.01: curve ", "observed: error"});
  // A falsified cache: every setting is exact, and all times are changed.
  std::string falsified = test::read_file(only_file());
  for (std::size_t at = 0; (at = falsified.find("\"error\": ", at)) != std::string::npos; at += 9)
    if (const auto end = falsified.find_first_of(",}", at); falsified[at + 9] != 'n') falsified.replace(at + 9, end - at - 9, "1e-15");
  for (std::size_t at = 0; (at = falsified.find("\"median\": ", at)) != std::string::npos; at += 10) falsified.insert(at + 10, "9");
  test::write_file(only_file(), falsified);
  ASSERT_TRUE(app::tuning::read_report(only_file()));
  expect_repeats("replay --log {r.catlog}");
  expect_repeats("replay {s.json} --log {r.catlog}");
  std::filesystem::remove_all(folder_ / "cache");
  expect_repeats("replay --log {r.catlog}");
  EXPECT_FALSE(std::filesystem::exists(folder_ / "cache"));  // a replay measures nothing
  expect_refused("replay --log {r.catlog} --max-proxy-error 1", {});
}

TEST_F(TuningCommand, ASampledFieldBecomesCubicWhereThatReducesTheError) {
  succeed("generate lamb-oseen --resolution 25 -o {g.vdb}");
  const auto last_proxy = [&](const std::string& name, const std::string& field) {
    write(name, R"({"fields": {"flow": )" + field + R"(}, "workspace": {"metres_per_unit": 0.05},
      "chain": [{"name": "curve", "type": "streamline", "field": "flow", "seed": [0.6, 0, 0]}], "coupling": {"max_proxy_error": 1e-4}})");
    const auto run = succeed("replay {" + name + "} --probe {p.csv} -o {out.csv}");
    const test::Table table = test::Table::read(folder_ / "out.csv");
    const auto last = [&](const char* column) { return table.number(table.rows() - 1, column); };
    return std::pair(run.out, Vec3{last("curve_x"), last("curve_y"), last("curve_z")});
  };
  const auto [exact, truth] = last_proxy("exact.json", R"({"analytic": "lamb-oseen"})");
  const auto [stated, linear] = last_proxy("stated.json", R"({"file": "g.vdb", "interpolation": "linear"})");
  const auto [planned, cubic] = last_proxy("open.json", R"({"file": "g.vdb"})");
  EXPECT_EQ(exact.find("cubic"), std::string::npos) << exact;
  EXPECT_EQ(stated.find("cubic"), std::string::npos) << stated;
  expect_parts(planned, {"field flow cubic"});
  EXPECT_LT(norm(cubic - truth), 0.2 * norm(linear - truth));
  // The interpolation is chosen before the first tick and is part of the recording.
  succeed("feel {open.json} --device simulated --seconds 0.2 --realtime off --record {r.catlog}");
  std::filesystem::remove_all(folder_ / "cache");
  expect_repeats("replay --log {r.catlog}");
  expect_repeats("replay {open.json} --log {r.catlog}");
}

TEST_F(TuningCommand, BadTargetsAreOneLine) {
  scene();
  const auto refused = [&](const std::vector<std::string>& words, const std::string& part = "") {
    expect_refused("replay {s.json} --probe {p.csv} -o {out.csv}", {part}, words);
  };
  for (const char* value : {"", "0", "-1", "nan", "x"}) refused({"--max-proxy-error", value});
  refused({"--max-tick-us", "inf"});
  refused({"--max-proxy-error", "1", "--max-tick-us", "1"});
  refused({"--plan", "error=2"}, "is now \"--quality, --max-proxy-error or --max-tick-us\"");
  for (const char* coupling : {R"({"max_proxy_error": 0})", R"({"max_tick_us": "x"})", R"({"max_proxy_error": 1, "max_tick_us": 1})"}) {
    scene("", std::string(", \"coupling\": ") + coupling);
    refused({"--field", "flow=none"});
  }
  expect_refused("render {s.json} -o {x.png} --max-tick-us 5", {});  // no haptics in render
}

}  // namespace tuning_commands_test
