// SPDX-License-Identifier: MIT
#include "engine/app/haptics/signal_handlers.h"

#include <fmt/core.h>
#include <sys/resource.h>
#include <unistd.h>
#include <algorithm>
#include <atomic>
#include <cerrno>
#include <cstring>
#include <ctime>

#include "engine/base/console.h"

namespace catena::app {

namespace {

constexpr int kAsking[] = {SIGINT, SIGTERM, SIGHUP, SIGPIPE, SIGTSTP};
constexpr int kEnding[] = {SIGUSR1, SIGUSR2, SIGALRM, SIGVTALRM, SIGPROF, SIGXCPU, SIGIO, SIGPWR, SIGSTKFLT};

std::atomic<bool> asked_to_end{false};
std::atomic<int> first_signal{0};
static_assert(std::atomic<bool>::is_always_lock_free && std::atomic<int>::is_always_lock_free, "a signal handler sets them");

constexpr unsigned kGraceS = 30;
std::atomic<bool> grace_runs{false};

void say(const char* words) { [[maybe_unused]] const auto written = write(STDERR_FILENO, words, std::strlen(words)); }

/// Ends the program by its first signal: after kGraceS it has not reacted to the request, for example because a graphics driver hangs.
void end_by_first_signal() {
  stop_guarded_device();
  say("catena: did not end within 30 s of the request: ended at once\n");
  std::signal(first_signal, SIG_DFL);
  std::raise(first_signal);
}

void on_crash(int signal_number);

void on_signal(int signal_number) {
  const int error = errno;
  if (signal_number == SIGALRM && grace_runs) end_by_first_signal();
  int none = 0;
  if (first_signal.compare_exchange_strong(none, signal_number)) {
    grace_runs = true;
    alarm(kGraceS);
  }
  asked_to_end.store(true);
  errno = error;
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

InterruptHandler::InterruptHandler() {
  forget_signals();
  for (const int signal_number : kAsking) install(signal_number, false, 0);
  // signals that have a handler or are ignored are left unchanged
  for (const int signal_number : kEnding) install(signal_number, true, 0);
  for (int signal_number = SIGRTMIN; signal_number <= SIGRTMAX; ++signal_number) install(signal_number, true, 0);
}

InterruptHandler::InterruptHandler(const std::vector<int>& signals) {
  forget_signals();
  for (const int signal_number : signals) install(signal_number, false, static_cast<int>(SA_RESETHAND));
  install(SIGALRM, true, 0);
}

void InterruptHandler::install(int signal_number, bool only_default, int flags) {
  struct sigaction action {};
  action.sa_handler = on_signal;
  action.sa_flags = flags;
  sigemptyset(&action.sa_mask);
  SavedAction before{signal_number, {}};
  if (sigaction(signal_number, nullptr, &before.action) != 0) return;
  if (only_default &&
      ((before.action.sa_flags & SA_SIGINFO) != 0 || (before.action.sa_handler != SIG_DFL && before.action.sa_handler != on_crash)))
    return;
  sigaction(signal_number, &action, nullptr);
  saved_actions_.push_back(before);
}

InterruptHandler::~InterruptHandler() {
  if (grace_runs.exchange(false)) alarm(0);
  for (const SavedAction& before : saved_actions_) sigaction(before.signal_number, &before.action, nullptr);
}

const std::atomic<bool>& InterruptHandler::flag() const { return asked_to_end; }

Outcome InterruptHandler::outcome() const {
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
      return "catena: ended by SIGSEGV (a bug, or a stack overflow)";
    case SIGBUS:
      return "catena: ended by SIGBUS (a file was truncated while it was read, or a bug)";
    case SIGFPE:
      return "catena: ended by SIGFPE (a bug)";
    case SIGILL:
      return "catena: ended by SIGILL (a bug, or an unsupported processor)";
    case SIGSYS:
      return "catena: ended by SIGSYS (a system call that is not permitted)";
    case SIGTRAP:
      return "catena: ended by SIGTRAP";
    case SIGXCPU:
      return "catena: ended by SIGXCPU (the limit on processor time: ulimit -t)";
    case SIGQUIT:
      return "catena: ended by SIGQUIT";
    default:
      return assertion_was_reported() ? "" : "catena: ended by SIGABRT (a library aborted, or another process sent the signal)";
  }
}

/// Returns true if a crash is attributed to a lack of memory: with RLIMIT_AS set, libraries such as graphics drivers crash when an
/// allocation fails.
bool lacks_memory(int signal_number) {
  rlimit limit{};
  return (signal_number == SIGSEGV || signal_number == SIGBUS || (signal_number == SIGABRT && !assertion_was_reported())) &&
         ::getrlimit(RLIMIT_AS, &limit) == 0 && limit.rlim_cur != RLIM_INFINITY;
}

void on_crash(int signal_number) {
  const int error = errno;
  const StopResult done = stop_guarded_device();
  const bool limited = lacks_memory(signal_number);
  const char* line = limited ? "catena: ended by a crash: too little memory (ulimit -v), or a bug" : line_of(signal_number);
  say(line);
  if (done == StopResult::unconfirmed)
    say(*line == 0 ? "catena: the device has not confirmed that it is off\n" : "; the device has not confirmed that it is off\n");
  else if (*line != 0)
    say(done == StopResult::stopped ? "; the device is off\n" : "\n");
  if (signal_number == SIGXCPU || limited) _exit(1);  // exceeding a limit is no crash
  std::signal(signal_number, SIG_DFL);
  std::raise(signal_number);  // takes effect when this handler returns
  errno = error;
}

}  // namespace

StopResult stop_guarded_device() noexcept {
  haptics::Device* device = held.exchange(nullptr);
  if (device == nullptr) return StopResult::no_device;
  device->stop();
  for (int waited_ms = 0; waited_ms < kMaxWaitMs; ++waited_ms) {
    if (device->zero_force_confirmed()) return StopResult::stopped;
    const timespec nap{.tv_sec = 0, .tv_nsec = 1'000'000};
    nanosleep(&nap, nullptr);
  }
  return StopResult::unconfirmed;
}

void install_crash_reporter() {
  static std::array<char, kStackBytes> stack_of_first_thread;
  stack_t stack{};
  stack.ss_sp = stack_of_first_thread.data();
  stack.ss_size = stack_of_first_thread.size();
  sigaltstack(&stack, nullptr);
  for (const int signal_number : {SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGSYS, SIGABRT, SIGXCPU}) {
    struct sigaction before {};
    // keeps an existing handler, such as a sanitizer's
    if (sigaction(signal_number, nullptr, &before) != 0 || (before.sa_flags & SA_SIGINFO) != 0 || before.sa_handler != SIG_DFL) continue;
    struct sigaction action {};
    action.sa_handler = on_crash;
    action.sa_flags = SA_ONSTACK;
    sigemptyset(&action.sa_mask);
    sigaction(signal_number, &action, nullptr);
  }
}

CrashGuard::CrashGuard(haptics::Device& device) : stack_(kStackBytes) {
  stack_t stack{};
  stack.ss_sp = stack_.data();
  stack.ss_size = stack_.size();
  sigaltstack(&stack, &saved_stack_);
  held = &device;
  struct sigaction action {};
  action.sa_handler = on_crash;
  action.sa_flags = SA_ONSTACK;
  sigemptyset(&action.sa_mask);
  for (std::size_t i = 0; i < kSignals.size(); ++i) sigaction(kSignals[i], &action, &saved_actions_[i]);
}

CrashGuard::~CrashGuard() {
  for (std::size_t i = 0; i < kSignals.size(); ++i) sigaction(kSignals[i], &saved_actions_[i], nullptr);
  held = nullptr;
  sigaltstack(&saved_stack_, nullptr);
}

}  // namespace catena::app
