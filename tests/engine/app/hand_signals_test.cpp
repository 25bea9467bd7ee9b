// What signals do to a program that holds a device: asked to end, or crashed.
#include <gtest/gtest.h>
#include <unistd.h>

#include <thread>

#include "engine/app/hand/crash_guard.h"
#include "engine/app/hand/interrupt.h"
#include "engine/base/assert.h"
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

 private:
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
  for (const int signal_number : {SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGQUIT}) {
    const auto crash = [&] {
      const app::CrashGuard guard(device);
      std::raise(signal_number);
    };
    EXPECT_EXIT(crash(), testing::KilledBySignal(signal_number), "let go") << signal_number;
  }
}

TEST_F(CrashGuardDeathTest, AfterItsEndNobodyIsStopped) {
  const auto crash = [&] {
    { const app::CrashGuard guard(device); }
    std::raise(SIGQUIT);
  };
  EXPECT_EXIT(crash(), testing::KilledBySignal(SIGQUIT), "^$");
}

// a closed pipe and Ctrl-Z, too: a process that is stopped or killed leaves the last force at the device
TEST(Interrupt, EverythingThatWouldEndOrSuspendTheProgramIsOnlyAsked) {
  for (const int signal_number : {SIGINT, SIGTERM, SIGHUP, SIGPIPE, SIGTSTP}) {
    const auto before = std::signal(signal_number, SIG_IGN);
    {
      const app::Interrupt interrupt;
      EXPECT_FALSE(interrupt.asked());
      std::raise(signal_number);
      EXPECT_TRUE(interrupt.asked()) << signal_number;
      EXPECT_TRUE(interrupt.flag());
    }
    EXPECT_EQ(std::signal(signal_number, before), SIG_IGN) << "as it was before";
  }
}

}  // namespace hand_signals_test
