/// Ctrl-C, Ctrl-Z, a closed terminal or pipe and `kill` as a flag to look at: work that holds a device ends by its own way out, for a
/// process that is killed or suspended leaves the last force at the device. So do the signals that would end the program otherwise:
/// user signals, timers, limits on processor time, real-time signals; these are an error of the machine. Crashes: crash_guard.h.
/// One at a time.
#pragma once
#include <atomic>
#include <csignal>
#include <vector>

#include "engine/base/result.h"

namespace catena::app {

class Interrupt {
 public:
  Interrupt();
  explicit Interrupt(std::vector<int> asking);  ///< only these
  ~Interrupt();                                 ///< as it was before
  Interrupt(const Interrupt&) = delete;
  Interrupt& operator=(const Interrupt&) = delete;

  bool asked() const { return flag(); }
  const std::atomic<bool>& flag() const;
  /// An error ("ended by SIGXCPU (CPU time limit exceeded)") if it was not a person who asked.
  Outcome outcome() const;

 private:
  void take(int signal_number, bool only_default);

  struct Before {
    int signal_number;
    struct sigaction action;
  };
  std::vector<Before> before_;
};

/// The work was asked to end because the reader of its output has gone.
bool ended_by_broken_pipe();

}  // namespace catena::app
