#include "engine/app/process_limits.h"

#include <fmt/core.h>
#include <pthread.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <exception>
#include <new>

#include "engine/app/hand/crash_guard.h"

namespace catena::app {

namespace {

constexpr std::size_t kThreadStack = 2u << 20;
constexpr rlim_t kWantedStack = 8u << 20, kLeastStack = 1u << 20;

// No allocation: there may be no memory.
[[noreturn]] void on_terminate() {
  char line[256] = "catena: ended by an error that nothing handles\n";
  try {
    if (const std::exception_ptr thrown = std::current_exception()) std::rethrow_exception(thrown);
  } catch (const std::bad_alloc&) {
    std::snprintf(line, sizeof line, "catena: out of memory\n");
  } catch (const std::exception& error) {
    std::snprintf(line, sizeof line, "catena: ended by an error that nothing handles: %.180s\n", error.what());
  } catch (...) {
  }
  let_go();
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
  if (getrlimit(RLIMIT_STACK, &limit) == 0 && limit.rlim_cur < kLeastStack)
    return Error{
        fmt::format("the stack is limited to {} KiB: at least {} (ulimit -s) were expected", limit.rlim_cur / 1024, kLeastStack / 1024),
        true};
  return Done{};
}

}  // namespace

Outcome prepare_process() {
  std::set_terminate(on_terminate);
  std::signal(SIGXFSZ, SIG_IGN);
  enlarge_stacks_of_threads();
  return enlarge_first_stack();
}

}  // namespace catena::app
