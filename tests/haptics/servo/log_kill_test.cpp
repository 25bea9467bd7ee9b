// SPDX-License-Identifier: MIT
/// A recording whose process is killed at any moment opens, has no gap, and replays bit for bit.
#include <gtest/gtest.h>
#include <sys/wait.h>

#include <csignal>
#include <filesystem>

#include "tests/haptics/servo/log_fixture.h"
#include "tests/support/child_test.h"

namespace catena::test::log_kill_test {

// Child process of the next test: records until it is killed. Skipped without a path in CATENA_LOG_OF_THE_CHILD.
TEST(LogKill, DISABLED_RecordsUntilItIsKilled) {
  const std::string path = test::child_variable("CATENA_LOG_OF_THE_CHILD");
  if (path.empty()) GTEST_SKIP() << "the child of LogKill.EveryKilledRecordingOpensAndReplaysExactly";
  auto writer = LogWriter::open(path, {}, {}, fast_flush());
  ASSERT_TRUE(writer);
  // one program per 200 ticks, independent of thread scheduling
  constexpr std::uint64_t kTicks = 200;
  PathDevice device(test::adversarial_path(1000), kTicks, writer->get());
  const auto first = make_numbered_program(1);
  (*writer)->add_program(*first);
  Servo servo(device, first, {.rate_hz = 1000, .paced = false, .sink = writer->get()});
  EXPECT_TRUE(servo.start());
  HapticState seen;
  for (std::uint64_t epoch = 2;; ++epoch) {
    while (seen.tick < kTicks * (epoch - 1)) {
      servo.receive(seen);
      std::this_thread::yield();
    }
    const auto program = make_numbered_program(epoch);
    (*writer)->add_program(*program);
    servo.set_program(program);
    device.allowed = kTicks * epoch;
  }
}

TEST(LogKill, EveryKilledRecordingOpensAndReplaysExactly) {
  const test::TemporaryFolder folder;
  std::uint64_t programs = 0;
  for (int moment = 0; moment < 24; ++moment) {
    const std::string path = folder / ("k" + std::to_string(moment) + ".catlog");
    const pid_t child = test::start_case("LogKill.DISABLED_*", {.environment = {"CATENA_LOG_OF_THE_CHILD=" + path}});
    // kill after `enough` bytes and a short delay
    const auto enough = static_cast<std::uintmax_t>(4000 + 12000 * moment);
    std::error_code code;
    int status = 0;
    while (waitpid(child, &status, WNOHANG) == 0 &&
           (!std::filesystem::exists(path, code) || std::filesystem::file_size(path, code) < enough))
      std::this_thread::yield();
    std::this_thread::sleep_for(std::chrono::microseconds(137 * moment));
    kill(child, SIGKILL);
    waitpid(child, &status, 0);
    ASSERT_TRUE(WIFSIGNALED(status) && WTERMSIG(status) == SIGKILL);

    auto reader = LogReader::open(path);
    ASSERT_TRUE(reader) << reader.error().message;
    SCOPED_TRACE(moment);
    const LogReplay result = replay_numbered(*reader);
    EXPECT_FALSE(reader->end().has_value());
    EXPECT_FALSE(reader->damaged()) << reader->end_summary();
    EXPECT_EQ(result.stats.ticks, reader->last_tick());
    // the first block of 200 ticks may be truncated
    if (moment > 4) {
      EXPECT_GE(result.stats.ticks, 1u) << moment;
    }
    programs = std::max(programs, reader->program().epoch);
  }
  EXPECT_GE(programs, 3u) << "some were killed after a change of the program";
}

}  // namespace catena::test::log_kill_test
