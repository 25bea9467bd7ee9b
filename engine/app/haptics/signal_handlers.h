/// Ctrl-C, Ctrl-Z, a closed terminal or pipe and `kill` as a flag to look at: work that holds a device ends by its own way out, for a
/// process that is killed or suspended leaves the last force at the device. So do the signals that would end the program otherwise:
/// user signals, timers, limits on processor time, real-time signals; these are an error of the machine. Crashes: below.
/// What does not end within 30 s of the first signal, as within a graphics driver that waits for ever, is ended by it.
/// One at a time.
#pragma once
#include <array>
#include <atomic>
#include <csignal>
#include <vector>

#include "engine/base/result.h"
#include "haptics/device/device.h"

namespace catena::app {

class InterruptHandler {
 public:
  InterruptHandler();
  /// Only these, for work that holds no device: the same signal once more ends the process at once.
  explicit InterruptHandler(const std::vector<int>& asking);
  ~InterruptHandler();  ///< as it was before
  InterruptHandler(const InterruptHandler&) = delete;
  InterruptHandler& operator=(const InterruptHandler&) = delete;

  bool is_requested() const { return flag(); }
  const std::atomic<bool>& flag() const;
  /// An error ("ended by SIGXCPU (CPU time limit exceeded)") if it was not a person who asked.
  Outcome outcome() const;

 private:
  void install(int signal_number, bool only_default, int flags);

  struct SavedAction {
    int signal_number;
    struct sigaction action;
  };
  std::vector<SavedAction> saved_actions_;
};

/// The work was asked to end because the reader of its output has gone.
bool ended_by_broken_pipe();

/// A program that crashes lets the hand go first: SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGSYS, SIGTRAP, SIGABRT (assertions) and SIGQUIT
/// stop the device, wait until it has confirmed its zero (at most 1 s), say in one line whether it has, and then do what they would have
/// done. The handler runs on the thread that crashed, the others go on: it stores atomics, writes, sleeps, raises. Device::stop() and
/// zero_force_confirmed() are safe in it. The thread that makes the guard has a second stack for it, so that a full one is covered there;
/// on others it is not. Not covered: SIGKILL, a power cut, a crash of the device's own I/O thread. One at a time.
class CrashGuard {
 public:
  explicit CrashGuard(haptics::Device& device);  ///< which outlives it
  ~CrashGuard();                                 ///< as it was before; on the same thread
  CrashGuard(const CrashGuard&) = delete;
  CrashGuard& operator=(const CrashGuard&) = delete;

 private:
  static constexpr std::array kSignals{SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGSYS, SIGTRAP, SIGABRT, SIGQUIT};
  std::array<struct sigaction, kSignals.size()> saved_actions_{};
  std::vector<char> stack_;
  stack_t saved_stack_{};
};

/// The signals of a crash end the program with one line on stderr, also where no device is held: "catena: ended by SIGSEGV (..)". For
/// the start of the program, on its first thread. Those that somebody handles or ignores are left alone. The limit on
/// processor time (SIGXCPU) is an error of the machine: exit code 1.
void install_crash_reporter();

enum class StopResult : unsigned char {
  no_device,   ///< no guard holds a device
  stopped,     ///< the device holds no force
  unconfirmed  ///< it was told so, but has not answered; a device with a watchdog process is left to it
};

/// Stops the device that a guard holds, if any, and waits for its zero: for who ends the process otherwise. Safe in a signal handler.
StopResult stop_guarded_device() noexcept;

}  // namespace catena::app
