// SPDX-License-Identifier: MIT
// The program under limits that a shell or a service manager sets: one error line and a defined exit code, never a signal.
#include <fcntl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <thread>

#include "tests/engine/app/program_in_folder.h"

namespace catena::process_limits_test {

constexpr const char* kScene = R"({
  "fields": {"v": {"analytic": "circle"}},
  "chain": [{"name": "c", "type": "streamline", "field": "v", "seed": [1, 0, 0]}]})";

struct Limit {
  __rlimit_resource what;
  rlim_t maximum;
};

class ProcessLimits : public test::ProgramInFolder {
 protected:
  ProcessLimits() { write("s.json", kScene); }

  /// Starts the program under limits; the output goes to files.
  pid_t start(const std::string& line, const std::vector<Limit>& limits) {
    const std::string program = test::program_path(), out = folder_ / "out", err = folder_ / "err";
    const std::vector<std::string> words = test::words_of(folder_, line);
    std::vector<char*> argv{const_cast<char*>(program.c_str())};
    for (const std::string& a : words) argv.push_back(const_cast<char*>(a.c_str()));
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
    err_ = read("err");
    return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  }
  int run_limited(const std::string& line, const std::vector<Limit>& limits) { return wait(start(line, limits)); }
  static std::string feel(const std::string& seconds = "0.1", const std::string& more = "") {
    return "feel {s.json} --forces on --realtime off --seconds " + seconds + more;
  }
  /// Expects exit code 1 and one line with the part on stderr.
  void expect_failure(const std::string& line, const Limit& limit, const std::string& part) {
    SCOPED_TRACE(line);
    EXPECT_EQ(run_limited(line, {limit}), 1) << err_;
    test::expect_parts(err_, {part});
    test::expect_one_line(err_);
  }

  std::string err_;
};

// The stack limit is the size of a thread's stack, and the servo needs 256 KiB.
TEST_F(ProcessLimits, ASmallStackIsRefused) {
  for (const rlim_t kib : {192, 512, 1000})
    expect_failure(feel(), {RLIMIT_STACK, kib << 10},
                   "catena: the stack is limited to " + std::to_string(kib) + " KiB; at least 1024 KiB were expected (ulimit -s)\n");
  EXPECT_EQ(run_limited(feel(), {{RLIMIT_STACK, 1u << 20}}), 0) << err_;
}

// SIGXFSZ must not end the program while the force is on.
TEST_F(ProcessLimits, TheFileSizeLimitIsASystemFailure) {
  expect_failure(feel("1", " --record {l.catlog}"), {RLIMIT_FSIZE, 8192},
                 "l.catlog: cannot write: File too large (files may have at most 8192 bytes: ulimit -f); the recording ends with tick ");
  expect_failure("generate sphere -o {s.vdb} --resolution 32", {RLIMIT_FSIZE, 8192}, "");
  EXPECT_FALSE(exists("s.vdb"));
}

TEST_F(ProcessLimits, TheCpuTimeLimitIsASystemFailure) {
  const pid_t child = start(feel("20"), {});
  // The kernel sends this signal at the soft limit; "forces on" is printed when the servo runs.
  while (read("out").find("forces on") == std::string::npos) std::this_thread::sleep_for(std::chrono::milliseconds(5));
  kill(child, SIGXCPU);
  EXPECT_EQ(wait(child), 1) << err_;
  test::expect_parts(err_, {"catena: ended by SIGXCPU (CPU time limit exceeded); the device is off\n"});
  test::expect_one_line(err_);
}

#ifndef __SANITIZE_ADDRESS__  // AddressSanitizer needs descriptors of its own
// The error must not be exit code 2, as if the helper program were missing.
TEST_F(ProcessLimits, TheDescriptorLimitIsASystemFailure) {
  ASSERT_EQ(run_limited("generate sphere -o {g.vdb} --resolution 8", {}), 0) << err_;
  write("u.json", R"({"fields": {"s": {"file": "g.vdb"}}, "isosurfaces": [{"field": "s", "level": 1}]})");
  for (const rlim_t files : {6, 40}) {
    for (const char* line : {"info {g.vdb}", "info {u.json}"})
      expect_failure(line, {RLIMIT_NOFILE, files}, "at most " + std::to_string(files) + " files may be open at a time (ulimit -n)");
    expect_failure("generate sphere -o {o.vdb} --resolution 8", {RLIMIT_NOFILE, files}, "");
  }
  EXPECT_FALSE(exists("o.vdb"));
}

// From too little memory to enough: a thread, a field or a servo without memory is one error line.
TEST_F(ProcessLimits, LittleMemoryIsOneErrorLine) {
  int ended = 0, enough = 0;
  for (rlim_t mib = 240; mib <= 640; mib += 40) {
    const int code = run_limited(feel(), {{RLIMIT_AS, mib << 20}});
    if (code == 127) continue;  // too little for the shared libraries
    EXPECT_TRUE(code == 0 || code == 1) << mib << " MiB: " << code << ": " << err_;
    ++(code == 0 ? enough : ended);
    if (code == 1) test::expect_one_line(err_);
  }
  EXPECT_GT(enough, 0);
  RecordProperty("ended", ended);
}
#endif

}  // namespace catena::process_limits_test
