// SPDX-License-Identifier: MIT
#include "engine/app/cli/process_limits.h"

#include <fcntl.h>
#include <fmt/core.h>
#include <poll.h>
#include <pthread.h>
#include <sys/resource.h>
#include <unistd.h>
#include <algorithm>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <exception>
#include <new>
#include <string>

#include "engine/app/haptics/signal_handlers.h"
#include "engine/base/console.h"
#include "engine/base/system_failure.h"
#include "engine/base/threads.h"

namespace catena::app {

namespace {

constexpr std::size_t kThreadStack = 2u << 20;
constexpr rlim_t kWantedStack = 8u << 20, kMinStack = 1u << 20;

void say_no_thread(char* line, std::size_t size) noexcept {
  try {
    std::snprintf(line, size, "catena: no other thread can be started: %s\n", describe_errno(thread_start_errno()).c_str());
  } catch (const std::bad_alloc&) {
    std::snprintf(line, size, "catena: %s\n", out_of_memory_message());
  }
}

// Must not allocate: memory may be exhausted.
[[noreturn]] void on_terminate() {
  char line[256] = "catena: ended by an unhandled error\n";
  try {
    if (const std::exception_ptr thrown = std::current_exception()) std::rethrow_exception(thrown);
  } catch (const std::bad_alloc&) {
    std::snprintf(line, sizeof line, "catena: %s\n", out_of_memory_message());
  } catch (const std::exception& error) {
    std::snprintf(line, sizeof line, "catena: ended by an unhandled error: %.180s\n", error.what());
    if (is_thread_start_failure(error)) say_no_thread(line, sizeof line);
  } catch (...) {
  }
  stop_guarded_device();
  [[maybe_unused]] const auto written = write(STDERR_FILENO, line, std::strlen(line));
  _exit(1);
}

void enlarge_stacks_of_threads() {
  pthread_attr_t attributes;
  if (pthread_getattr_default_np(&attributes) != 0) return;
  std::size_t size = 0;
  if (pthread_attr_getstacksize(&attributes, &size) == 0 && size < kThreadStack &&
      pthread_attr_setstacksize(&attributes, kThreadStack) == 0)
    pthread_setattr_default_np(&attributes);
  pthread_attr_destroy(&attributes);
}

Outcome enlarge_first_stack() {
  rlimit limit{};
  if (getrlimit(RLIMIT_STACK, &limit) != 0 || limit.rlim_cur == RLIM_INFINITY || limit.rlim_cur >= kWantedStack) return Done{};
  limit.rlim_cur = limit.rlim_max == RLIM_INFINITY ? kWantedStack : std::min(kWantedStack, limit.rlim_max);
  setrlimit(RLIMIT_STACK, &limit);
  if (getrlimit(RLIMIT_STACK, &limit) == 0 && limit.rlim_cur < kMinStack)
    return Error{
        fmt::format("the stack is limited to {} KiB; at least {} KiB were expected (ulimit -s)", limit.rlim_cur / 1024, kMinStack / 1024),
        true};
  return Done{};
}

}  // namespace

Outcome prepare_process() {
  std::set_terminate(on_terminate);
  install_crash_reporter();
  std::signal(SIGXFSZ, SIG_IGN);
  enlarge_stacks_of_threads();
  return enlarge_first_stack();
}

namespace {

bool reader_has_gone() {
  pollfd out{STDOUT_FILENO, POLLOUT, 0};
  return ::poll(&out, 1, 0) == 1 && (out.revents & POLLERR) != 0;
}

}  // namespace

void reserve_standard_descriptors() {
  // open() returns the lowest free descriptor: 0 before 1 before 2
  for (const int fd : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO})
    if (::fcntl(fd, F_GETFD) < 0 && errno == EBADF && ::open("/dev/null", O_RDONLY) < 0) return;
}

int flush_output(int code) {
  const bool lost_before = std::ferror(stdout) != 0;
  errno = 0;
  const bool flushed = std::fflush(stdout) == 0 && !lost_before;
  if (flushed && stdout_errno() == 0) return code;
  const int why = flushed ? stdout_errno() : errno;
  if (code != 0 || ended_by_broken_pipe()) return code;
  if (why == EPIPE || reader_has_gone()) return 1;
  const std::string reason = why != 0 ? " (" + describe_errno(why) + ")" : "";
  print_message("standard output cannot be written" + reason + ": the printed text is lost; an output that can be written was expected");
  return 1;
}

}  // namespace catena::app
