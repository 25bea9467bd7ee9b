// SPDX-License-Identifier: MIT
/// A program that is stopped (SIGSTOP) and continued: the first packet to the motors is zero, then the force ramps in.
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <fstream>
#include <thread>

#include "engine/base/clock.h"
#include "haptics/device/emulator/emulated_transport.h"
#include "haptics/device/usb/falcon.h"
#include "haptics/servo/servo.h"
#include "tests/haptics/device/scripted_device.h"
#include "tests/haptics/device/usbfs/ball_link.h"
#include "tests/support/child_test.h"
#include "tests/support/support.h"

namespace catena::haptics::stopped_program_test {

constexpr int kStops = 16;
constexpr double kRampS = 0.05;
constexpr std::int64_t kStopMs = 75;  // the watchdog trips after 50 ms

/// Time and force of one packet to the motors.
struct Packet {
  std::int64_t ns = 0;
  double force_n = 0;
};

void nap_ms(std::int64_t ms) { std::this_thread::sleep_for(std::chrono::milliseconds(ms)); }

constexpr std::size_t kMaxPackets = 200000;

/// A device without logic of its own: each write is one packet to the motors. It rests 10 mm deep in the ball.
class PlainDevice final : public test::ScriptedDevice {
 public:
  explicit PlainDevice(std::vector<Packet>& packets) : packets_(packets) {
    caps.max_force_n = 10;
    input.position_m = {0, 0, 0.13};
  }
  void write(const DeviceOutput& now) noexcept override {
    if (packets_.size() < kMaxPackets) packets_.push_back({now_ns(), is_off_ ? 0 : norm(now.force_n)});
    if (stops_left_ > 0 && packets_.size() % 200 == 0 && --stops_left_ >= 0) kill(getpid(), SIGSTOP);
  }
  void stop() noexcept override { is_off_ = true; }
  void resume() noexcept override { is_off_ = false; }
  /// Makes the next writes stop the program, `times` times, at the end of a write.
  void stop_the_program(int times) { stops_left_ = times; }

 private:
  std::vector<Packet>& packets_;
  std::atomic<int> stops_left_{0};
  std::atomic<bool> is_off_{false};
};

std::unique_ptr<Device> emulated_falcon(const std::shared_ptr<SharedEmulatedFalcon>& shared, std::vector<Packet>& packets) {
  {
    const std::scoped_lock lock(shared->mutex);
    EXPECT_TRUE(shared->device.mechanism().hold({0, 0, 0.175}));
    shared->device.set_exchange_observer([&](const EmulatedFalcon::Exchange& e) {
      if (packets.size() < kMaxPackets) packets.push_back({now_ns(), norm(e.force_n)});
    });
  }
  auto falcon = usb::Falcon::open(std::make_unique<EmulatedTransportSource>(shared, true));
  EXPECT_TRUE(falcon);
  for (int i = 0; i < 5000 && (*falcon)->state() != usb::FalconState::ready; ++i) nap_ms(1);
  return std::move(*falcon);
}

// Child process of the tests below: runs a servo with a hand that presses into a ball, and is stopped repeatedly.
TEST(SuspendedProcess, DISABLED_PressesIntoABallAndIsStopped) {
  const std::string path = test::child_variable("CATENA_PACKETS_OF_THE_CHILD");
  if (path.empty()) GTEST_SKIP() << "the child of this suite";
  std::vector<Packet> packets;
  packets.reserve(kMaxPackets);
  auto shared = std::make_shared<SharedEmulatedFalcon>(EmulatedFalconOptions{.homed = true});
  const std::string kind = test::child_variable("CATENA_DEVICE_OF_THE_CHILD");
  auto plain = std::make_unique<PlainDevice>(packets);
  PlainDevice* stops = kind == "stops in write" ? plain.get() : nullptr;
  std::unique_ptr<Device> device = std::move(plain);
  if (kind == "falcon") device = emulated_falcon(shared, packets);
  auto program = std::make_shared<HapticProgram>(*tests::ball_link_program());
  program->limits.ramp_in_s = kRampS;
  Servo servo(*device, program, {});
  ASSERT_TRUE(servo.start());
  {
    const std::scoped_lock lock(shared->mutex);
    ASSERT_TRUE(shared->device.mechanism().hold({0, 0, 0.13}));
  }
  nap_ms(200);
  std::ofstream(path + ".ready") << "1";
  if (stops != nullptr) stops->stop_the_program(kStops);
  for (int i = 0; i < 100000 && !test::exists(path + ".enough"); ++i) nap_ms(1);
  servo.stop();
  device.reset();
  std::ofstream out(path + ".part");
  for (const Packet& packet : packets) out << packet.ns << ' ' << packet.force_n << '\n';
  out.close();
  ASSERT_EQ(std::rename((path + ".part").c_str(), path.c_str()), 0);
}

/// Interval from the program's stop to its SIGCONT.
struct Stop {
  std::int64_t from_ns = 0, to_ns = 0;
};

/// Stops and continues the child kStops times; returns the packets that its motors received.
void stop_and_continue(const std::string& device, std::vector<Packet>& packets, std::vector<Stop>& stops) {
  const test::TemporaryFolder folder;
  const std::string path = folder / "packets";
  const pid_t child = test::start_case("SuspendedProcess.DISABLED_*",
                                       {.environment = {"CATENA_PACKETS_OF_THE_CHILD=" + path, "CATENA_DEVICE_OF_THE_CHILD=" + device}});
  int status = 0;
  while (!test::exists(path + ".ready") && waitpid(child, &status, WNOHANG) == 0) nap_ms(1);
  for (int i = 0; i < kStops; ++i) {
    Stop stop;
    if (device != "stops in write") kill(child, SIGSTOP);
    ASSERT_EQ(waitpid(child, &status, WUNTRACED), child);
    stop.from_ns = now_ns();
    nap_ms(kStopMs);
    stop.to_ns = now_ns();
    kill(child, SIGCONT);
    stops.push_back(stop);
    nap_ms(kStopMs + 35);
    // at a different phase of the period each time
    std::this_thread::sleep_for(std::chrono::microseconds(83 * i));
  }
  test::write_file(path + ".enough", "1");
  waitpid(child, &status, 0);
  ASSERT_TRUE(WIFEXITED(status) && WEXITSTATUS(status) == 0);
  std::ifstream in(path);
  for (Packet packet; in >> packet.ns >> packet.force_n;) packets.push_back(packet);
  ASSERT_GT(packets.size(), 1000u);
}

/// `in_flight`: number of packets that may have been in flight at the stop and arrive after it.
void check(const std::vector<Packet>& packets, const std::vector<Stop>& stops, std::size_t in_flight) {
  double max_sent_n = 0;
  for (const Packet& packet : packets) max_sent_n = std::max(max_sent_n, packet.force_n);
  ASSERT_GT(max_sent_n, 2) << "the hand was held";
  int with_force = 0;
  for (const Stop& stop : stops) {
    // first packet after the stop
    std::size_t i = 1;
    while (i + 1 < packets.size() && packets[i].ns < stop.from_ns) ++i;
    EXPECT_GE(packets[i].ns, stop.to_ns);
    with_force += packets[i - 1].force_n > 1;
    const std::size_t first = i + in_flight;
    ASSERT_LT(first, packets.size());
    // a driver with its own thread may skip the zero and send the ramp's first tick
    if (in_flight == 0) {
      EXPECT_EQ(packets[first].force_n, 0) << "packet " << i;
    }
    // the force stays below the ramp; tolerance: a motor count, and two ticks of latency of a packet
    for (std::size_t k = first; k < packets.size() && packets[k].ns < stop.to_ns + static_cast<std::int64_t>(1e9 * kRampS); ++k) {
      const double share = (1e-9 * static_cast<double>(packets[k].ns - stop.to_ns) + 2e-3) / kRampS;
      ASSERT_LE(packets[k].force_n, max_sent_n * share + 0.02) << "packet " << i;
    }
  }
  EXPECT_GE(with_force, kStops / 4);
}

void expect_zero_after_stops(const std::string& device, std::size_t in_flight) {
  std::vector<Packet> packets;
  std::vector<Stop> stops;
  stop_and_continue(device, packets, stops);
  check(packets, stops, in_flight);
}

TEST(SuspendedProcess, AStopDuringAWriteIsDetected) { expect_zero_after_stops("stops in write", 0); }

TEST(SuspendedProcess, TheFirstTickAfterAStopIsZeroThenForceRampsIn) { expect_zero_after_stops("plain", 0); }

TEST(SuspendedProcess, AFalconsMotorsRampInAfterAStop) { expect_zero_after_stops("falcon", 1); }

}  // namespace catena::haptics::stopped_program_test
