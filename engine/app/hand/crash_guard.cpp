#include "engine/app/hand/crash_guard.h"

#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <cstring>
#include <ctime>

namespace catena::app {

namespace {

constexpr std::size_t kStackBytes = 64 * 1024;

std::atomic<haptics::Device*> held{nullptr};
static_assert(std::atomic<haptics::Device*>::is_always_lock_free, "a signal handler reads it");

const char* line_of(int signal_number) {
  switch (signal_number) {
    case SIGSEGV:
      return "catena: ended by SIGSEGV (a bug, or a stack that is full); the device is off\n";
    case SIGBUS:
      return "catena: ended by SIGBUS (a file that was cut while it was read, or a bug); the device is off\n";
    case SIGFPE:
      return "catena: ended by SIGFPE (a bug); the device is off\n";
    case SIGILL:
      return "catena: ended by SIGILL (a bug, or another kind of processor); the device is off\n";
    case SIGSYS:
      return "catena: ended by SIGSYS (a system call that is not allowed here); the device is off\n";
    case SIGTRAP:
      return "catena: ended by SIGTRAP; the device is off\n";
    case SIGQUIT:
      return "catena: ended by SIGQUIT; the device is off\n";
    default:
      return "";  // SIGABRT: who aborts has said why
  }
}

void on_crash(int signal_number) {
  const int error = errno;
  if (let_go()) {
    const char* line = line_of(signal_number);
    [[maybe_unused]] const auto written = write(STDERR_FILENO, line, std::strlen(line));
  }
  std::signal(signal_number, SIG_DFL);
  std::raise(signal_number);  // as soon as this handler returns
  errno = error;
}

}  // namespace

bool let_go() noexcept {
  haptics::Device* device = held.exchange(nullptr);
  if (device == nullptr) return false;
  device->stop();
  timespec left{.tv_sec = 0, .tv_nsec = 50'000'000};
  while (nanosleep(&left, &left) != 0 && errno == EINTR) {
  }
  return true;
}

CrashGuard::CrashGuard(haptics::Device& device) : stack_(kStackBytes) {
  stack_t stack{};
  stack.ss_sp = stack_.data();
  stack.ss_size = stack_.size();
  sigaltstack(&stack, &stack_before_);
  held = &device;
  struct sigaction action {};
  action.sa_handler = on_crash;
  action.sa_flags = SA_ONSTACK;
  sigemptyset(&action.sa_mask);
  for (std::size_t i = 0; i < kSignals.size(); ++i) sigaction(kSignals[i], &action, &before_[i]);
}

CrashGuard::~CrashGuard() {
  for (std::size_t i = 0; i < kSignals.size(); ++i) sigaction(kSignals[i], &before_[i], nullptr);
  held = nullptr;
  sigaltstack(&stack_before_, nullptr);
}

}  // namespace catena::app
