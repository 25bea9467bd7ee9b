/// A program that crashes lets the hand go first: SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGABRT (assertions, exceptions that nobody
/// catches) and SIGQUIT stop the device, wait 50 ms for its I/O thread to send the zero, and then do what they would have done.
/// The handler runs on the thread that crashed, the others go on: it stores atomics, sleeps, raises. Device::stop() must be safe in it.
/// Not covered: SIGKILL, a power cut, a crash of the device's own I/O thread or of a stack that is full. One at a time.
#pragma once
#include <array>
#include <csignal>

#include "haptics/device/device.h"

namespace catena::app {

class CrashGuard {
 public:
  explicit CrashGuard(haptics::Device& device);  ///< which outlives it
  ~CrashGuard();                                 ///< as it was before
  CrashGuard(const CrashGuard&) = delete;
  CrashGuard& operator=(const CrashGuard&) = delete;

 private:
  static constexpr std::array kSignals{SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGABRT, SIGQUIT};
  std::array<struct sigaction, kSignals.size()> before_{};
};

}  // namespace catena::app
