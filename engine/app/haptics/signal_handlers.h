// SPDX-License-Identifier: MIT
/// Signal handlers that end a command gracefully or stop the device on a crash.
///
/// Ctrl-C, Ctrl-Z, a closed terminal or pipe and `kill` set a flag that the command polls, so that a command that holds a device shuts it
/// down: a process that is killed or suspended leaves the last force on the device. Other signals that would end the program are handled in
/// the same way: user signals, timers, the limit on processor time, real-time signals; they are system failures. A command that does not
/// end within 30 s of the first signal, for example because a graphics driver hangs, is ended by that signal. Crashes: CrashGuard.
#pragma once
#include <array>
#include <atomic>
#include <csignal>
#include <vector>

#include "engine/base/result.h"
#include "haptics/device/device.h"

namespace catena::app {

/// Installs the handlers for its lifetime. At most one object at a time.
class InterruptHandler {
 public:
  /// Handles all signals above.
  InterruptHandler();
  /// Handles only the given signals, for commands that hold no device; the second time, a signal ends the process at once.
  explicit InterruptHandler(const std::vector<int>& signals);
  ~InterruptHandler();  ///< Restores the previous handlers
  InterruptHandler(const InterruptHandler&) = delete;
  InterruptHandler& operator=(const InterruptHandler&) = delete;

  /// Whether one of the signals was received.
  bool is_requested() const { return flag(); }
  /// The flag that the handlers set.
  const std::atomic<bool>& flag() const;
  /// Error (system failure), "ended by SIGXCPU (CPU time limit exceeded)", if the first signal was not a request by the user; otherwise
  /// success.
  Outcome outcome() const;

 private:
  void install(int signal_number, bool only_default, int flags);

  struct SavedAction {
    int signal_number;
    struct sigaction action;
  };
  std::vector<SavedAction> saved_actions_;
};

/// Whether the first signal was SIGPIPE: the reader of the output has closed it.
bool ended_by_broken_pipe();

/// Stops the device when the program crashes. SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGSYS, SIGTRAP, SIGABRT (assertions) and SIGQUIT stop the
/// device, wait until it has confirmed zero force (at most 1 s), report in one line whether it has, and then take their default action. The
/// handler runs on the thread that crashed while the others continue; it only uses atomics, write, sleep and raise. Device::stop() and
/// zero_force_confirmed() are safe in it. The thread that creates the guard gets an alternate signal stack, so that a stack overflow is
/// handled on that thread, but not on others. Not covered: SIGKILL, a power failure, a crash of the device's own I/O thread. At most one
/// object at a time.
class CrashGuard {
 public:
  explicit CrashGuard(haptics::Device& device);  ///< `device` must outlive this object
  ~CrashGuard();                                 ///< Restores the previous handlers; on the thread that created the object
  CrashGuard(const CrashGuard&) = delete;
  CrashGuard& operator=(const CrashGuard&) = delete;

 private:
  static constexpr std::array kSignals{SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGSYS, SIGTRAP, SIGABRT, SIGQUIT};
  std::array<struct sigaction, kSignals.size()> saved_actions_{};
  std::vector<char> stack_;
  stack_t saved_stack_{};
};

/// Makes crash signals end the program with one line on stderr, "catena: ended by SIGSEGV (..)", even if no device is open. Call at the
/// start of the program, on its first thread. Signals that already have a handler or are ignored are left unchanged. The limit on processor
/// time (SIGXCPU), and a crash under a limit on memory (ulimit -v), are system failures: exit code 1.
void install_crash_reporter();

/// Result of stop_guarded_device().
enum class StopResult : unsigned char {
  no_device,   ///< No guard exists
  stopped,     ///< The device has confirmed zero force
  unconfirmed  ///< The device was stopped but has not confirmed zero force; a device with a watchdog process is left to that process
};

/// Stops the device of the current CrashGuard, if any, and waits for zero force, at most 1 s. For code that ends the process in another
/// way. Safe in a signal handler.
StopResult stop_guarded_device() noexcept;

}  // namespace catena::app
