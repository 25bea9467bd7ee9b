// SPDX-License-Identifier: MIT
// Every command under refused resources of machine or shell: exit code 1, or 0 if the command does not need the resource; one line that
// begins "catena: " with the cause; no output. Never exit code 2, which would blame the file, never a signal, never an endless wait.
#include <fcntl.h>
#include <gtest/gtest.h>
#include <sched.h>
#include <sys/mount.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <filesystem>
#include <thread>

#include "tests/support/run_program.h"
#include "tests/support/support.h"

namespace catena::resource_failure_test {

constexpr uid_t kNobody = 65534;

struct Command {
  std::vector<std::string> words;  ///< arguments
  std::string output;              ///< output file in the output folder
  bool keeps = false;              ///< true: data written before a failure is kept (a recording, a study's data)
};

/// A refused resource, set up in the new process before the program starts; returns false if that is not possible.
struct Cause {
  const char* name;
  bool (*inject)(const std::string& outputs);
  const char* message;     ///< part of the error message
  bool every;              ///< true: every command needs the resource
  const char* never = "";  ///< text that must not be in the message (another cause)
};

bool limit(__rlimit_resource what, rlim_t process_limit) {
  const rlimit both{process_limit, process_limit};
  return setrlimit(what, &both) == 0;
}

bool mount_small_disk(const std::string& at, unsigned long flags = 0) {
  return unshare(CLONE_NEWNS) == 0 && mount("none", "/", nullptr, MS_REC | MS_PRIVATE, nullptr) == 0 &&
         mount("none", at.c_str(), "tmpfs", flags, "size=4k,mode=777") == 0;
}

bool full_disk(const std::string& outputs) {
  if (!mount_small_disk(outputs)) return false;
  // its only page is used
  const int file = open((outputs + "/full").c_str(), O_WRONLY | O_CREAT, 0600);
  const char page[4096]{};
  const bool full = write(file, page, sizeof page) == static_cast<ssize_t>(sizeof page);
  close(file);
  return full;
}

template <rlim_t processes>
bool few_processes(const std::string&) {
  return limit(RLIMIT_NPROC, processes) && setuid(kNobody) == 0;
}

const std::vector<Cause>& causes() {
  static const std::vector<Cause> all{
      {"a full disk", full_disk, "No space left on device", true},
      {"a read-only disk", [](const std::string& outputs) { return mount_small_disk(outputs, MS_RDONLY); }, "Read-only file system", true},
      {"ulimit -f 0", [](const std::string&) { return limit(RLIMIT_FSIZE, 0); }, "ulimit -f", true},
      {"ulimit -f 8", [](const std::string&) { return limit(RLIMIT_FSIZE, 8192); }, "ulimit -f", false},
      {"ulimit -v 300 MiB", [](const std::string&) { return limit(RLIMIT_AS, 300u << 20); }, "ulimit -v", false, "ulimit -u"},
      {"ulimit -v 600 MiB", [](const std::string&) { return limit(RLIMIT_AS, 600u << 20); }, "ulimit -v", false, "ulimit -u"},
      {"ulimit -n 6", [](const std::string&) { return limit(RLIMIT_NOFILE, 6); }, "", false},
      {"one process", few_processes<1>, "ulimit -u", false, "ulimit -v"},
      {"two processes", few_processes<2>, "ulimit -u", false, "ulimit -v"},
      {"three processes", few_processes<3>, "ulimit -u", false, "ulimit -v"},
      {"no /proc", [](const std::string&) { return mount_small_disk("/proc"); }, "", false},
      {"standard output is full", [](const std::string&) { return dup2(open("/dev/full", O_WRONLY), STDOUT_FILENO) >= 0; },
       "standard output cannot be written", false},
  };
  return all;
}

class ResourceFailure : public testing::Test {
 protected:
  void SetUp() override {
    std::filesystem::create_directory(outputs_);
    for (const std::string& folder : {folder_.path(), outputs_}) chmod(folder.c_str(), 0777);
    test::expect_run({"generate", "sphere", "-o", folder_ / "s.vdb", "--resolution", "12"});
    test::expect_run({"generate", "circle", "-o", folder_ / "v.vdb", "--resolution", "12"});
    test::expect_run({"import", folder_ / "s.vdb", "-o", folder_ / "s.vti"});
    test::write_file(folder_ / "s.json", R"({"fields": {"v": {"analytic": "circle"}, "s": {"analytic": "sphere"}},
      "chain": [{"name": "a", "type": "streamline", "field": "v", "seed": [1, 0, 0]}],
      "isosurfaces": [{"field": "s", "level": 1}]})");
    test::write_file(folder_ / "p.csv", "t,x,y,z\n0,0.1,0,0\n0.001,0.2,0,0\n0.002,0.3,0.1,0\n");
    test::write_file(folder_ / "seeds.csv", "x,y,z\n0.5,0,0\n");
    test::write_file(folder_ / "study.json", R"({"name": "n", "seed": 7, "subjects": 2, "trials": 1, "training": 0,
      "tasks": [{"name": "t", "kind": "tracing", "dimensions": 2, "field": "flow", "stimulus": {"path_mm": 60},
        "scene": {"fields": {"flow": {"analytic": "vortices", "dimensions": 2, "seed": "$seed"}}, "workspace": {"metres_per_unit": 0.05},
                  "camera": {"position": [0, 0, 8], "target": [0, 0, 0], "up": [0, 1, 0]}}}],
      "conditions": [{"name": "a", "chain": {"t": [{"name": "l", "type": "streamline", "field": "flow", "seed": "$start"}]}},
                     {"name": "b", "chain": {"t": [{"name": "h", "type": "drag", "threshold": 0.012}]}}]})");
    for (const char* shard : {"1/2", "2/2"})
      test::expect_run({"study", "simulate", folder_ / "study.json", "--shard", shard, "-o", folder_ / ("data" + std::string(1, *shard))});
    test::expect_run({"feel", folder_ / "s.json", "--seconds", "0.05", "--record", folder_ / "l.catlog", "--realtime", "off"});
  }

  std::vector<Command> commands() const {
    const std::string out = outputs_ + "/";
    return {
        {{"info", folder_ / "s.vdb"}, ""},
        {{"info", folder_ / "s.vti"}, ""},
        {{"info", folder_ / "s.json"}, ""},
        {{"info", folder_ / "l.catlog"}, ""},
        {{"devices"}, ""},
        {{"study", "keys"}, ""},
        {{"generate", "sphere", "-o", out + "o.vdb", "--resolution", "12"}, "o.vdb"},
        {{"import", folder_ / "s.vti", "-o", out + "o.vdb"}, "o.vdb"},
        {{"import", folder_ / "s.vdb", "-o", out + "o.nii.gz"}, "o.nii.gz"},
        {{"import", folder_ / "s.vdb", "-o", out + "o.nrrd"}, "o.nrrd"},
        {{"export", folder_ / "l.catlog", "-o", out + "o.csv"}, "o.csv"},
        {{"export", folder_ / "s.json", "--isosurface", "0", "-o", out + "o.stl"}, "o.stl"},
        {{"trace", folder_ / "v.vdb", "--field", "circle", "--seeds", folder_ / "seeds.csv", "-o", out + "o.csv"}, "o.csv"},
        {{"replay", folder_ / "s.json", "--probe", folder_ / "p.csv", "-o", out + "o.csv"}, "o.csv"},
        {{"replay", "--log", folder_ / "l.catlog", "-o", out + "o.csv"}, "o.csv"},
        {{"feel", folder_ / "s.json", "--seconds", "0.05", "--realtime", "off", "--record", out + "o.catlog"}, "o.catlog", true},
        {{"feel", folder_ / "s.json", "--seconds", "0.05", "--realtime", "off", "--device", "emulated-falcon:process:" + out + "f.csv"},
         "f.csv",
         true},
        {{"render", folder_ / "s.json", "-o", out + "o.png", "--size", "16x16", "--quality", "draft"}, "o.png"},
        {{"render", folder_ / "s.vti", "-o", out + "o.png", "--size", "16x16", "--quality", "draft"}, "o.png"},
        {{"view", folder_ / "s.json", "--screenshot", out + "o.png", "--size", "64x48", "--frames", "1"}, "o.png"},
        {{"serve", folder_ / "s.json", "--port", "0", "--seconds", "0.2"}, ""},
        {{"tradeoff", "--figure", "2", "-o", out + "t"}, "t"},
        {{"documents", "completion", out + "o.bash"}, "o.bash"},
        {{"study", "simulate", folder_ / "study.json", "--subjects", "1", "--record", "-o", out + "d"}, "d", true},
        {{"study", "merge", folder_ / "data1", folder_ / "data2", "-o", out + "d"}, "d", true},
        {{"study", "scene", folder_ / "study.json", "-o", out + "o.json"}, "o.json"},
        {{"study", "analyse", folder_ / "data1", "-o", out + "d"}, "d"},
        {{"study", "power", folder_ / "study.json", "--effect", "0.5"}, ""},
    };
  }

  struct Ended {
    int code = 0;  ///< exit code; 128 + signal; 255: the cause could not be set up
    std::string err;
  };
  Ended run(const Command& command, const Cause& cause) {
    std::vector<char*> words{const_cast<char*>(program_.c_str())};
    for (const std::string& word : command.words) words.push_back(const_cast<char*>(word.c_str()));
    words.push_back(nullptr);
    int ends[2];  // a pipe, because a file could not grow
    EXPECT_EQ(pipe2(ends, O_CLOEXEC), 0);
    const pid_t child = fork();
    if (child == 0) {
      dup2(open("/dev/null", O_WRONLY), 1);
      dup2(ends[1], 2);
      unsetenv("DISPLAY");
      setenv("XDG_CACHE_HOME", "/dev/null/none", 1);
      alarm(60);  // an endless wait is ended by SIGALRM
      if (!cause.inject(outputs_)) _exit(255);
      execv(program_.c_str(), words.data());
      _exit(127);
    }
    close(ends[1]);
    std::string err;
    char piece[4096];
    for (ssize_t n = 0; (n = read(ends[0], piece, sizeof piece)) > 0;) err.append(piece, static_cast<std::size_t>(n));
    close(ends[0]);
    int status = 0;
    EXPECT_EQ(waitpid(child, &status, 0), child);
    return {WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status), err};
  }

  test::TemporaryFolder folder_;
  std::string outputs_ = folder_ / "outputs", program_ = test::program_path();
};

TEST_F(ResourceFailure, EveryCauseInEveryCommandIsExitCodeOneWithItsMessage) {
  if (geteuid() != 0) GTEST_SKIP() << "only root can take things away";
  for (const Cause& cause : causes()) {
    int refused = 0, done = 0;
    for (const Command& command : commands()) {
      if (command.words[0] == "tradeoff" && !cause.every) continue;  // takes two seconds each
      if (command.words[0] == "study" && !cause.every && !std::string_view(cause.message).starts_with("standard output")) continue;
      const Ended ended = run(command, cause);
      const std::string words =
          std::string(cause.name) + ": catena " + command.words[0] + " " + (command.words.size() > 1 ? command.words[1] : "");
      if (ended.code == 255 || ended.code == 127) continue;  // not possible here, or the libraries could not be loaded
      const bool writes = !command.output.empty();
      EXPECT_TRUE(ended.code == 1 || (ended.code == 0 && !(cause.every && writes))) << words << ": " << ended.code << ": " << ended.err;
      ++(ended.code == 0 ? done : refused);
      if (ended.code == 1) {
        EXPECT_NE(ended.err.find("catena: "), std::string::npos) << words << ": " << ended.err;
        EXPECT_NE(ended.err.find(cause.message), std::string::npos) << words << ": " << ended.err;
        EXPECT_TRUE(*cause.never == 0 || ended.err.find(cause.never) == std::string::npos) << words << ": " << ended.err;
        // a recording keeps the written data, and a complete file is kept if only standard output fails
        const bool whole = std::string_view(cause.message).starts_with("standard output");
        if (writes && !command.keeps && !whole) {
          EXPECT_FALSE(test::exists(outputs_ + "/" + command.output)) << words;
        }
      }
      std::error_code ignored;
      for (const auto& entry : std::filesystem::directory_iterator(outputs_)) std::filesystem::remove_all(entry.path(), ignored);
    }
    std::printf("%-24s refused %2d, done %2d\n", cause.name, refused, done);
  }
}

TEST_F(ResourceFailure, TheCpuDriverRunsUnderAThreadLimitOrIsRefused) {
  if (geteuid() != 0) GTEST_SKIP() << "only root can become another user";
  static rlim_t process_limit = 0;
  const Cause cause{"",
                    [](const std::string&) {
                      return setenv("CATENA_DEVICE", "cpu", 1) == 0 && limit(RLIMIT_NPROC, process_limit) && setuid(kNobody) == 0;
                    },
                    "", false};
  const Command draw{{"render", folder_ / "s.json", "-o", outputs_ + "/o.png", "--size", "16x16", "--quality", "draft"}, "o.png"};
  const rlim_t cores = std::max(1u, std::thread::hardware_concurrency());
  // the main thread, TBB's workers, the driver's queue, one thread per core for drawing, and a temporary one
  process_limit = 1 + (cores - 1) + 1 + cores + 1;
  const Ended enough = run(draw, cause);
  EXPECT_EQ(enough.code, 0) << process_limit << ": " << enough.err;
  process_limit = cores + 1;
  const Ended too_few = run(draw, cause);
  EXPECT_EQ(too_few.code, 1) << process_limit << ": " << too_few.err;
}

TEST_F(ResourceFailure, AMissingPartOfCatenaIsReportedAsSuch) {
  const std::string bin = folder_ / "bin", program = bin + "/catena";
  const auto take = [&](const std::string& name) {
    const std::string from = test::binary_dir() + "/" + name, to = bin + "/" + name;
    std::error_code other_disk;
    std::filesystem::remove(to);
    std::filesystem::create_hard_link(from, to, other_disk);
    if (other_disk) std::filesystem::copy_file(from, to);
  };
  std::filesystem::create_directory(bin);
  const std::vector<std::pair<std::string, std::vector<std::string>>> parts{
      {"catena-read", {"info", folder_ / "s.vdb"}},
      {"catena-read-vtk", {"render", folder_ / "s.vti", "-o", folder_ / "o.png"}},
      {"catena-write", {"generate", "sphere", "-o", folder_ / "o.vdb", "--resolution", "8"}},
      {"catena-device", {"feel", folder_ / "s.json", "--device", "emulated-falcon:process", "--seconds", "0.1"}}};
  take("catena");
  for (const auto& [name, words] : parts) take(name);
  for (const auto& [name, words] : parts)
    for (const bool there : {false, true}) {
      std::filesystem::remove(bin + "/" + name);
      if (there) test::write_file(bin + "/" + name, "not executable");
      const auto run = test::run_program(program, words);
      EXPECT_EQ(run.exit_code, 1) << name << ": " << run.err;
      EXPECT_NE(run.err.find("package catena"), std::string::npos) << name << ": " << run.err;
      take(name);
    }
}

TEST_F(ResourceFailure, ATerminatingSignalIsReported) {
  for (const int signal_number : {SIGABRT, SIGSEGV, SIGXCPU}) {
    const pid_t child = fork();
    if (child == 0) {
      dup2(open((folder_ / "out").c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0666), 1);
      dup2(open((folder_ / "err").c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0666), 2);
      execl(program_.c_str(), program_.c_str(), "serve", (folder_ / "s.json").c_str(), "--port", "0", nullptr);
      _exit(127);
    }
    while (!test::exists(folder_ / "out") || test::read_file(folder_ / "out").find("http") == std::string::npos) usleep(10'000);
    kill(child, signal_number);
    int status = 0;
    EXPECT_EQ(waitpid(child, &status, 0), child);
    const std::string err = test::read_file(folder_ / "err");
    EXPECT_NE(err.find(std::string("catena: ended by SIG") + sigabbrev_np(signal_number)), std::string::npos) << err;
    EXPECT_TRUE(signal_number == SIGXCPU ? WIFEXITED(status) && WEXITSTATUS(status) == 1
                                         : WIFSIGNALED(status) && WTERMSIG(status) == signal_number)
        << err;
    std::filesystem::remove(folder_ / "out");
  }
}

}  // namespace catena::resource_failure_test
