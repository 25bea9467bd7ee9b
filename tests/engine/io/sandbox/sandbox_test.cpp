// SPDX-License-Identifier: MIT
/// The sandbox of file readers: each forbidden action is tried in a process of its own, with and without the sandbox.
#include "engine/io/sandbox/sandbox.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/mman.h>
#include <sys/socket.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <filesystem>
#include <functional>

#include "tests/support/results.h"
#include "tests/support/support.h"

namespace catena::sandbox::sandbox_test {

/// Tries an action in a child process, in the sandbox or not: 1 if the action succeeds, 0 if not, and 2 if the sandbox cannot be entered.
int attempt(bool confined, const std::function<bool()>& act, const ProcessLimits& limits = {}) {
  const pid_t child = ::fork();
  if (child == 0) {
    if (confined && !enter_sandbox(limits)) ::_exit(2);
    ::_exit(act() ? 1 : 0);
  }
  int status = 0;
  while (::waitpid(child, &status, 0) < 0 && errno == EINTR) {
  }
  return WIFEXITED(status) ? WEXITSTATUS(status) : 100 + WTERMSIG(status);
}

void expect_only_outside(const char* what, const std::function<bool()>& act) {
  EXPECT_EQ(attempt(false, act), 1) << what;
  EXPECT_EQ(attempt(true, act), 0) << what;
}

TEST(Sandbox, FilesCannotBeOpened) {
  catena::test::TemporaryFolder folder;
  const std::string path = folder / "file";
  catena::test::write_file(path, "text");
  expect_only_outside("read", [&] { return ::open(path.c_str(), O_RDONLY) >= 0; });
  expect_only_outside("write", [&] { return ::open(path.c_str(), O_WRONLY) >= 0; });
  expect_only_outside("make", [&] { return ::open((folder / "new").c_str(), O_CREAT | O_WRONLY, 0600) >= 0; });
  expect_only_outside("rename", [&] { return ::rename(path.c_str(), path.c_str()) == 0; });
  expect_only_outside("a folder", [&] { return ::access(folder.path().c_str(), R_OK) == 0; });
  expect_only_outside("memory files", [] { return ::memfd_create("x", 0) >= 0; });
}

TEST(Sandbox, OnlyTheGivenFolderCanBeRead) {
  catena::test::TemporaryFolder folder;
  std::filesystem::create_directories(folder / "in/deep");
  catena::test::write_file(folder / "outside", "text");
  catena::test::write_file(folder / "in/file", "text");
  catena::test::write_file(folder / "in/deep/file", "text");
  std::filesystem::create_symlink("../outside", folder / "in/link");
  for (const bool landlock : {true, false}) {
    ProcessLimits limits;
    limits.readable_folder = folder / "in";
    limits.use_landlock = landlock;
    const auto opens = [&](const std::string& name, int flags = O_RDONLY) {
      return attempt(
          true, [&] { return ::open(((landlock ? limits.readable_folder : std::string()) + "/" + name).c_str(), flags, 0600) >= 0; },
          limits);
    };
    for (const char* name : {"file", "deep/file"}) EXPECT_EQ(opens(name), 1) << landlock << name;
    for (const char* name : {"../outside", "link"}) EXPECT_EQ(opens(name), 0) << landlock << name;
    EXPECT_EQ(opens("new", O_CREAT | O_WRONLY), 0) << landlock;
    for (const int flags : {O_WRONLY, O_RDONLY | O_TRUNC}) EXPECT_EQ(opens("file", flags), 0) << landlock << flags;
    const auto passwords = [] { return ::open("/etc/passwd", O_RDONLY) >= 0; };
    const auto socket = [] { return ::socket(AF_UNIX, SOCK_STREAM, 0) >= 0; };
    EXPECT_EQ(attempt(true, passwords, limits), 0) << landlock;
    EXPECT_EQ(attempt(true, socket, limits), 0) << landlock;
  }
}

TEST(Sandbox, SocketsProgramsAndProcessesAreForbidden) {
  expect_only_outside("socket", [] { return ::socket(AF_UNIX, SOCK_STREAM, 0) >= 0; });
  expect_only_outside("network", [] { return ::socket(AF_INET, SOCK_STREAM, 0) >= 0; });
  expect_only_outside("program", [] {
    ::execl("/bin/sh", "sh", "-c", "exit 1", nullptr);
    return false;
  });
  expect_only_outside("process", [] {
    const pid_t child = static_cast<pid_t>(::syscall(SYS_clone, SIGCHLD, nullptr, nullptr, nullptr, nullptr));
    if (child == 0) ::_exit(0);
    return child > 0;
  });
  expect_only_outside("other processes", [] { return ::kill(::getppid(), 0) == 0; });
}

TEST(Sandbox, ExecutableMemoryAndProcessGroupsAreForbidden) {
  expect_only_outside("code",
                      [] { return ::mmap(nullptr, 4096, PROT_READ | PROT_EXEC, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0) != MAP_FAILED; });
  expect_only_outside("made code", [] {
    void* place = ::mmap(nullptr, 4096, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
    return ::mprotect(place, 4096, PROT_READ | PROT_EXEC) == 0;
  });
  expect_only_outside("groups", [] { return ::setpgid(0, 0) == 0; });
}

TEST(Sandbox, AllCapabilitiesAreDropped) {
  if (::geteuid() != 0) GTEST_SKIP() << "only root has rights to drop";
  int ready[2], end[2];
  ASSERT_TRUE(::pipe(ready) == 0 && ::pipe(end) == 0);
  const pid_t child = ::fork();
  if (child == 0) {
    char byte = enter_sandbox({}) ? 'y' : 'n';
    (void)!::write(ready[1], &byte, 1);
    (void)!::read(end[0], &byte, 1);
    ::_exit(0);
  }
  char byte = 0;
  ASSERT_EQ(::read(ready[0], &byte, 1), 1);
  EXPECT_EQ(byte, 'y');
  const std::string status = catena::test::read_file("/proc/" + std::to_string(child) + "/status");
  for (const char* set : {"CapInh", "CapPrm", "CapEff", "CapBnd", "CapAmb"})
    EXPECT_TRUE(test::has(status, std::string(set) + ":\t0000000000000000")) << set << "\n" << status;
  (void)!::write(end[1], &byte, 1);
  ::waitpid(child, nullptr, 0);
  for (const int file : {ready[0], ready[1], end[0], end[1]}) ::close(file);
}

#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
TEST(Sandbox, TimeAndMemoryAreLimited) {
  ProcessLimits limits;
  limits.memory_bytes = 16 << 20;
  limits.cpu_s = 1;
  const auto take = [] {
    return ::mmap(nullptr, std::size_t{1} << 30, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0) != MAP_FAILED;
  };
  EXPECT_EQ(attempt(false, take), 1);
  EXPECT_EQ(attempt(true, take, limits), 0);
  const auto spin = []() -> bool {
    for (;;) ::getppid();
  };
  EXPECT_EQ(attempt(true, spin, limits), 100 + SIGXCPU);
}
#endif

}  // namespace catena::sandbox::sandbox_test
