/// Ctrl-C, Ctrl-Z, a closed terminal or pipe and `kill` as a flag to look at: work that holds a device ends by its own way out, for a
/// process that is killed or suspended leaves the last force at the device. Crashes: crash_guard.h. One at a time.
#pragma once
#include <atomic>
#include <csignal>
#include <vector>

namespace catena::app {

class Interrupt {
 public:
  explicit Interrupt(std::vector<int> signals = {SIGINT, SIGTERM, SIGHUP, SIGPIPE, SIGTSTP});
  ~Interrupt();  ///< as it was before
  Interrupt(const Interrupt&) = delete;
  Interrupt& operator=(const Interrupt&) = delete;

  bool asked() const { return flag(); }
  const std::atomic<bool>& flag() const;

 private:
  std::vector<int> signals_;
  std::vector<struct sigaction> before_;
};

}  // namespace catena::app
