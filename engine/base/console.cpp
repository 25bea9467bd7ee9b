// SPDX-License-Identifier: MIT
#include "engine/base/console.h"

#include <fcntl.h>
#include <poll.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <cstdio>
#include <mutex>
#include <string>
#include <utility>

#include "engine/base/system_failure.h"
#include "engine/base/text.h"

namespace catena {

namespace {

constexpr int kPatienceMs = 500;
std::atomic<int> output_error{0};

void keep_output_error(int descriptor, int code) noexcept {
  int none = 0;
  if (code == EIO && ::isatty(descriptor) == 1) return;  // the terminal has been closed: the error has no reader
  if (descriptor == STDOUT_FILENO) output_error.compare_exchange_strong(none, code);
}

void print_sanitized(std::string_view prefix, std::string_view line) noexcept {
  try {
    const std::string full_line = std::string(prefix) + sanitize_for_terminal(one_line(std::string(line.substr(0, 2 * kMaxLineBytes))));
    print_nonblocking(STDERR_FILENO, truncate_utf8(full_line, kMaxLineBytes) + "\n", kPatienceMs);
  } catch (...) {
    char buffer[256];
    std::snprintf(buffer, sizeof buffer, "catena: %s\n", out_of_memory_message());
    print_nonblocking(STDERR_FILENO, buffer, kPatienceMs);
  }
}

}  // namespace

void print_line(std::string_view line) noexcept { print_sanitized({}, line); }
void print_message(std::string_view line) noexcept { print_sanitized("catena: ", line); }

void print_nonblocking(int descriptor, std::string_view text, int wait_ms) noexcept {
  struct stat about {};
  if (::fstat(descriptor, &about) != 0) return keep_output_error(descriptor, errno);
  // flushes the stdio buffer first, as far as that does not block
  pollfd ready{descriptor, POLLOUT, 0};
  if (::poll(&ready, 1, wait_ms) != 1) return;
  std::fflush(descriptor == STDERR_FILENO ? stderr : stdout);

  // opens the terminal or pipe separately: O_NONBLOCK on the shared file description would also affect the shell
  const bool can_block = S_ISCHR(about.st_mode) || S_ISFIFO(about.st_mode);
  int own_descriptor = -1;
  if (can_block) {
    char name[32];
    std::snprintf(name, sizeof name, "/proc/self/fd/%d", descriptor);
    own_descriptor = ::open(name, O_WRONLY | O_NONBLOCK | O_NOCTTY | O_CLOEXEC);
  }
  const int target = own_descriptor >= 0 ? own_descriptor : descriptor;
  while (!text.empty()) {
    const ssize_t n = S_ISSOCK(about.st_mode) ? ::send(target, text.data(), text.size(), MSG_DONTWAIT | MSG_NOSIGNAL)
                                              : ::write(target, text.data(), text.size());
    if (n > 0) {
      text.remove_prefix(static_cast<std::size_t>(n));
      continue;
    }
    if (n < 0 && errno == EINTR) continue;
    pollfd again{target, POLLOUT, 0};
    if (n < 0 && errno == EAGAIN && wait_ms > 0 && ::poll(&again, 1, wait_ms) == 1 && (again.revents & POLLOUT) != 0) continue;
    if (n < 0 && errno != EAGAIN) keep_output_error(descriptor, errno);
    break;
  }
  if (own_descriptor >= 0) ::close(own_descriptor);
}

namespace {
std::mutex activity_mutex;
std::string activity_text;
}  // namespace

void set_activity(std::string text) {
  const std::scoped_lock lock(activity_mutex);
  activity_text = std::move(text);
}

std::string activity() {
  const std::scoped_lock lock(activity_mutex);
  return activity_text;
}

int stdout_errno() noexcept { return output_error; }

}  // namespace catena
