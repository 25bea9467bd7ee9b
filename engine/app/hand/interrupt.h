/// Ctrl-C, Ctrl-Z, a closed terminal or pipe and `kill` as a flag to look at: work that holds a device ends by its own way out, for a
/// process that is killed or suspended leaves the last force at the device. Crashes: crash_guard.h. One at a time.
#pragma once
#include <array>
#include <atomic>
#include <csignal>

namespace catena::app {

class Interrupt {
 public:
  Interrupt();
  ~Interrupt();  ///< as it was before
  Interrupt(const Interrupt&) = delete;
  Interrupt& operator=(const Interrupt&) = delete;

  bool asked() const { return flag(); }
  const std::atomic<bool>& flag() const;

 private:
  static constexpr std::array kSignals{SIGINT, SIGTERM, SIGHUP, SIGPIPE, SIGTSTP};
  std::array<struct sigaction, kSignals.size()> before_{};
};

}  // namespace catena::app
