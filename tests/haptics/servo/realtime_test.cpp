// SPDX-License-Identifier: MIT
#include "haptics/servo/realtime.h"

#include <gtest/gtest.h>
#include <linux/capability.h>
#include <sched.h>
#include <sys/resource.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <csignal>
#include <cstdlib>

#include "tests/haptics/device/scripted_device.h"
#include "tests/haptics/servo/run_servo.h"
#include "tests/support/child_test.h"

namespace catena::haptics::realtime_test {

/// Drops every privilege of the calling thread only.
bool drop_privileges() {
  __user_cap_header_struct header{_LINUX_CAPABILITY_VERSION_3, 0};
  __user_cap_data_struct none[_LINUX_CAPABILITY_U32S_3] = {};
  return syscall(SYS_capset, &header, none) == 0;
}

TEST(Realtime, WithoutPrivilegesTheNotesNameWhatIsMissingAndTheRemedy) {
  rlimit priority{}, memory{};
  if (getrlimit(RLIMIT_RTPRIO, &priority) != 0 || priority.rlim_cur > 0 || getrlimit(RLIMIT_MEMLOCK, &memory) != 0 ||
      memory.rlim_cur == RLIM_INFINITY)
    GTEST_SKIP() << "everybody may do it here";
  RealtimeReport report;
  bool dropped = false;
  std::array<char, 4096> own{};
  std::thread([&] {
    dropped = drop_privileges();
    report = RealtimeThread({}, own.data(), own.size()).report();
  }).join();
  ASSERT_TRUE(dropped);
  EXPECT_FALSE(report.fifo);
  EXPECT_FALSE(report.locked);
  EXPECT_EQ(report.cpu, -1) << "a normal thread stays free to move";
  ASSERT_EQ(report.notes.size(), 2u);
  EXPECT_EQ(report.notes[0].find("real-time scheduling was not permitted"), 0u) << report.notes[0];
  for (const std::string& note : report.notes)
    EXPECT_NE(note.find(": join the group catena of the Debian package (`adduser YOU catena`) and log in again"), std::string::npos)
        << note;
  EXPECT_NE(report.notes[0].find("or raise rtprio in /etc/security/limits.d"), std::string::npos) << report.notes[0];
  EXPECT_NE(report.notes[1].find("or raise memlock in /etc/security/limits.d"), std::string::npos) << report.notes[1];
}

TEST(Realtime, AMissingCoreIsReportedAndTheServoRuns) {
  NullDevice device;
  Servo servo(device, std::make_shared<HapticProgram>(),
              {.max_ticks = 5, .realtime = {.fifo = false, .lock_memory = false, .cpu = 100000}});
  test::run_to_end(servo);
  const ServoStats r = servo.stats();
  EXPECT_EQ(r.ticks, 5u);
  EXPECT_EQ(r.realtime.cpu, -1);
  ASSERT_EQ(r.realtime.notes.size(), 1u);
  EXPECT_NE(r.realtime.notes[0].find("core 100000"), std::string::npos);
}

TEST(Realtime, EveryRequestIsGrantedOrHasANote) {
  NullDevice device;
  Servo servo(device, std::make_shared<HapticProgram>(), {.max_ticks = 5});
  test::run_to_end(servo);
  const RealtimeReport r = servo.stats().realtime;
  const std::size_t refused = (r.fifo ? 0u : 1u) + (r.locked ? 0u : 1u);
  EXPECT_EQ(r.notes.size(), refused);
  for (const std::string& note : r.notes) EXPECT_NE(note.find("join the group catena"), std::string::npos) << note;
  if (!r.fifo) {
    EXPECT_EQ(r.cpu, -1) << "bound to a core only with a fixed priority";
    return;
  }
  rlimit limit{};
  ASSERT_EQ(getrlimit(RLIMIT_RTTIME, &limit), 0);
  EXPECT_LE(limit.rlim_cur, static_cast<rlim_t>(1e6 * kRealtimeSoftLimit_s));
  EXPECT_LE(limit.rlim_max, static_cast<rlim_t>(1e6 * kRealtimeHardLimit_s));
}

/// A device whose read takes longer than a period at 10 kHz.
struct Slow final : test::ScriptedDevice {
  DeviceInput read() noexcept override {
    std::this_thread::sleep_for(std::chrono::microseconds(150));
    return {};
  }
};

TEST(Realtime, FixedPriorityIsDroppedWhenTicksNeverFitThePeriod) {
  Slow device;
  Servo servo(device, std::make_shared<HapticProgram>(), {.rate_hz = 10000, .max_ticks = 1010});
  EXPECT_TRUE(servo.start());
  const bool granted = servo.stats().realtime.fifo;
  while (servo.running()) std::this_thread::sleep_for(std::chrono::milliseconds(1));
  servo.stop();
  if (!granted) GTEST_SKIP() << "no fixed priority here";
  const ServoStats r = servo.stats();
  EXPECT_GE(r.missed_deadlines, 1009u);
  EXPECT_FALSE(r.realtime.fifo);
  ASSERT_FALSE(r.realtime.notes.empty());
  EXPECT_NE(r.realtime.notes.back().find("given up"), std::string::npos);
}

/// Hangs in one read until it is stopped; records the number of cores that its watchdog may run on.
struct Stuck final : test::ScriptedDevice {
  DeviceInput read() noexcept override {
    for (int i = 0; i < 10000 && cores == 0; ++i) std::this_thread::sleep_for(std::chrono::milliseconds(1));
    return {};
  }
  void stop() noexcept override {
    cpu_set_t set;
    if (cores == 0 && sched_getaffinity(0, sizeof set, &set) == 0) cores = CPU_COUNT(&set);
  }
  std::atomic<int> cores{0};
};

TEST(Realtime, TheWatchdogIsNotPinnedToTheServosCore) {
  cpu_set_t allowed;
  ASSERT_EQ(sched_getaffinity(0, sizeof allowed, &allowed), 0);
  if (CPU_COUNT(&allowed) < 2) GTEST_SKIP() << "one core";
  int core = 0;
  while (!CPU_ISSET(static_cast<unsigned>(core), &allowed)) ++core;
  Stuck device;
  Servo servo(device, std::make_shared<HapticProgram>(), {.max_ticks = 2, .realtime = {.fifo = false, .lock_memory = false, .cpu = core}});
  test::run_to_end(servo);
  EXPECT_EQ(servo.stats().realtime.cpu, core);
  EXPECT_GE(servo.stats().watchdog_trips, 1u);
  EXPECT_EQ(device.cores, CPU_COUNT(&allowed));
}

TEST(Realtime, FixedPriorityIsPerThreadAndRestored) {
  const int before = sched_getscheduler(0);
  RealtimeReport report;
  std::thread([&] {
    {
      const RealtimeThread prepared({.lock_memory = false}, nullptr, 0);
      report = prepared.report();
      EXPECT_EQ((sched_getscheduler(0) & ~SCHED_RESET_ON_FORK) == SCHED_FIFO, report.fifo);
    }
    EXPECT_EQ(sched_getscheduler(0) & ~SCHED_RESET_ON_FORK, SCHED_OTHER);
  }).join();
  EXPECT_EQ(sched_getscheduler(0), before);
  EXPECT_EQ(report.notes.empty(), report.fifo);
}

TEST(Realtime, DISABLED_LoopsForeverAtFixedPriority) {
  std::vector<std::string> notes;
  if (!acquire_fifo_priority(1, notes)) _exit(77);
  limit_realtime_run(0.05, 0.2);
  std::signal(SIGXCPU, std::getenv("CATENA_IGNORES_XCPU") != nullptr ? SIG_IGN : SIG_DFL);
  for (std::atomic<int> n{0};; ++n) {
  }
}

TEST(Realtime, AnEndlessTickIsKilledByTheRealtimeLimit) {
  for (const bool ignores : {false, true}) {
    const pid_t child = test::start_case("Realtime.DISABLED_LoopsForeverAtFixedPriority",
                                         {.environment = {ignores ? "CATENA_IGNORES_XCPU=1" : "CATENA_OTHER=1"}});
    int status = 0;
    ASSERT_EQ(waitpid(child, &status, 0), child);
    if (WIFEXITED(status) && WEXITSTATUS(status) == 77) GTEST_SKIP() << "a fixed priority is not permitted here";
    EXPECT_TRUE(WIFSIGNALED(status)) << status;
    EXPECT_EQ(WTERMSIG(status), ignores ? SIGKILL : SIGXCPU);
  }
}

}  // namespace catena::haptics::realtime_test
