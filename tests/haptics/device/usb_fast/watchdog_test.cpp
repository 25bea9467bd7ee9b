// SPDX-License-Identifier: MIT
/// The watchdog (haptics/watchdog) and the driver's side of it in one process: the watchdog runs on a thread, and a stopped program is
/// simulated by suspending the driver's threads in a signal handler, at any instruction outside the kernel, as SIGSTOP would.
/// Asserts order and counts.
#include <gtest/gtest.h>
#include <sys/socket.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <csignal>
#include <filesystem>
#include <set>

#include "haptics/watchdog/watch.h"
#include "tests/haptics/device/usbfs/in_process_bus.h"
#include "tests/haptics/device/usbfs/wrap_source.h"

namespace catena::haptics::tests::watchdog_test {

using watchdog::EndReason;
using watchdog::Holder;

std::atomic<bool> suspend{false};
std::atomic<int> suspended_count{0};
thread_local bool asked_in_kernel = false;

void suspend_here() {
  const int error = errno;
  ++suspended_count;
  while (suspend) {
    timespec nap{0, 200000};
    nanosleep(&nap, nullptr);
  }
  --suspended_count;
  errno = error;
}
void on_signal(int) {
  if (InProcessBus::in_kernel())
    asked_in_kernel = true;
  else
    suspend_here();
}
void on_return() {
  if (std::exchange(asked_in_kernel, false)) suspend_here();
}

std::set<int> threads() {
  std::set<int> all;
  for (const auto& entry : std::filesystem::directory_iterator("/proc/self/task")) all.insert(std::stoi(entry.path().filename()));
  return all;
}

/// Suspends threads for its lifetime.
class SuspendedThreads {
 public:
  explicit SuspendedThreads(const std::set<int>& ids) {
    struct sigaction action {};
    action.sa_handler = on_signal;
    action.sa_flags = SA_RESTART;
    sigaction(SIGRTMIN + 3, &action, nullptr);
    InProcessBus::on_return(on_return);
    suspend = true;
    for (const int id : ids) syscall(SYS_tgkill, getpid(), id, SIGRTMIN + 3);
    const int all = static_cast<int>(ids.size());
    EXPECT_TRUE(wait_until([&] { return suspended_count == all; }));
  }
  ~SuspendedThreads() {
    suspend = false;
    EXPECT_TRUE(wait_until([] { return suspended_count == 0; }));
  }
  SuspendedThreads(const SuspendedThreads&) = delete;
  SuspendedThreads& operator=(const SuspendedThreads&) = delete;
};

class OnAThread final : public usb::ExternalWatchdog {
 public:
  OnAThread(watchdog::SharedPage& page, int usb) {
    const int made = socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, line_);
    EXPECT_EQ(made, 0);
    thread_ = std::thread([this, &page, usb] {
      id = static_cast<int>(syscall(SYS_gettid));
      ended = run_watchdog(page, usb, line_[1], -1);
      has_ended = true;
    });
    while (id == 0) std::this_thread::yield();
  }
  ~OnAThread() override {
    ::close(line_[0]);
    thread_.join();
    ::close(line_[1]);
  }
  bool is_alive() noexcept override { return !has_ended; }
  void quit() noexcept override { EXPECT_EQ(::send(line_[0], &watchdog::kQuit, 1, 0), 1); }

  std::atomic<int> id{0};
  std::atomic<bool> has_ended{false};
  EndReason ended = EndReason::requested;

 private:
  int line_[2] = {-1, -1};
  std::thread thread_;
};

/// Commands a force in each tick, as a servo would: after a read that is not ready the force ramps in from zero.
class Ticks {
 public:
  static constexpr int kRampTicks = 60;
  static constexpr double kForceN = 3;

  explicit Ticks(usb::Falcon& falcon) : falcon_(falcon) {
    falcon_.resume();
    thread_ = std::thread([this] { run(); });
    while (id == 0) std::this_thread::yield();
  }
  ~Ticks() {
    stop_ = true;
    thread_.join();
  }
  std::atomic<int> id{0};
  std::atomic<std::uint64_t> lost{0};
  std::atomic<int> since{0};  ///< ticks since the last read that was not ready, up to kRampTicks
  std::atomic<bool> pushes{true};

 private:
  void run() {
    id = static_cast<int>(syscall(SYS_gettid));
    while (!stop_) {
      const DeviceInput input = falcon_.read();
      const bool good = input.status == DeviceStatus::ready;
      if (!good) ++lost;
      since = good && pushes ? std::min(since + 1, kRampTicks) : 0;  // set before the write, so that no packet precedes it
      falcon_.write({.force_n = Vec3(0, 0, kForceN * since / kRampTicks)});
      std::this_thread::sleep_for(std::chrono::microseconds(300));
    }
  }
  usb::Falcon& falcon_;
  std::atomic<bool> stop_{false};
  std::thread thread_;
};

/// An armed Falcon with a commanded force, its watchdog, and all forces of its motors.
class Rig {
 public:
  Rig() {
    usb::FalconOptions options = patient_options();
    options.watchdog = [this](usb::Transport& transport, const usb::WatchdogSharedMemory& memory) {
      page = &memory.page();
      auto made = std::make_unique<OnAThread>(memory.page(), transport.descriptor());
      watchdog = made.get();
      return Result<std::unique_ptr<usb::ExternalWatchdog>>(std::move(made));
    };
    const std::set<int> before = threads();
    falcon = test::value_of(usb::Falcon::open(std::make_unique<WrapSource>(bus.fd()), std::move(options)));
    for (const int id : threads())
      if (!before.contains(id) && id != watchdog->id) io_threads.insert(id);
    EXPECT_EQ(io_threads.size(), 1u);
    EXPECT_TRUE(move_grip(bus, {0.165, 0.175, 0.165, 0.155, 0.145, 0.13}));
    EXPECT_TRUE(wait_until([&] { return falcon->state() == usb::FalconState::ready; }));
    ticks = std::make_unique<Ticks>(*falcon);
    bus.with(
        [&](EmulatedFalcon& device) { device.set_exchange_observer([&](const EmulatedFalcon::Exchange& e) { add(norm(e.force_n)); }); });
  }
  ~Rig() {
    bus.with([](EmulatedFalcon& device) { device.set_exchange_observer(nullptr); });
    ticks.reset();
    falcon.reset();
  }
  std::set<int> all_threads() const {
    std::set<int> ids = io_threads;
    ids.insert(ticks->id);
    return ids;
  }
  double last() {
    return bus.with([&](EmulatedFalcon&) { return forces.empty() ? 0.0 : forces.back(); });
  }
  bool pushes_fully() {
    return wait_until([&] { return last() > 0.97 * Ticks::kForceN; });
  }
  /// Waits for the full force in a packet after `from` + 1: a packet of the old force may have been in flight.
  bool pushes_fully_after(std::size_t from) {
    return wait_until([&] { return packets() > from + 1 && last() > 0.97 * Ticks::kForceN; });
  }
  std::size_t packets() {
    return bus.with([&](EmulatedFalcon&) { return forces.size(); });
  }

  InProcessBus bus{{.homed = true}};
  watchdog::SharedPage* page = nullptr;
  OnAThread* watchdog = nullptr;
  std::unique_ptr<usb::Falcon> falcon;
  std::unique_ptr<Ticks> ticks;
  std::set<int> io_threads;
  std::vector<double> forces;     ///< guarded by the port's mutex
  std::vector<double> commanded;  ///< maximum force that the haptic thread can have commanded at each packet; guarded by the port's mutex

 private:
  void add(double force_n) {
    forces.push_back(force_n);
    commanded.push_back(Ticks::kForceN * ticks->since / Ticks::kRampTicks);
  }
};

void suspend_at_random(Rig& rig, bool ticks_too, int times) {
  std::uint64_t state = 88172645463325252u;
  for (int i = 0; i < times && !testing::Test::HasFailure(); ++i) {
    EXPECT_TRUE(rig.pushes_fully()) << i;
    state ^= state << 13, state ^= state >> 7, state ^= state << 17;
    const std::int64_t until = now_ns() + static_cast<std::int64_t>(state % 2000000);
    while (now_ns() < until) {
    }
    const std::uint32_t zeros = rig.page->acknowledged_zeros, takeovers = rig.page->takeovers;
    const std::uint64_t lost = rig.ticks->lost;
    std::size_t after_zero = 0;
    {
      const SuspendedThreads stopped(ticks_too ? rig.all_threads() : rig.io_threads);
      EXPECT_TRUE(wait_until([&] { return rig.page->acknowledged_zeros > zeros; })) << i;
      after_zero = rig.packets();
      EXPECT_EQ(rig.last(), 0) << i;
      // the watchdog keeps sending zeros and nothing else
      EXPECT_TRUE(wait_until([&] { return rig.page->acknowledged_zeros > zeros + 1; })) << i;
      EXPECT_EQ(rig.page->holder, Holder::watchdog);
      EXPECT_GE(rig.page->takeovers, takeovers + 1);
      const double maximum = rig.bus.with([&](EmulatedFalcon&) {
        return *std::max_element(rig.forces.begin() + static_cast<std::ptrdiff_t>(after_zero) - 1, rig.forces.end());
      });
      EXPECT_EQ(maximum, 0) << i;
      after_zero = rig.packets();
    }
    EXPECT_TRUE(rig.pushes_fully_after(after_zero)) << i;
    if (testing::Test::HasFailure()) break;
    EXPECT_GT(rig.ticks->lost, lost) << "the haptic thread has been told";
    // threads that got no processor cause another takeover, so that the ramp is interrupted and not checked
    if (rig.page->takeovers != takeovers + 1) {
      rig.bus.with([&](EmulatedFalcon&) { rig.forces.clear(), rig.commanded.clear(); });
      continue;
    }
    EXPECT_EQ(rig.page->holder, Holder::program);
    // packets: at most one of the old force, zeros, then a monotonic ramp from zero
    rig.bus.with([&](EmulatedFalcon&) {
      std::size_t k = after_zero;
      if (rig.forces[k] > 0.5 * Ticks::kForceN) ++k;
      EXPECT_EQ(rig.forces[k], 0) << i;
      while (k < rig.forces.size() && rig.forces[k] == 0) ++k;
      EXPECT_LE(rig.forces[k], rig.commanded[k] + 0.05) << i;  // an I/O thread that waits for a processor may skip the first steps
      for (; k + 1 < rig.forces.size(); ++k) EXPECT_GE(rig.forces[k + 1], rig.forces[k] - 0.05) << i << " " << k;
      rig.forces.clear(), rig.commanded.clear();
    });
  }
}

TEST(Watchdog, WhenAllThreadsAreSuspendedTheForceIsZeroThenRampsIn) {
  Rig rig;
  suspend_at_random(rig, true, 40);
  EXPECT_EQ(rig.falcon->stats().takeovers, rig.page->takeovers);
}

TEST(Watchdog, WhenTheDriversThreadHangsTheForceIsZeroThenRampsIn) {
  Rig rig;
  suspend_at_random(rig, false, 10);
}

TEST(Watchdog, ADeviceWithoutForceGetsNoPackets) {
  Rig rig;
  rig.ticks->pushes = false;
  ASSERT_TRUE(wait_until([&] { return rig.last() == 0 && rig.page->force_active == 0; }));
  const std::uint64_t bulks = rig.bus.port().counts.bulks;
  {
    // checked only if no packet with a force is in flight at the stop
    const SuspendedThreads stopped(rig.all_threads());
    if (rig.page->force_active == 0) {
      std::this_thread::sleep_for(std::chrono::milliseconds(150));
      EXPECT_EQ(rig.page->takeovers, 0u);
      EXPECT_EQ(rig.bus.port().counts.bulks, bulks);
    }
  }
}

TEST(Watchdog, AStalledEndpointIsClearedAndABlockedOneRetried) {
  Rig rig;
  ASSERT_TRUE(rig.pushes_fully());
  {
    const SuspendedThreads stopped(rig.all_threads());
    // read here, because an earlier takeover may have sent zeros
    const std::uint32_t zeros = rig.page->acknowledged_zeros;
    rig.bus.with([](EmulatedFalcon& device) { device.halt(EmulatedFalcon::kEndpointOut); });
    ASSERT_TRUE(wait_until([&] { return rig.page->acknowledged_zeros > zeros; }));
    EXPECT_GE(rig.bus.port().counts.clear_halts, 1u);
    EXPECT_EQ(rig.last(), 0);
  }
  ASSERT_TRUE(rig.pushes_fully());
  rig.bus.with([&](EmulatedFalcon&) { rig.bus.port().faults.out_naks = true; });
  {
    const SuspendedThreads stopped(rig.all_threads());
    const std::uint64_t bulks = rig.bus.port().counts.bulks;
    ASSERT_TRUE(wait_until([&] { return rig.bus.port().counts.bulks > bulks + 3; })) << "it tries on";
    const std::uint32_t zeros = rig.page->acknowledged_zeros;
    rig.bus.with([&](EmulatedFalcon&) { rig.bus.port().faults.out_naks = false; });
    ASSERT_TRUE(wait_until([&] { return rig.page->acknowledged_zeros > zeros; }));
    EXPECT_EQ(rig.last(), 0) << "behind the packet that was queued";
  }
  EXPECT_TRUE(rig.pushes_fully());
}

TEST(Watchdog, AnUnpluggedDeviceEndsTheWatchdog) {
  Rig rig;
  ASSERT_TRUE(rig.pushes_fully());
  const SuspendedThreads stopped(rig.all_threads());
  rig.bus.unplug();
  EXPECT_TRUE(wait_until([&] { return rig.watchdog->has_ended.load(); }));
  EXPECT_EQ(rig.watchdog->ended, EndReason::device_gone);
}

TEST(Watchdog, AfterTheProgramIsGoneItSendsZerosAndEnds) {
  InProcessBus bus({.homed = true});
  auto memory = usb::WatchdogSharedMemory::make(0x02, usb::encode_command({}));
  ASSERT_TRUE(memory);
  { const OnAThread gone((*memory)->page(), bus.fd()); }
  EXPECT_EQ((*memory)->page().acknowledged_zeros, 2u);
  EXPECT_EQ(bus.port().counts.bulks, 2u);
  {
    OnAThread stopped((*memory)->page(), bus.fd());
    stopped.quit();
    EXPECT_TRUE(wait_until([&] { return stopped.has_ended.load(); }));
    EXPECT_EQ(stopped.ended, EndReason::requested);
  }
  EXPECT_EQ(bus.port().counts.bulks, 2u) << "told to end, it writes nothing";
}

TEST(Watchdog, ADeadWatchdogIsRestartedAndTheForceReturns) {
  Rig rig;
  ASSERT_TRUE(rig.pushes_fully());
  OnAThread* const first = rig.watchdog;
  // the watchdog ends
  first->quit();
  EXPECT_TRUE(wait_until([&] { return rig.falcon->stats().watchdog_restarts == 1; }));
  EXPECT_TRUE(rig.pushes_fully());
  EXPECT_NE(rig.watchdog, nullptr);
}

TEST(Watchdog, TheDeviceIsNotOpenedIfTheWatchdogCannotStart) {
  InProcessBus bus({.homed = true});
  usb::FalconOptions options = patient_options();
  options.watchdog = usb::make_watchdog_launcher("/no/such/program");
  EXPECT_TRUE(test::fails(usb::Falcon::open(std::make_unique<WrapSource>(bus.fd()), std::move(options)), "/no/such/program"));
}

}  // namespace catena::haptics::tests::watchdog_test
