// SPDX-License-Identifier: MIT
/// The program `catena` with a Falcon on umockdev's bus is killed and stopped at random moments: the last packet to the motors is zero.
/// The emulated device belongs to the test, outlives the program and records every packet. Asserts order and counts.
#include <gtest/gtest.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <filesystem>
#include <sstream>

#include "engine/base/clock.h"
#include "tests/haptics/device/usbfs/falcon_fixture.h"
#include "tests/haptics/device/usbfs/umockdev_bus.h"
#include "tests/support/support.h"

namespace catena::haptics::tests::watchdog_test {

constexpr const char* kScene = R"({
  "fields": {"ball": {"analytic": "sphere"}},
  "chain": [{"name": "surface", "type": "isosurface", "field": "ball", "level": 0.5, "free": "above"}],
  "coupling": {"stiffness": 400, "damping": 0, "max_force": 8},
  "device": {"type": "falcon", "ramp_in": 0.1},
  "workspace": {"metres_per_unit": 0.04, "origin": [0, 0, -0.125]} })";

struct Packet {
  std::int64_t ns = 0;
  double force_n = 0;
};

/// LD_PRELOAD with `library` added before umockdev's library and after a sanitizer's.
std::string before_umockdev(const std::string& library) {
  const std::string all = std::getenv("LD_PRELOAD");
  const std::size_t from = all.rfind(':', all.find("umockdev")) + 1;  // 0 without a ':', because npos + 1 is 0
  return all.substr(0, from) + library + ":" + all.substr(from);
}

/// A homed Falcon on the bus, and the program with a ball as its constraint.
class Rig {
 public:
  Rig() {
    test::write_file(folder / "ball.json", kScene);
    bus.with([&](EmulatedFalcon& device) {
      device.set_exchange_observer([&](const EmulatedFalcon::Exchange& e) { packets.push_back({now_ns(), norm(e.force_n)}); });
    });
  }
  ~Rig() {
    if (child > 0) kill(child, SIGKILL), wait();
  }

  void start() {
    // a new plug-in has empty queues
    if (std::exchange(plugged, true)) bus.unplug();
    bus.plug(true);
    const std::string command = "exec env LD_PRELOAD=" + before_umockdev(test::binary_dir() + "/libcatena_inherited_node.so") + " " +
                                test::program_path() + " feel " + (folder / "ball.json") + " --device falcon --forces on > " +
                                (folder / "out") + " 2> " + (folder / "err");
    const char* const arguments[] = {"/bin/sh", "-c", command.c_str(), nullptr};
    ASSERT_EQ(posix_spawn(&child, arguments[0], nullptr, nullptr, const_cast<char* const*>(arguments), environ), 0);
    const std::uint64_t frames = frame_count(bus);
    ASSERT_TRUE(wait_until([&] { return frame_count(bus) > frames + 3; })) << messages();
    // arms the device, then moves 10 mm into the ball
    ASSERT_TRUE(move_grip(bus, {0.155, 0.165, 0.175, 0.165, 0.155, 0.145, 0.135}));
  }
  bool pushes() {
    return wait_until([&] { return last().force_n > 1; });
  }
  int wait() {
    int status = 0;
    waitpid(std::exchange(child, 0), &status, 0);
    return status;
  }
  std::string messages() const { return test::read_file(folder / "err"); }

  /// Process id of the program's watchdog; 0 if none.
  int watchdog() const {
    for (const auto& task : std::filesystem::directory_iterator("/proc/" + std::to_string(child) + "/task")) {
      std::istringstream children(test::read_file(task.path() / "children"));
      for (int id = 0; children >> id;)
        if (test::read_file("/proc/" + std::to_string(id) + "/comm") == "catena-watchdog\n") return id;
    }
    return 0;
  }
  static bool is_running(int id) {
    const std::string state = test::read_file("/proc/" + std::to_string(id) + "/stat");
    return !state.empty() && state.find(") Z ") == std::string::npos;  // a zombie does not count
  }

  Packet last() {
    return bus.with([&](EmulatedFalcon&) { return packets.empty() ? Packet{} : packets.back(); });
  }
  std::size_t count() {
    return bus.with([&](EmulatedFalcon&) { return packets.size(); });
  }
  std::uint64_t bulks() {
    return bus.with([&](EmulatedFalcon&) { return bus.port().counts.bulks; });
  }
  std::vector<Packet> packets;  ///< guarded by the port's mutex; declared before the bus, whose thread adds to it
  UmockdevBus bus{{.homed = true}};
  test::TemporaryFolder folder;
  pid_t child = 0;
  bool plugged = false;
};

void sleep_at_random() {
  static std::uint64_t random = 17;
  random = random * 6364136223846793005u + 1442695040888963407u;
  std::this_thread::sleep_for(std::chrono::microseconds((random >> 33) % 5000));
}

TEST(WatchdogUsb, AfterTheProgramIsKilledTheForceIsZero) {
  Rig rig;
  for (int i = 0; i < 8; ++i) {
    rig.start();
    ASSERT_TRUE(rig.pushes()) << rig.messages();
    sleep_at_random();
    const int watchdog = rig.watchdog();
    ASSERT_GT(watchdog, 0);
    const std::uint64_t bulks = rig.bulks();
    kill(rig.child, SIGKILL);
    const int status = rig.wait();
    EXPECT_TRUE(WIFSIGNALED(status) && WTERMSIG(status) == SIGKILL);
    ASSERT_TRUE(wait_until([&] { return !Rig::is_running(watchdog); })) << "its work is done";
    // two zeros; on a slow machine the watchdog first reports that the program stands still, and sends more zeros
    const bool stood_still = rig.messages().find("stopped responding while a force was on") != std::string::npos;
    EXPECT_GE(rig.bulks(), bulks + 2);
    if (!stood_still) {
      EXPECT_EQ(rig.bulks(), bulks + 2);
    }
    EXPECT_EQ(rig.last().force_n, 0) << i;
    EXPECT_NE(rig.messages().find("catena: the program ended while a force was on: the force was set to zero\n"), std::string::npos)
        << rig.messages();
  }
}

TEST(WatchdogUsb, WhileTheProgramIsStoppedTheForceIsZeroThenRampsIn) {
  Rig rig;
  rig.start();
  for (int i = 0; i < 10; ++i) {
    ASSERT_TRUE(rig.pushes()) << rig.messages();
    sleep_at_random();
    const std::uint64_t bulks = rig.bulks();
    kill(rig.child, SIGRTMIN + 5);  // SIGSTOP outside of a request (inherited_node.cpp)
    int status = 0;
    waitpid(rig.child, &status, WUNTRACED);
    ASSERT_TRUE(WIFSTOPPED(status));
    ASSERT_TRUE(wait_until([&] { return rig.bulks() > bulks && rig.last().force_n == 0; }));
    // the watchdog keeps sending zeros
    const std::uint64_t held = rig.bulks();
    ASSERT_TRUE(wait_until([&] { return rig.bulks() > held; }));
    EXPECT_EQ(rig.last().force_n, 0);
    const std::size_t from = rig.count();
    const std::int64_t goes_on_ns = now_ns();
    kill(rig.child, SIGCONT);
    // index of the ramp's first packet: after zeros and at most one packet that was in flight at the stop; packets.size(): none so far
    const auto ramp_from = [&] {
      const std::vector<Packet>& packets = rig.packets;
      const auto is_zero = [&](std::size_t k) { return packets[k].force_n == 0; };
      std::size_t k = from;
      while (k < packets.size() && is_zero(k)) ++k;
      if (k + 1 < packets.size() && is_zero(k + 1)) ++k;
      while (k < packets.size() && is_zero(k)) ++k;
      return k + 1 < packets.size() ? k : packets.size();
    };
    ASSERT_TRUE(wait_until([&] { return rig.bus.with([&](EmulatedFalcon&) { return ramp_from() < rig.packets.size(); }); }));
    rig.bus.with([&](EmulatedFalcon&) {
      const Packet& first = rig.packets[ramp_from()];
      // 8 N in 0.1 s; a program that waits for a processor may skip the first steps
      EXPECT_LT(first.force_n, 0.5 + 80e-9 * static_cast<double>(first.ns - goes_on_ns)) << "the ramp from its beginning, " << i;
    });
  }
  EXPECT_NE(rig.messages().find("catena: the program stopped responding while a force was on"), std::string::npos) << rig.messages();
}

TEST(WatchdogUsb, ANormalExitEndsTheWatchdogWithoutWrites) {
  Rig rig;
  rig.start();
  ASSERT_TRUE(rig.pushes());
  const int watchdog = rig.watchdog();
  ASSERT_GT(watchdog, 0);
  const std::uint64_t bulks = rig.bulks();
  kill(rig.child, SIGINT);
  const int status = rig.wait();
  EXPECT_TRUE(WIFEXITED(status) && WEXITSTATUS(status) == 0);
  EXPECT_FALSE(Rig::is_running(watchdog));
  EXPECT_EQ(rig.bulks(), bulks);
  EXPECT_EQ(rig.last().force_n, 0);
  EXPECT_EQ(rig.messages().find("set to zero"), std::string::npos) << rig.messages();
}

TEST(WatchdogUsb, ATerminatingSignalSendsZeroForceFirst) {
  Rig rig;
  for (const int signal_number : {SIGUSR1, SIGUSR2, SIGALRM, SIGVTALRM, SIGXCPU, SIGRTMAX, SIGTRAP}) {
    int status = 0;
    // retries if the watchdog had already taken over before the signal
    for (int i = 0; i < 5 && (i == 0 || rig.messages().find("stopped responding") != std::string::npos); ++i) {
      rig.start();
      ASSERT_TRUE(rig.pushes()) << rig.messages();
      kill(rig.child, SIGXFSZ);  // ignored by the program
      kill(rig.child, signal_number);
      status = rig.wait();
    }
    if (signal_number == SIGTRAP) {
      EXPECT_TRUE(WIFSIGNALED(status) && WTERMSIG(status) == SIGTRAP) << status;
    } else {
      EXPECT_TRUE(WIFEXITED(status) && WEXITSTATUS(status) == 1) << signal_number << ": " << status;
    }
    EXPECT_EQ(rig.last().force_n, 0) << signal_number;
    EXPECT_EQ(rig.messages().find("ended while a force was on"), std::string::npos)
        << "nothing was left to the watchdog process: " << rig.messages();
    EXPECT_NE(rig.messages().find("catena: ended by "), std::string::npos) << rig.messages();
    EXPECT_NE(rig.messages().find("the device is off\n"), std::string::npos) << rig.messages();
  }
}

TEST(WatchdogUsb, TheWatchdogProcessIsSeparateSmallAndRestarted) {
  Rig rig;
  rig.start();
  ASSERT_TRUE(rig.pushes());
  const int first = rig.watchdog();
  ASSERT_GT(first, 0);
  EXPECT_EQ(getsid(first), first);
  EXPECT_EQ(getpgid(first), first);
  const std::string status = test::read_file("/proc/" + std::to_string(first) + "/status");
  const long resident_kb = std::stol(status.substr(status.find("VmRSS:") + 6));
  EXPECT_GT(resident_kb, 0);
#ifndef __SANITIZE_ADDRESS__
  EXPECT_LT(resident_kb, 8192);
#endif
  for (const int signal_number : {SIGTERM, SIGINT, SIGHUP, SIGQUIT, SIGUSR1, SIGPIPE}) kill(first, signal_number);
  ASSERT_TRUE(wait_for_frames(rig.bus, 20));
  EXPECT_TRUE(Rig::is_running(first)) << "signals do not end it";
  // when the watchdog is killed, the driver sends zero while it starts another one
  kill(first, SIGKILL);
  ASSERT_TRUE(wait_until([&] { return rig.watchdog() != 0 && rig.watchdog() != first; }));
  ASSERT_TRUE(rig.pushes());
  const int second = rig.watchdog();
  kill(rig.child, SIGKILL);
  rig.wait();
  ASSERT_TRUE(wait_until([&] { return !Rig::is_running(second); }));
  EXPECT_EQ(rig.last().force_n, 0);
}

}  // namespace catena::haptics::tests::watchdog_test
