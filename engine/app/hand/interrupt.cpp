#include "engine/app/hand/interrupt.h"

#include <fmt/core.h>

#include <algorithm>
#include <cstring>

namespace catena::app {

namespace {

constexpr int kAsking[] = {SIGINT, SIGTERM, SIGHUP, SIGPIPE, SIGTSTP};
constexpr int kEnding[] = {SIGUSR1, SIGUSR2, SIGALRM, SIGVTALRM, SIGPROF, SIGXCPU, SIGIO, SIGPWR, SIGSTKFLT};

std::atomic<bool> asked_to_end{false};
std::atomic<int> first_signal{0};
static_assert(std::atomic<bool>::is_always_lock_free && std::atomic<int>::is_always_lock_free, "a signal handler sets them");

void on_signal(int signal_number) {
  int none = 0;
  first_signal.compare_exchange_strong(none, signal_number);
  asked_to_end.store(true);
}

std::string word_of_signal(int signal_number) {
  if (const char* word = sigabbrev_np(signal_number)) return fmt::format("SIG{} ({})", word, sigdescr_np(signal_number));
  return fmt::format("signal {}", signal_number);
}

}  // namespace

Interrupt::Interrupt() : Interrupt(std::vector<int>(std::begin(kAsking), std::end(kAsking))) {
  // what somebody handles or ignores ends nothing
  for (const int signal_number : kEnding) take(signal_number, true);
  for (int signal_number = SIGRTMIN; signal_number <= SIGRTMAX; ++signal_number) take(signal_number, true);
}

Interrupt::Interrupt(std::vector<int> asking) {
  asked_to_end = false;
  first_signal = 0;
  for (const int signal_number : asking) take(signal_number, false);
}

void Interrupt::take(int signal_number, bool only_default) {
  struct sigaction action {};
  action.sa_handler = on_signal;
  sigemptyset(&action.sa_mask);
  Before before{signal_number, {}};
  if (sigaction(signal_number, nullptr, &before.action) != 0) return;
  if (only_default && ((before.action.sa_flags & SA_SIGINFO) != 0 || before.action.sa_handler != SIG_DFL)) return;
  sigaction(signal_number, &action, nullptr);
  before_.push_back(before);
}

Interrupt::~Interrupt() {
  for (const Before& before : before_) sigaction(before.signal_number, &before.action, nullptr);
}

const std::atomic<bool>& Interrupt::flag() const { return asked_to_end; }

Outcome Interrupt::outcome() const {
  const int by = first_signal;
  if (by == 0 || std::find(std::begin(kAsking), std::end(kAsking), by) != std::end(kAsking)) return Done{};
  return Error{fmt::format("ended by {}; the device is off", word_of_signal(by)), true};
}

bool ended_by_broken_pipe() { return first_signal == SIGPIPE; }

}  // namespace catena::app
