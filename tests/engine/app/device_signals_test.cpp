// SPDX-License-Identifier: MIT
// Effects of signals on a program that holds a device: requests to end, and crashes.
#include <gtest/gtest.h>
#include <unistd.h>

#include <cstdlib>
#include <new>
#include <system_error>
#include <thread>

#include "engine/app/cli/process_limits.h"
#include "engine/app/haptics/signal_handlers.h"
#include "engine/base/result.h"
#include "haptics/device/device.h"

namespace catena::device_signals_test {

using namespace catena::haptics;

/// A device that reports its stop() on stderr, where the death tests look for it.
class Last final : public Device {
 public:
  const DeviceCapabilities& capabilities() const override { return capabilities_; }
  DeviceInput read() noexcept override { return {}; }
  void write(const DeviceOutput&) noexcept override {}
  void stop() noexcept override {
    constexpr char kText[] = "let go\n";
    [[maybe_unused]] const auto written = ::write(STDERR_FILENO, kText, sizeof kText - 1);
  }
  bool zero_force_confirmed() const noexcept override { return asked_++ >= asks_until_rest_; }
  int asks_until_rest_ = 0;

 private:
  mutable int asked_ = 0;
  DeviceCapabilities capabilities_;
};

struct CrashGuardDeathTest : testing::Test {
  CrashGuardDeathTest() { GTEST_FLAG_SET(death_test_style, "threadsafe"); }
  /// Runs the function in another thread, with the device guarded.
  void guarded(void (*ends)(), bool prepared = true) {
    EXPECT_TRUE(!prepared || app::prepare_process());
    const app::CrashGuard guard(device);
    std::thread(ends).join();
  }
  void guarded_signal(int signal_number, int asks = 0) {
    device.asks_until_rest_ = asks;
    const app::CrashGuard guard(device);
    std::raise(signal_number);
  }
  Last device;
};

TEST_F(CrashGuardDeathTest, AnAssertionStopsTheDeviceAndAborts) {
  EXPECT_EXIT(guarded([] { CATENA_ASSERT(1 + 1 == 3); }, false), testing::KilledBySignal(SIGABRT), "let go");
}

TEST_F(CrashGuardDeathTest, EveryCrashSignalStopsTheDeviceAndKeepsItsExitStatus) {
  for (const int signal_number : {SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGSYS, SIGTRAP, SIGQUIT})
    EXPECT_EXIT(guarded_signal(signal_number), testing::KilledBySignal(signal_number), "let go") << signal_number;
}

// A confirmation of zero force is awaited for long enough that a busy machine's device thread can give it.
TEST_F(CrashGuardDeathTest, TheDeviceIsReportedOffOnlyOnceConfirmed) {
  const auto trapped = testing::KilledBySignal(SIGTRAP);
  EXPECT_EXIT(guarded_signal(SIGTRAP, 200), trapped, "let go\ncatena: ended by SIGTRAP; the device is off\n$");
  EXPECT_EXIT(guarded_signal(SIGTRAP, 1 << 20), trapped, "ended by SIGTRAP; the device has not confirmed that it is off\n$");
}

TEST_F(CrashGuardDeathTest, AfterTheGuardsLifetimeNoDeviceIsStopped) {
  const auto crash = [&] {
    { const app::CrashGuard guard(device); }
    std::raise(SIGQUIT);
  };
  EXPECT_EXIT(crash(), testing::KilledBySignal(SIGQUIT), "^$");
}

#ifndef __SANITIZE_ADDRESS__  // AddressSanitizer has a handler of its own
// A stack overflow in the first thread leaves no room for a signal handler except on an alternate stack.
TEST_F(CrashGuardDeathTest, AStackOverflowStopsTheDevice) {
  struct Fill {
    static int deeper(int n) {
      volatile char page[4096];
      page[n % 4096] = 1;
      return n > 100'000'000 ? page[0] : deeper(n + 1) + page[1];
    }
  };
  const auto crash = [&] {
    const app::CrashGuard guard(device);
    std::exit(Fill::deeper(0));
  };
  EXPECT_EXIT(crash(), testing::KilledBySignal(SIGSEGV), "let go\ncatena: ended by SIGSEGV");
}
#endif

TEST_F(CrashGuardDeathTest, AnUncaughtExceptionStopsTheDeviceAndIsOneMessage) {
  const auto failed = testing::ExitedWithCode(1);
  EXPECT_EXIT(guarded([] { throw std::system_error(EAGAIN, std::generic_category(), "a thread"); }), failed,
              "let go\ncatena: no other thread can be started: Resource");
  EXPECT_EXIT(guarded([] { throw std::bad_alloc(); }), failed, "let go\ncatena: out of memory: .*\n$");
}

TEST(Interrupt, TerminatingSignalsAreSystemFailures) {
  for (const int signal_number : {SIGUSR1, SIGUSR2, SIGALRM, SIGVTALRM, SIGPROF, SIGXCPU, SIGIO, SIGPWR, SIGSTKFLT, SIGRTMIN, SIGRTMAX}) {
    const app::InterruptHandler interrupt;
    EXPECT_TRUE(interrupt.outcome());
    std::raise(signal_number);
    EXPECT_TRUE(interrupt.is_requested()) << signal_number;
    const Outcome ended = interrupt.outcome();
    ASSERT_FALSE(ended);
    EXPECT_TRUE(ended.error().system_failure);
    EXPECT_TRUE(ended.error().message.starts_with("ended by ")) << ended.error().message;
  }
  const app::InterruptHandler interrupt;
  std::raise(SIGTERM);
  std::raise(SIGUSR1);
  EXPECT_TRUE(interrupt.outcome()) << "the first one counts: a person asked";
}

TEST(Interrupt, WithoutADeviceASecondSignalEndsTheProgramAtOnce) {
  const auto asked = [](int times) {
    const app::InterruptHandler interrupt({SIGINT, SIGTERM});
    for (int k = 0; k < times; ++k) std::raise(SIGINT);
    std::exit(interrupt.is_requested() ? 7 : 8);
  };
  EXPECT_EXIT(asked(1), testing::ExitedWithCode(7), "");
  EXPECT_EXIT(asked(2), testing::KilledBySignal(SIGINT), "");
}

TEST(Interrupt, SignalsThatAreIgnoredStayIgnored) {
  std::signal(SIGUSR1, SIG_IGN);
  const app::InterruptHandler interrupt;
  std::raise(SIGUSR1);
  EXPECT_FALSE(interrupt.is_requested());
  std::signal(SIGUSR1, SIG_DFL);
}

// Also a closed pipe and Ctrl-Z: a process that is stopped or killed leaves the last force on the device.
TEST(Interrupt, SignalsThatEndOrSuspendTheProgramAreOnlyRequests) {
  for (const int signal_number : {SIGINT, SIGTERM, SIGHUP, SIGPIPE, SIGTSTP}) {
    const auto before = std::signal(signal_number, SIG_IGN);
    {
      const app::InterruptHandler interrupt;
      EXPECT_FALSE(interrupt.is_requested());
      std::raise(signal_number);
      EXPECT_TRUE(interrupt.is_requested()) << signal_number;
      EXPECT_TRUE(interrupt.flag());
    }
    EXPECT_EQ(std::signal(signal_number, before), SIG_IGN) << "as it was before";
  }
}

}  // namespace catena::device_signals_test
