// SPDX-License-Identifier: MIT
#include "engine/base/helper_process.h"

#include <dlfcn.h>
#include <fcntl.h>
#include <link.h>
#include <poll.h>
#include <spawn.h>
#include <sys/auxv.h>
#include <sys/resource.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstring>
#include <filesystem>
#include <vector>

#include "engine/base/clock.h"
#include "engine/base/result.h"
#include "engine/base/system_failure.h"

namespace catena {
namespace {

constexpr int kFirstDescriptor = 3;
/// Folder where `cmake --install` puts the helpers, relative to bin and lib; relative to lib/MACHINE it needs one more "..".
constexpr const char* kInstalled = "../libexec/catena";
/// True under the sanitizers: the helper keeps its stderr so that their reports are visible.
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
constexpr bool kKeepsErrors = true;
#else
constexpr bool kKeepsErrors = false;
#endif

/// Arguments of posix_spawn; the destructor frees them.
struct Plan {
  posix_spawn_file_actions_t files;
  posix_spawnattr_t attributes;
  Plan() {
    posix_spawn_file_actions_init(&files);
    posix_spawnattr_init(&attributes);
  }
  Plan(const Plan&) = delete;
  ~Plan() {
    posix_spawn_file_actions_destroy(&files);
    posix_spawnattr_destroy(&attributes);
  }
};

constexpr int kAway = 64;  ///< lowest number of the temporary descriptors, clear of the final ones

/// Returns the path of the running program; where /proc is not mounted, the name with which the kernel executed it.
std::filesystem::path program_path() {
  std::error_code code;
  const std::filesystem::path linked = std::filesystem::read_symlink("/proc/self/exe", code);
  if (!code) return linked;
  const char* const executed = reinterpret_cast<const char*>(::getauxval(AT_EXECFN));
  return executed != nullptr ? std::filesystem::weakly_canonical(executed, code) : std::filesystem::path();
}

}  // namespace

std::string descriptor_limit_message() {
  rlimit limit{};
  ::getrlimit(RLIMIT_NOFILE, &limit);
  return "at most " + std::to_string(limit.rlim_cur) + " files may be open at a time (ulimit -n), expected at least " +
         std::to_string(2 * kAway);
}

std::string helper_path(const std::string& name) {
  namespace fs = std::filesystem;
  std::error_code code;
  std::vector<fs::path> candidates;
  const auto add_folder = [&](const fs::path& folder) {
    for (const fs::path& at : {folder, folder / kInstalled, folder / ".." / kInstalled}) candidates.push_back(at / name);
  };
  // first the folder of the shared library that contains this code, so that both have one version; l_name is empty for the program itself
  Dl_info info;
  link_map* map = nullptr;
  if (::dladdr1(reinterpret_cast<const void*>(&helper_path), &info, reinterpret_cast<void**>(&map), RTLD_DL_LINKMAP) != 0 &&
      map != nullptr && map->l_name[0] != '\0')
    add_folder(fs::canonical(map->l_name, code).parent_path());
  add_folder(program_path().parent_path());
  for (const fs::path& candidate : candidates)
    if (::access(candidate.c_str(), X_OK) == 0) return candidate.lexically_normal().string();
  return candidates.front().string();
}

FileDescriptor& FileDescriptor::operator=(FileDescriptor&& other) noexcept {
  if (this != &other) {
    close();
    fd_ = other.fd_;
    other.fd_ = -1;
  }
  return *this;
}

void FileDescriptor::close() {
  if (fd_ >= 0) ::close(fd_);
  fd_ = -1;
}

Result<HelperProcess> HelperProcess::start(const std::string& path, std::span<const int> descriptors) {
  const auto failed = [&](int code) {
    if (code == EINVAL || is_too_many_open_files(code))
      return Error{path + ": this part of Catena cannot be started: " + descriptor_limit_message(), true};
    return Error{path + ": this part of Catena cannot be started (" + describe_errno(code) + ")" +
                     (is_system_failure(code) ? ": this machine does not give what is needed"
                                              : ": expected it beside the program, as the package catena installs it"),
                 true};
  };
  // descriptors: duplicated to high numbers first, so that none overwrites another
  Plan plan;
  std::vector<FileDescriptor> duplicates;
  for (const int fd : descriptors) {
    duplicates.emplace_back(::fcntl(fd, F_DUPFD_CLOEXEC, kAway));
    if (!duplicates.back()) return failed(errno);
  }
  for (const int standard : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO})
    if (standard != STDERR_FILENO || !kKeepsErrors) posix_spawn_file_actions_addopen(&plan.files, standard, "/dev/null", O_RDWR, 0);
  int next = kFirstDescriptor;
  for (const FileDescriptor& fd : duplicates) posix_spawn_file_actions_adddup2(&plan.files, fd.get(), next++);
  posix_spawn_file_actions_addclosefrom_np(&plan.files, next);
  // signals: default handlers, none blocked
  sigset_t all, none;
  sigfillset(&all);
  sigemptyset(&none);
  posix_spawnattr_setsigdefault(&plan.attributes, &all);
  posix_spawnattr_setsigmask(&plan.attributes, &none);
  posix_spawnattr_setflags(&plan.attributes, POSIX_SPAWN_SETSIGDEF | POSIX_SPAWN_SETSIGMASK);
  pid_t pid = -1;
  char* const arguments[] = {const_cast<char*>(path.c_str()), nullptr};
  // VTK's parallel sort leaves equal items in an order that differs from run to run
  static char one_thread[] = "VTK_SMP_BACKEND_IN_USE=Sequential";
  char* const environment[] = {one_thread, nullptr};
  if (const int code = posix_spawn(&pid, path.c_str(), &plan.files, &plan.attributes, arguments, environment); code != 0)
    return failed(code);
  return HelperProcess(pid);
}

HelperProcess::HelperProcess(HelperProcess&& other) noexcept : pid_(other.pid_) { other.pid_ = -1; }

HelperProcess::~HelperProcess() {
  if (pid_ > 0) wait(0);
}

ProcessExit HelperProcess::wait(double limit_s, const std::function<void(double)>& while_waiting) {
  const std::int64_t start = now_ns(), until = start + static_cast<std::int64_t>(1e9 * limit_s);
  const FileDescriptor process_fd(static_cast<int>(::syscall(SYS_pidfd_open, pid_, 0)));
  int status = 0;
  rusage used{};
  bool too_long = false;
  for (;;) {
    const pid_t waited = ::wait4(pid_, &status, WNOHANG, &used);
    if (waited == pid_ || (waited < 0 && errno != EINTR)) break;
    const std::int64_t left_ns = until - now_ns();
    if (left_ns <= 0) {
      too_long = true;
      ::kill(pid_, SIGKILL);
      while (::wait4(pid_, &status, 0, &used) < 0 && errno == EINTR) {
      }
      break;
    }
    // a kernel without pidfd: the process is polled every kPollMs
    constexpr int kPollMs = 2, kMaxWaitMs = 1000;
    pollfd poller{process_fd.get(), POLLIN, 0};
    ::poll(&poller, process_fd ? 1 : 0,
           process_fd ? static_cast<int>(std::min<std::int64_t>(left_ns / 1'000'000 + 1, kMaxWaitMs)) : kPollMs);
    if (while_waiting) while_waiting(1e-3 * ms_since(start));
  }
  pid_ = -1;
  const auto seconds = [](const timeval& t) { return static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_usec); };
  const double cpu_s = seconds(used.ru_utime) + seconds(used.ru_stime);
  if (too_long) return {ProcessExit::Cause::timed_out, SIGKILL, cpu_s};
  if (WIFSIGNALED(status)) return {ProcessExit::Cause::killed, WTERMSIG(status), cpu_s};
  return {ProcessExit::Cause::exited, WIFEXITED(status) ? WEXITSTATUS(status) : 0, cpu_s};
}

}  // namespace catena
