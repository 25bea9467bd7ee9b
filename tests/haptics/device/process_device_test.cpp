// SPDX-License-Identifier: MIT
// A device in a separate process: the force after the program is killed or stopped, observed from outside.
#include <gtest/gtest.h>
#include <sched.h>
#include <sys/mount.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <functional>
#include <sstream>
#include <thread>

#include "haptics/device/process/force_table.h"
#include "haptics/device/process/process_device.h"
#include "tests/haptics/device/wait_until.h"
#include "tests/support/results.h"
#include "tests/support/support.h"

namespace catena::haptics::process_device_test {

struct Forces {
  double last_push_s = -1, last_s = -1;
  Vec3 last_n{0.0};
};

Forces forces_in(const std::string& path) {
  Forces forces;
  const std::string text = test::read_file(path);
  std::istringstream lines(text.substr(0, text.rfind('\n') + 1));
  std::string line;
  std::getline(lines, line);
  while (std::getline(lines, line)) {
    double t = 0;
    Vec3 f{0.0};
    if (std::sscanf(line.c_str(), "%lf,%lf,%lf,%lf", &t, &f.x, &f.y, &f.z) != 4) continue;
    forces.last_s = t;
    forces.last_n = f;
    if (f != Vec3(0.0)) forces.last_push_s = t;
  }
  return forces;
}

using test::wait_until;

/// Commands 1 N, effective once the emulated hand has homed and armed the device; never returns.
[[noreturn]] void push_forever(const std::string& table) {
  auto device = open_in_process("emulated-falcon:still", table, {});
  if (!device) _exit(1);
  for (;;) {
    (*device)->read();
    DeviceOutput output;
    output.force_n = {0, 0, 1};
    (*device)->write(output);
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
}

TEST(ProcessDevice, TheForceIsZeroAfterTheProgramIsKilledOrStopped) {
  for (const int signal_number : {SIGKILL, SIGSTOP}) {
    const test::TemporaryFolder folder;
    const std::string table = folder / "t.csv";
    const pid_t program = fork();
    if (program == 0) push_forever(table);
    ASSERT_TRUE(wait_until([&] { return test::exists(table) && forces_in(table).last_push_s > 0; })) << "the emulated hand arms in 3 s";
    kill(program, signal_number);
    // at least 10 rows of zero: the process runs on for 100 ms
    EXPECT_TRUE(wait_until([&] {
      const Forces now = forces_in(table);
      return now.last_s > now.last_push_s + 0.05;
    }));
    const Forces forces = forces_in(table);
    EXPECT_EQ(forces.last_n, Vec3(0.0));
    if (signal_number == SIGSTOP) kill(program, SIGKILL);
    waitpid(program, nullptr, 0);
  }
}

TEST(ProcessDevice, AnUnknownDeviceAndAnUnwritableTableAreErrors) {
  EXPECT_TRUE(test::fails(open_in_process("emulated-falcon:nonsense", "", {}), "emulated-falcon:still"));
  const auto full = open_in_process("emulated-falcon", "/dev/null/t.csv", {});
  ASSERT_FALSE(full);
  EXPECT_FALSE(full.error().system_failure);
  const test::TemporaryFolder folder;
  ASSERT_EQ(mkfifo((folder / "pipe").c_str(), 0600), 0);
  for (const std::string& path : {folder / "pipe", std::string("/dev/full"), folder.path()}) {
    const auto strange = open_in_process("emulated-falcon", path, {});
    ASSERT_TRUE(test::fails(strange, "regular file")) << path;
    EXPECT_FALSE(strange.error().system_failure);
  }
}

/// The exit code of `work` in a process whose `folder` is a disk of `kib` KiB; 255 if no such disk can be mounted.
int on_small_disk(const std::string& folder, int kib, const std::function<int()>& work) {
  const pid_t child = fork();
  if (child == 0) {
    const bool made = unshare(CLONE_NEWNS) == 0 && mount("none", "/", nullptr, MS_REC | MS_PRIVATE, nullptr) == 0 &&
                      mount("none", folder.c_str(), "tmpfs", 0, ("size=" + std::to_string(kib) + "k").c_str()) == 0;
    _exit(made ? work() : 255);
  }
  int status = 0;
  EXPECT_EQ(waitpid(child, &status, 0), child);
  return WIFEXITED(status) ? WEXITSTATUS(status) : 254;
}

TEST(ProcessDevice, AFullDiskIsReportedAndTheFinalZerosAreWritten) {
  const test::TemporaryFolder folder;
  const std::string path = folder / "t.csv";
  const int at_first = on_small_disk(folder.path(), 16, [&] {
    const auto table = process::open_force_table(path);
    if (table || !table.error().system_failure) return 1;
    return table.error().message.find("No space left") == std::string::npos ? 2 : test::exists(path) ? 3 : 0;
  });
  if (at_first == 255) GTEST_SKIP() << "only root can make a small disk";
  EXPECT_EQ(at_first, 0);
  // the disk holds 1.2 MB of the 2 MB of rows
  const int later = on_small_disk(folder.path(), 1200, [&] {
    std::atomic<int> error{0};
    {
      const auto file = process::open_force_table(path);
      if (!file) return 1;
      process::ForceTable table(file->get(), error);
      for (int k = 1; k <= 50'000; ++k) table.add({1 + 1e-5 * k, 2 + 1e-5 * k, 3 + 1e-5 * k});
      table.add(Vec3(0.0));
    }
    if (error != ENOSPC) return 2;
    const Forces forces = forces_in(path);
    return forces.last_n != Vec3(0.0) || forces.last_push_s < 0 ? 3 : 0;
  });
  EXPECT_EQ(later, 0);
}

}  // namespace catena::haptics::process_device_test
