// SPDX-License-Identifier: MIT
// What signals do to a program that holds a device: asked to end, or crashed.
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

namespace hand_signals_test {

using namespace catena;
using namespace catena::haptics;

/// Says so on stderr when it is stopped: by then the process is dying.
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
  Last device;
};

TEST_F(CrashGuardDeathTest, AnAssertionLetsGoAndAborts) {
  const auto crash = [&] {
    const app::CrashGuard guard(device);
    std::thread([] { CATENA_ASSERT(1 + 1 == 3); }).join();
  };
  EXPECT_EXIT(crash(), testing::KilledBySignal(SIGABRT), "let go");
}

TEST_F(CrashGuardDeathTest, EveryCrashLetsGoAndEndsAsItWould) {
  for (const int signal_number : {SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGSYS, SIGTRAP, SIGQUIT}) {
    const auto crash = [&] {
      const app::CrashGuard guard(device);
      std::raise(signal_number);
    };
    EXPECT_EXIT(crash(), testing::KilledBySignal(signal_number), "let go") << signal_number;
  }
}

// before, 50 ms were waited, and "the device is off" was said of one whose thread had not had the processor yet
TEST_F(CrashGuardDeathTest, TheDeviceIsOffWhenItHasConfirmedIt) {
  const auto crash = [&](int asks) {
    device.asks_until_rest_ = asks;
    const app::CrashGuard guard(device);
    std::raise(SIGTRAP);
  };
  EXPECT_EXIT(crash(200), testing::KilledBySignal(SIGTRAP), "let go\ncatena: ended by SIGTRAP; the device is off\n$");
  EXPECT_EXIT(crash(1 << 20), testing::KilledBySignal(SIGTRAP), "ended by SIGTRAP; the device has not confirmed that it is off\n$");
}

TEST_F(CrashGuardDeathTest, AfterItsEndNobodyIsStopped) {
  const auto crash = [&] {
    { const app::CrashGuard guard(device); }
    std::raise(SIGQUIT);
  };
  EXPECT_EXIT(crash(), testing::KilledBySignal(SIGQUIT), "^$");
}

#ifndef __SANITIZE_ADDRESS__  // which has a handler of its own
// what fills the first thread's stack leaves none for a handler, but its own
TEST_F(CrashGuardDeathTest, AFullStackLetsGo) {
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

TEST_F(CrashGuardDeathTest, AnErrorThatNothingHandlesLetsGoAndIsOneSentence) {
  const auto end = [&] {
    EXPECT_TRUE(app::prepare_process());
    const app::CrashGuard guard(device);
    std::thread([] { throw std::system_error(EAGAIN, std::generic_category(), "a thread"); }).join();
  };
  EXPECT_EXIT(end(), testing::ExitedWithCode(1), "let go\ncatena: no other thread can be started: Resource");
  const auto full = [&] {
    EXPECT_TRUE(app::prepare_process());
    const app::CrashGuard guard(device);
    std::thread([] { throw std::bad_alloc(); }).join();
  };
  EXPECT_EXIT(full(), testing::ExitedWithCode(1), "let go\ncatena: out of memory: .*\n$");
}

TEST(Interrupt, WhatWouldEndTheProgramIsAnErrorOfTheMachine) {
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

TEST(Interrupt, WorkWithoutADeviceEndsAtOnceWhereItIsAskedAgain) {
  const auto asked = [](int times) {
    const app::InterruptHandler interrupt({SIGINT, SIGTERM});
    for (int k = 0; k < times; ++k) std::raise(SIGINT);
    std::exit(interrupt.is_requested() ? 7 : 8);
  };
  EXPECT_EXIT(asked(1), testing::ExitedWithCode(7), "");
  EXPECT_EXIT(asked(2), testing::KilledBySignal(SIGINT), "");
}

TEST(Interrupt, WhatSomebodyIgnoresOrHandlesIsLeftAlone) {
  std::signal(SIGUSR1, SIG_IGN);
  const app::InterruptHandler interrupt;
  std::raise(SIGUSR1);
  EXPECT_FALSE(interrupt.is_requested());
  std::signal(SIGUSR1, SIG_DFL);
}

// a closed pipe and Ctrl-Z, too: a process that is stopped or killed leaves the last force at the device
TEST(Interrupt, EverythingThatWouldEndOrSuspendTheProgramIsOnlyAsked) {
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

}  // namespace hand_signals_test
