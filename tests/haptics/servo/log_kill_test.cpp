/// A recording whose process is killed at any moment opens, has no hole, and repeats to the bit.
#include <fcntl.h>
#include <gtest/gtest.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <cstdlib>
#include <filesystem>

#include "tests/haptics/servo/log_fixture.h"

extern char** environ;

namespace log_kill_test {

using namespace catena;
using namespace catena::haptics;
using namespace catena::haptics::log;
using namespace catena::test;

// The child of the next test: records until it is killed. Runs only when it is told where.
TEST(LogKill, DISABLED_RecordsUntilItIsKilled) {
  const char* path = std::getenv("CATENA_LOG_OF_THE_CHILD");
  if (path == nullptr) GTEST_SKIP() << "the child of LogKill.EveryKilledRecordingOpensAndRepeats";
  auto writer = LogWriter::open(path, {}, {}, fast_flush());
  ASSERT_TRUE(writer);
  Throttled device(**writer, test::hostile_path(1000));
  // a program for 200 ticks each, however the threads are scheduled
  constexpr std::uint64_t kTicks = 200;
  const auto first = numbered_program(1);
  (*writer)->add_program(*first);
  device.allow(kTicks);
  Servo servo(device, first, {.rate_hz = 1000, .paced = false, .sink = writer->get()});
  servo.start();
  exchange::HapticState seen;
  for (std::uint64_t epoch = 2;; ++epoch) {
    while (seen.tick < kTicks * (epoch - 1)) {
      servo.take(seen);
      std::this_thread::yield();
    }
    const auto program = numbered_program(epoch);
    (*writer)->add_program(*program);
    servo.set_program(program);
    device.allow(kTicks * epoch);
  }
}

TEST(LogKill, EveryKilledRecordingOpensAndRepeats) {
  const test::TemporaryFolder folder;
  const std::string self = std::filesystem::read_symlink("/proc/self/exe").string();
  std::uint64_t all = 0, programs = 0;
  for (int moment = 0; moment < 24; ++moment) {
    const std::string path = folder / ("k" + std::to_string(moment) + ".catlog");
    std::vector<std::string> words{self, "--gtest_filter=LogKill.DISABLED_*", "--gtest_also_run_disabled_tests"};
    std::vector<char*> arguments;
    for (std::string& word : words) arguments.push_back(word.data());
    arguments.push_back(nullptr);
    std::string variable = "CATENA_LOG_OF_THE_CHILD=" + path;
    std::vector<char*> environment{variable.data()};
    for (char** e = environ; *e != nullptr; ++e)
      if (!std::string_view(*e).starts_with("GTEST_")) environment.push_back(*e);
    environment.push_back(nullptr);
    posix_spawn_file_actions_t quiet;
    posix_spawn_file_actions_init(&quiet);
    posix_spawn_file_actions_addopen(&quiet, 1, "/dev/null", O_WRONLY, 0);
    pid_t child = 0;
    ASSERT_EQ(posix_spawn(&child, self.c_str(), &quiet, nullptr, arguments.data(), environment.data()), 0);
    posix_spawn_file_actions_destroy(&quiet);
    // the moment: so many bytes, then a little more
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
    const auto result = replay_numbered(*reader);
    ASSERT_TRUE(result) << result.error().message;
    EXPECT_TRUE(result->exact()) << moment << ": tick " << result->first_differing << " " << result->difference << result->stopped;
    EXPECT_FALSE(reader->end().has_value());
    EXPECT_FALSE(reader->damaged()) << reader->ending();
    EXPECT_EQ(result->stats.ticks, reader->last_tick());
    // a first block of 200 ticks may be cut off within
    if (moment > 4) {
      EXPECT_GE(result->stats.ticks, 1u) << moment;
    }
    all += result->stats.ticks;
    programs = std::max(programs, reader->program().epoch);
  }
  EXPECT_GE(programs, 3u) << "some were killed after a change of the program";
  RecordProperty("ticks", static_cast<int>(all));
}

}  // namespace log_kill_test
