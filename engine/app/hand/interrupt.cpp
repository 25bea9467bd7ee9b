#include "engine/app/hand/interrupt.h"

namespace catena::app {

namespace {
std::atomic<bool> asked_to_end{false};
static_assert(std::atomic<bool>::is_always_lock_free, "a signal handler may set it");
void on_signal(int) { asked_to_end.store(true); }
}  // namespace

Interrupt::Interrupt(std::vector<int> signals) : signals_(std::move(signals)), before_(signals_.size()) {
  asked_to_end = false;
  struct sigaction action {};
  action.sa_handler = on_signal;
  sigemptyset(&action.sa_mask);
  for (std::size_t i = 0; i < signals_.size(); ++i) sigaction(signals_[i], &action, &before_[i]);
}

Interrupt::~Interrupt() {
  for (std::size_t i = 0; i < signals_.size(); ++i) sigaction(signals_[i], &before_[i], nullptr);
}

const std::atomic<bool>& Interrupt::flag() const { return asked_to_end; }

}  // namespace catena::app
