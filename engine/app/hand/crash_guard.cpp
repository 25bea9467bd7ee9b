#include "engine/app/hand/crash_guard.h"

#include <atomic>
#include <cerrno>
#include <ctime>

namespace catena::app {

namespace {

std::atomic<haptics::Device*> held{nullptr};
static_assert(std::atomic<haptics::Device*>::is_always_lock_free, "a signal handler reads it");

void on_crash(int signal_number) {
  const int error = errno;
  if (haptics::Device* device = held.exchange(nullptr)) {
    device->stop();
    timespec left{.tv_sec = 0, .tv_nsec = 50'000'000};
    while (nanosleep(&left, &left) != 0 && errno == EINTR) {
    }
  }
  std::signal(signal_number, SIG_DFL);
  std::raise(signal_number);  // as soon as this handler returns
  errno = error;
}

}  // namespace

CrashGuard::CrashGuard(haptics::Device& device) {
  held = &device;
  struct sigaction action {};
  action.sa_handler = on_crash;
  sigemptyset(&action.sa_mask);
  for (std::size_t i = 0; i < kSignals.size(); ++i) sigaction(kSignals[i], &action, &before_[i]);
}

CrashGuard::~CrashGuard() {
  for (std::size_t i = 0; i < kSignals.size(); ++i) sigaction(kSignals[i], &before_[i], nullptr);
  held = nullptr;
}

}  // namespace catena::app
