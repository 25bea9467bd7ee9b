/// Ctrl-C, a closed terminal and `kill` as a flag to look at: work that holds a device ends by its own way out. One at a time.
#pragma once
#include <array>
#include <csignal>

namespace catena::app {

class Interrupt {
 public:
  Interrupt();
  ~Interrupt();  ///< as it was before
  Interrupt(const Interrupt&) = delete;
  Interrupt& operator=(const Interrupt&) = delete;

  bool asked() const;

 private:
  static constexpr std::array kSignals{SIGINT, SIGTERM, SIGHUP};
  std::array<struct sigaction, kSignals.size()> before_{};
};

}  // namespace catena::app
