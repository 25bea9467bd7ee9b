#include "engine/app/hand/signals.h"

#include <fmt/core.h>
#include <unistd.h>
#include <algorithm>
#include <atomic>
#include <cerrno>
#include <cstring>
#include <ctime>

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

void forget_signals() {
  asked_to_end = false;
  first_signal = 0;
}

std::string word_of_signal(int signal_number) {
  if (const char* word = sigabbrev_np(signal_number)) return fmt::format("SIG{} ({})", word, sigdescr_np(signal_number));
  return fmt::format("signal {}", signal_number);
}

}  // namespace

Interrupt::Interrupt() {
  forget_signals();
  for (const int signal_number : kAsking) take(signal_number, false, 0);
  // what somebody handles or ignores ends nothing
  for (const int signal_number : kEnding) take(signal_number, true, 0);
  for (int signal_number = SIGRTMIN; signal_number <= SIGRTMAX; ++signal_number) take(signal_number, true, 0);
}

Interrupt::Interrupt(const std::vector<int>& asking) {
  forget_signals();
  for (const int signal_number : asking) take(signal_number, false, static_cast<int>(SA_RESETHAND));
}

void Interrupt::take(int signal_number, bool only_default, int flags) {
  struct sigaction action {};
  action.sa_handler = on_signal;
  action.sa_flags = flags;
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

namespace {

constexpr std::size_t kStackBytes = 64 * 1024;
constexpr int kMaxWaitMs = 1000;

std::atomic<haptics::Device*> held{nullptr};
static_assert(std::atomic<haptics::Device*>::is_always_lock_free, "a signal handler reads it");

const char* line_of(int signal_number) {
  switch (signal_number) {
    case SIGSEGV:
      return "catena: ended by SIGSEGV (a bug, or a stack that is full)";
    case SIGBUS:
      return "catena: ended by SIGBUS (a file that was cut while it was read, or a bug)";
    case SIGFPE:
      return "catena: ended by SIGFPE (a bug)";
    case SIGILL:
      return "catena: ended by SIGILL (a bug, or another kind of processor)";
    case SIGSYS:
      return "catena: ended by SIGSYS (a system call that is not allowed here)";
    case SIGTRAP:
      return "catena: ended by SIGTRAP";
    case SIGQUIT:
      return "catena: ended by SIGQUIT";
    default:
      return "";  // SIGABRT: who aborts has said why
  }
}

void say(const char* words) { [[maybe_unused]] const auto written = write(STDERR_FILENO, words, std::strlen(words)); }

void on_crash(int signal_number) {
  const int error = errno;
  if (const LetGo done = let_go(); done != LetGo::nobody) {
    const char* line = line_of(signal_number);
    say(line);
    if (done == LetGo::unconfirmed)
      say(*line == 0 ? "catena: the device has not confirmed that it is off\n" : "; the device has not confirmed that it is off\n");
    else if (*line != 0)
      say("; the device is off\n");
  }
  std::signal(signal_number, SIG_DFL);
  std::raise(signal_number);  // as soon as this handler returns
  errno = error;
}

}  // namespace

LetGo let_go() noexcept {
  haptics::Device* device = held.exchange(nullptr);
  if (device == nullptr) return LetGo::nobody;
  device->stop();
  for (int waited_ms = 0; waited_ms < kMaxWaitMs; ++waited_ms) {
    if (device->at_rest()) return LetGo::off;
    const timespec nap{.tv_sec = 0, .tv_nsec = 1'000'000};
    nanosleep(&nap, nullptr);
  }
  return LetGo::unconfirmed;
}

CrashGuard::CrashGuard(haptics::Device& device) : stack_(kStackBytes) {
  stack_t stack{};
  stack.ss_sp = stack_.data();
  stack.ss_size = stack_.size();
  sigaltstack(&stack, &stack_before_);
  held = &device;
  struct sigaction action {};
  action.sa_handler = on_crash;
  action.sa_flags = SA_ONSTACK;
  sigemptyset(&action.sa_mask);
  for (std::size_t i = 0; i < kSignals.size(); ++i) sigaction(kSignals[i], &action, &before_[i]);
}

CrashGuard::~CrashGuard() {
  for (std::size_t i = 0; i < kSignals.size(); ++i) sigaction(kSignals[i], &before_[i], nullptr);
  held = nullptr;
  sigaltstack(&stack_before_, nullptr);
}

}  // namespace catena::app
