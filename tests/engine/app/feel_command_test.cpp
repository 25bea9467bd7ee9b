// SPDX-License-Identifier: MIT
/// The command `catena feel`.
#include <pty.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <future>
#include <thread>

#include "engine/base/json.h"
#include "tests/engine/app/program_in_folder.h"

namespace catena::feel_command_test {

constexpr const char* kScene = R"({
  "fields": {"v": {"analytic": "circle"}},
  "chain": [{"name": "c", "type": "streamline", "field": "v", "seed": [1, 0, 0]}])";

class FeelCommand : public test::ProgramInFolder {
 protected:
  void scene(const std::string& device = "") { write("s.json", kScene + (device.empty() ? "" : ", \"device\": " + device) + "}"); }
  /// Runs for a fifth of a second and returns the statistics.
  json::Node stats(const std::string& more, const std::string& device = "") {
    scene(device);
    const test::ProgramResult done = succeed("feel {s.json} --seconds 0.2 --stats {stats.json} " + more);
    out_ = done.out;
    err_ = done.err;
    auto node = json::parse(read("stats.json"), "stats.json");
    EXPECT_TRUE(node);
    return node ? *node : json::Node{};
  }

  std::string out_, err_;
};

TEST_F(FeelCommand, RunsTheServoAndWritesItsStatistics) {
  const json::Node root = stats("");
  EXPECT_EQ(root.find("device")->string.find("simulated"), 0u) << "the default device";
  EXPECT_EQ(root.find("rate_hz")->number, 1000);
  EXPECT_GT(root.find("ticks")->number, 0);
  EXPECT_GE(root.find("seconds")->number, 0.2);
  EXPECT_EQ(root.find("compute_us")->find("count")->number, root.find("ticks")->number);
  for (const char* name : {"period_us", "compute_us", "device_us"}) {
    const json::Node& figures = *root.find(name);
    EXPECT_GT(figures.find("max")->number, 0) << name;
    EXPECT_LE(figures.find("p50")->number, figures.find("p99")->number) << name;
    EXPECT_LE(figures.find("p999")->number, figures.find("max")->number) << name;
  }
  EXPECT_EQ(root.find("state_hash")->string.size(), 16u);
  EXPECT_NE(out_.find("forces off"), std::string::npos) << out_;
  EXPECT_NE(out_.find("missed deadlines"), std::string::npos) << out_;
  // Each real-time setting that was not permitted has one note.
  const json::Node& realtime = *root.find("realtime");
  EXPECT_EQ(static_cast<std::size_t>(std::count(err_.begin(), err_.end(), '\n')), realtime.find("notes")->items.size()) << err_;
}

TEST_F(FeelCommand, OptionsOverrideTheScenesDeviceAndThatOverridesTheDefault) {
  const std::string device = R"({"type": "null", "rate": 500})";
  EXPECT_EQ(stats("", device).find("rate_hz")->number, 500);
  EXPECT_EQ(stats("--rate 2000", device).find("rate_hz")->number, 2000);
  const json::Node other = stats("--device simulated --forces on", device);
  EXPECT_EQ(other.find("rate_hz")->number, 1000) << "what the scene says is for its own device";
  EXPECT_NE(err_.find("describes a device of type null; it is not used for simulated"), std::string::npos) << err_;
  EXPECT_NE(out_.find("forces on"), std::string::npos) << out_;
}

TEST_F(FeelCommand, WithRealtimeOffThereAreNoNotes) {
  const json::Node root = stats("--realtime off");
  EXPECT_FALSE(root.find("realtime")->find("fifo")->boolean);
  EXPECT_FALSE(root.find("realtime")->find("locked")->boolean);
  EXPECT_TRUE(root.find("realtime")->find("cpu")->is_null());
  EXPECT_EQ(err_, "");
}

TEST_F(FeelCommand, CtrlCEndsItCleanly) {
  scene();
  const test::ProgramResult run = test::run_program("/usr/bin/timeout", {"--preserve-status", "-s", "INT", "1", test::program_path(),
                                                                         "feel", folder_ / "s.json", "--stats", folder_ / "stats.json"});
  EXPECT_EQ(run.exit_code, 0) << run.err;
  EXPECT_TRUE(exists("stats.json"));
  EXPECT_NE(run.out.find("ticks in"), std::string::npos) << run.out;
}

/// Runs on a terminal that is stopped after a moment, and returns the exit code, or -1 if the program had to be killed.
int run_on_stopped_terminal(const std::vector<std::string>& words, int signal_number) {
  int terminal = -1;
  const pid_t child = ::forkpty(&terminal, nullptr, nullptr, nullptr);
  if (child == 0) {
    std::vector<char*> arguments;
    std::string program = test::program_path();
    std::vector<std::string> all = words;
    arguments.push_back(program.data());
    for (std::string& word : all) arguments.push_back(word.data());
    arguments.push_back(nullptr);
    ::execv(program.c_str(), arguments.data());
    ::_exit(127);
  }
  const auto sleep_ms = [](int ms) { std::this_thread::sleep_for(std::chrono::milliseconds(ms)); };
  sleep_ms(1300);  // the status line comes once a second
  const char stop = 'S' - '@';
  EXPECT_EQ(::write(terminal, &stop, 1), 1);
  sleep_ms(1200);
  if (signal_number != 0) ::kill(child, signal_number);
  int status = 0;
  for (int i = 0; i < 300; ++i) {
    if (::waitpid(child, &status, WNOHANG) == child) {
      ::close(terminal);
      return WIFEXITED(status) ? WEXITSTATUS(status) : 1000 + WTERMSIG(status);
    }
    sleep_ms(100);
  }
  ::kill(child, SIGKILL);
  ::close(terminal);
  ::waitpid(child, &status, 0);
  return -1;
}

// The status line must not wait for the terminal: the time limit, signals and the end of the program do not depend on the terminal.
TEST_F(FeelCommand, AStoppedTerminalDoesNotBlockTheProgram) {
  scene();
  const auto words = [&](std::vector<std::string> more) {
    more.insert(more.begin(), {"feel", folder_ / "s.json", "--device", "emulated-falcon", "--forces", "on"});
    return more;
  };
  const auto soon = words({"--seconds", "3", "--stats", folder_ / "stats.json"}), late = words({"--seconds", "600"}), later = late;
  auto in_time = std::async(std::launch::async, [&] { return run_on_stopped_terminal(soon, 0); });
  auto asked = std::async(std::launch::async, [&] { return run_on_stopped_terminal(late, SIGTERM); });
  EXPECT_EQ(run_on_stopped_terminal(later, SIGINT), 0);
  EXPECT_EQ(asked.get(), 0);
  EXPECT_EQ(in_time.get(), 0);
  EXPECT_TRUE(exists("stats.json"));
}

TEST_F(FeelCommand, BadInputIsOneLine) {
  const std::pair<const char*, const char*> bad[] = {
      {"--device nonsense", "there is no device \"nonsense\""},
      {"--rate 50", "--rate"},
      {"--rate 20000", "--rate"},
      {"--rate nan", "--rate: \"nan\" is out of range; a finite number from 100 to 10000 was expected"},
      {"--seconds nan", "--seconds: \"nan\" is out of range; a finite number of at least 0 was expected"},
      {"--seconds -1", "--seconds: \"-1\" is out of range; a finite number of at least 0"},
      {"--forces maybe", "--forces"}};
  scene();
  for (const auto& [more, part] : bad) expect_refused("feel {s.json} --stats {stats.json} " + std::string(more), {part});
  expect_refused("feel {s.json} --stats {none/stats.json}", {"none"});
  expect_refused("feel grid.vdb", {"a scene file (.json) with a chain was expected"});
  for (const auto& [device, part] : {std::pair{R"({"type": "simulated", "colour": 3})", "colour"}, {R"({"rate": 500})", "type"}}) {
    scene(device);
    expect_refused("feel {s.json} --seconds 0.1 --stats {stats.json}", {part});
  }
}

}  // namespace catena::feel_command_test
