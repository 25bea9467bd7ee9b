// SPDX-License-Identifier: MIT
// The program under limits that a shell or a service manager sets: one error line and a defined exit code, never a signal.
#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <thread>

#include "tests/support/run_program.h"
#include "tests/support/support.h"

namespace catena {
namespace process_limits_test {

constexpr const char* kScene = R"({
  "fields": {"v": {"analytic": "circle"}},
  "chain": [{"name": "c", "type": "streamline", "field": "v", "seed": [1, 0, 0]}]})";

struct Limit {
  __rlimit_resource what;
  rlim_t maximum;
};

class ProcessLimits : public testing::Test {
 protected:
  ProcessLimits() { test::write_file(scene_, kScene); }

  /// Starts the program under limits; the output goes to files.
  pid_t start(const std::vector<std::string>& arguments, const std::vector<Limit>& limits) {
    const std::string program = test::program_path(), out = folder_ / "out", err = folder_ / "err";
    std::vector<char*> argv{const_cast<char*>(program.c_str())};
    for (const std::string& a : arguments) argv.push_back(const_cast<char*>(a.c_str()));
    argv.push_back(nullptr);
    const pid_t child = fork();
    if (child != 0) return child;
    const int out_fd = open(out.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600),
              err_fd = open(err.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600);
    dup2(out_fd, 1);
    dup2(err_fd, 2);
    closefrom(3);
    for (const Limit& limit : limits) {
      const rlimit both{limit.maximum, limit.maximum};
      setrlimit(limit.what, &both);
    }
    execv(program.c_str(), argv.data());
    _exit(127);
  }
  /// Waits for the program and returns the exit code, or 128 + signal if it was killed.
  int wait(pid_t child) {
    int status = 0;
    EXPECT_EQ(waitpid(child, &status, 0), child);
    err_ = test::read_file(folder_ / "err");
    return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  }
  int run(const std::vector<std::string>& arguments, const std::vector<Limit>& limits) { return wait(start(arguments, limits)); }
  std::vector<std::string> feel(const std::string& seconds = "0.1", const std::vector<std::string>& more = {}) const {
    std::vector<std::string> all{"feel", scene_, "--forces", "on", "--realtime", "off", "--seconds", seconds};
    all.insert(all.end(), more.begin(), more.end());
    return all;
  }
  void expect_one_line() { EXPECT_EQ(std::count(err_.begin(), err_.end(), '\n'), 1) << err_; }

  test::TemporaryFolder folder_;
  std::string scene_ = folder_ / "s.json", err_;
};

// The stack limit is the size of a thread's stack, and the servo needs 256 KiB.
TEST_F(ProcessLimits, ASmallStackIsRefused) {
  for (const rlim_t kib : {192, 512, 1000}) {
    EXPECT_EQ(run(feel(), {{RLIMIT_STACK, kib << 10}}), 1) << err_;
    EXPECT_NE(err_.find("catena: the stack is limited to " + std::to_string(kib) + " KiB; at least 1024 KiB were expected (ulimit -s)\n"),
              std::string::npos)
        << err_;
    expect_one_line();
  }
  EXPECT_EQ(run(feel(), {{RLIMIT_STACK, 1u << 20}}), 0) << err_;
}

// SIGXFSZ must not end the program while the force is on.
TEST_F(ProcessLimits, TheFileSizeLimitIsASystemFailure) {
  const std::string log = folder_ / "l.catlog";
  EXPECT_EQ(run(feel("1", {"--record", log}), {{RLIMIT_FSIZE, 8192}}), 1) << err_;
  EXPECT_NE(
      err_.find("l.catlog: cannot write: File too large (files may have at most 8192 bytes: ulimit -f); the recording ends with tick "),
      std::string::npos)
      << err_;
  expect_one_line();
  EXPECT_EQ(run({"generate", "sphere", "-o", folder_ / "s.vdb", "--resolution", "32"}, {{RLIMIT_FSIZE, 8192}}), 1) << err_;
  expect_one_line();
  EXPECT_FALSE(test::exists(folder_ / "s.vdb"));
}

TEST_F(ProcessLimits, TheCpuTimeLimitIsASystemFailure) {
  const pid_t child = start(feel("20"), {});
  // The kernel sends this signal at the soft limit; "forces on" is printed when the servo runs.
  while (test::read_file(folder_ / "out").find("forces on") == std::string::npos) std::this_thread::sleep_for(std::chrono::milliseconds(5));
  kill(child, SIGXCPU);
  EXPECT_EQ(wait(child), 1) << err_;
  EXPECT_NE(err_.find("catena: ended by SIGXCPU (CPU time limit exceeded); the device is off\n"), std::string::npos) << err_;
  expect_one_line();
}

#ifndef __SANITIZE_ADDRESS__  // AddressSanitizer needs descriptors of its own
// The error must not be exit code 2, as if the helper program were missing.
TEST_F(ProcessLimits, TheDescriptorLimitIsASystemFailure) {
  const std::string grid = folder_ / "g.vdb", uses = folder_ / "u.json";
  ASSERT_EQ(run({"generate", "sphere", "-o", grid, "--resolution", "8"}, {}), 0) << err_;
  test::write_file(uses, R"({"fields": {"s": {"file": "g.vdb"}}, "isosurfaces": [{"field": "s", "level": 1}]})");
  for (const rlim_t files : {6, 40})
    for (const std::vector<std::string>& arguments :
         {std::vector<std::string>{"info", grid}, {"info", uses}, {"generate", "sphere", "-o", folder_ / "o.vdb", "--resolution", "8"}}) {
      EXPECT_EQ(run(arguments, {{RLIMIT_NOFILE, files}}), 1) << arguments[1] << ": " << err_;
      expect_one_line();
      if (arguments[0] == "info") {
        EXPECT_NE(err_.find("at most " + std::to_string(files) + " files may be open at a time (ulimit -n)"), std::string::npos) << err_;
      }
    }
  EXPECT_FALSE(test::exists(folder_ / "o.vdb"));
}

// From too little memory to enough: a thread, a field or a servo without memory is one error line.
TEST_F(ProcessLimits, LittleMemoryIsOneErrorLine) {
  int ended = 0, enough = 0;
  for (rlim_t mib = 240; mib <= 640; mib += 40) {
    const int code = run(feel(), {{RLIMIT_AS, mib << 20}});
    if (code == 127) continue;  // too little for the shared libraries
    EXPECT_TRUE(code == 0 || code == 1) << mib << " MiB: " << code << ": " << err_;
    ++(code == 0 ? enough : ended);
    if (code == 1) expect_one_line();
  }
  EXPECT_GT(enough, 0);
  RecordProperty("ended", ended);
}
#endif

}  // namespace process_limits_test
}  // namespace catena
