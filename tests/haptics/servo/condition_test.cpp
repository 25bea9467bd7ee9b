// SPDX-License-Identifier: MIT
// Late, stuck and lost devices and NaN poses: tick conditions and forces sent by the running servo thread.
#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <functional>
#include <limits>

#include "tests/haptics/device/scripted_device.h"
#include "tests/haptics/servo/run_servo.h"
#include "tests/support/simple_links.h"

namespace catena::haptics::condition_test {

std::shared_ptr<HapticProgram> program() {
  auto p = std::make_shared<HapticProgram>();
  p->epoch = 1;
  p->links = {test::hold_height("a", 0.004)};
  return p;
}

void nap_ms(double ms) { std::this_thread::sleep_for(std::chrono::nanoseconds(static_cast<std::int64_t>(1e6 * ms))); }

/// Rests at the origin; a script may alter each read. Records every force that is sent.
class Scripted final : public test::ScriptedDevice {
 public:
  explicit Scripted(std::function<void(int, DeviceInput&)> script) : script_(std::move(script)) { caps.max_force_n = 10; }
  DeviceInput read() noexcept override {
    DeviceInput now;
    script_(reads_++, now);
    return now;
  }
  void write(const DeviceOutput& now) noexcept override {
    sent.push_back(stopped_.load() ? Vec3(0.0) : now.force_n);
    live.push_back(now.forces_active);
  }
  void stop() noexcept override {
    stopped_ = true;
    ++stops;
  }
  void resume() noexcept override {
    stopped_ = false;
    ++resumes;
  }
  bool stopped() const { return stopped_; }

  std::vector<Vec3> sent;
  std::vector<bool> live;
  std::atomic<int> stops{0}, resumes{0};

 private:
  std::function<void(int, DeviceInput&)> script_;
  int reads_ = 0;
  std::atomic<bool> stopped_{false};
};

struct Seen final : TickSink {
  void put(const ProbeSample& input, const HapticState& output) noexcept override {
    inputs.push_back(input);
    outputs.push_back(output);
    if (servo != nullptr && inputs.size() == 10) servo->set_forces_enabled(true);
  }
  std::vector<ProbeSample> inputs;
  std::vector<HapticState> outputs;
  Servo* servo = nullptr;  ///< gets forces after ten ticks; nullptr: none
};

/// Runs `ticks` ticks, by default without a watchdog.
ServoStats run(Device& device, std::uint64_t ticks, Seen& seen, ServoOptions options = {.watchdog_s = 0},
               const std::shared_ptr<HapticProgram>& from = program()) {
  options.max_ticks = ticks;
  options.sink = &seen;
  seen.inputs.reserve(ticks);
  seen.outputs.reserve(ticks);
  Servo servo(device, from, options);
  EXPECT_EQ(servo.forces_enabled(), options.forces_enabled);
  if (!options.forces_enabled) seen.servo = &servo;
  test::run_to_end(servo);
  EXPECT_TRUE(servo.forces_enabled());
  return servo.stats();
}

TEST(TickConditions, ATickIsLateMoreThanTwoPeriodsAfterTheLast) {
  // every 20th read sleeps for `periods` periods of 2 ms
  for (const double periods : {1.4, 3.4}) {
    Scripted device([&](int k, DeviceInput&) {
      if (k % 20 == 10) nap_ms(2 * periods);
    });
    Seen seen;
    const ServoStats report = run(device, 100, seen, {.rate_hz = 500, .watchdog_s = 0});
    std::uint64_t late = 0, after_nap = 0;
    for (std::size_t k = 1; k < 100; ++k) {
      const bool is_late = seen.inputs[k].condition == TickCondition::late;
      EXPECT_EQ(is_late, seen.inputs[k].t_s - seen.inputs[k - 1].t_s > 0.004 + 1e-9) << k;
      late += is_late ? 1 : 0;
      if (k % 20 == 11) after_nap += is_late ? 1 : 0;
    }
    EXPECT_EQ(report.late_ticks, late);
    EXPECT_EQ(report.ticks, 100u);
    EXPECT_EQ(report.watchdog_trips, 0u);
    EXPECT_EQ(device.stops, 1) << "at the end";
    if (periods > 2) {
      EXPECT_EQ(after_nap, 5u);
      EXPECT_GE(report.missed_deadlines, 15u);
    } else {
      EXPECT_GE(report.missed_deadlines, 5u);
    }
  }
}

TEST(TickConditions, ThePeriodAfterAMissIsTheMeasuredOne) {
  Scripted device([](int k, DeviceInput&) {
    if (k == 10) nap_ms(17);
  });
  Seen seen;
  run(device, 20, seen, {.rate_hz = 200, .watchdog_s = 0});
  const double dt = seen.inputs[11].t_s - seen.inputs[10].t_s;
  EXPECT_GE(dt, 0.015);
  EXPECT_NEAR(dt, 1e-6 * seen.outputs[11].period_us, 0.003);
  EXPECT_GE(seen.outputs[10].device_us, 17000);
  EXPECT_LE(seen.outputs[10].device_us + seen.outputs[10].compute_us, seen.outputs[11].period_us) << "apart";
}

TEST(TickConditions, TheWatchdogStopsAStuckDeviceWhichThenResumes) {
  Scripted* self = nullptr;
  bool stopped_meanwhile = false;
  Scripted device([&](int k, DeviceInput&) {
    if (k != 30) return;
    for (int i = 0; i < 2000 && !self->stopped(); ++i) nap_ms(1);
    stopped_meanwhile = self->stopped();
    nap_ms(20);  // until the watchdog has also set its flag
  });
  self = &device;
  Seen seen;
  const ServoStats report = run(device, 80, seen, {.rate_hz = 500, .watchdog_s = 0.06});
  EXPECT_TRUE(stopped_meanwhile);
  EXPECT_GE(report.watchdog_trips, 1u);
  EXPECT_EQ(seen.outputs[30].condition, TickCondition::watchdog) << "the tick that was stuck";
  EXPECT_EQ(seen.outputs[30].force_state, ForceState::stopped);
  EXPECT_EQ(norm(device.sent[30]), 0);
  const auto pushes = [](const Vec3& force) { return norm(force) > 0; };
  EXPECT_TRUE(std::any_of(device.sent.begin(), device.sent.begin() + 30, pushes));
  EXPECT_TRUE(std::any_of(device.sent.begin() + 31, device.sent.end(), pushes)) << "resumed";
  EXPECT_GE(device.resumes, 2);
  EXPECT_TRUE(device.stopped()) << "at the end";
  EXPECT_EQ(device.sent.back(), Vec3(0.0));
}

TEST(TickConditions, UnpacedTicksAreNeverLateOrWatched) {
  Scripted device([](int k, DeviceInput&) {
    if (k == 10) nap_ms(150);
  });
  Seen seen;
  const ServoStats report = run(device, 20, seen, {.rate_hz = 1000, .paced = false});
  for (const ProbeSample& input : seen.inputs) EXPECT_EQ(input.condition, TickCondition::normal);
  EXPECT_EQ(report.late_ticks + report.missed_deadlines + report.watchdog_trips, 0u);
  EXPECT_FALSE(report.realtime.fifo || report.realtime.locked);
  EXPECT_EQ(seen.inputs[19].t_s, 0.019);
}

TEST(TickConditions, ALostDeviceGetsNoForceUntilItReturns) {
  Scripted device([](int k, DeviceInput& input) {
    if (k >= 10 && k < 20) input.status = k < 15 ? DeviceStatus::lost : DeviceStatus::starting;
  });
  Seen seen;
  const ServoStats report = run(device, 40, seen, {.paced = false});
  for (std::size_t k = 0; k < 40; ++k) {
    const bool away = k >= 10 && k < 20;
    EXPECT_EQ(seen.inputs[k].condition == TickCondition::no_device, away) << k;
    if (away) {
      EXPECT_EQ(norm(device.sent[k]), 0) << k;
      EXPECT_EQ(seen.outputs[k].force_state, ForceState::stopped);
    }
  }
  EXPECT_GT(norm(device.sent[9]), 0);
  EXPECT_GT(norm(device.sent[39]), 0);
  EXPECT_EQ(report.lost_ticks, 10u);
}

TEST(TickConditions, TheForceRampsInHoweverLongTheDeviceWasLost) {
  Scripted device([](int k, DeviceInput& input) {
    if (k >= 1000 && k < 2000) input.status = DeviceStatus::lost;
  });
  Seen seen;
  auto ramped = program();
  ramped->limits.ramp_in_s = 0.5;
  ramped->limits.slew_n_per_s = 4000;
  run(device, 2600, seen, {.paced = false}, ramped);
  ASSERT_NEAR(norm(device.sent[999]), 2, 1e-12);
  EXPECT_EQ(norm(device.sent[1999]), 0);
  for (std::size_t k = 2000; k < 2400; ++k) {
    ASSERT_EQ(seen.outputs[k].force_state, ForceState::ramping_in) << k;
    ASSERT_NEAR(norm(device.sent[k]), 2 * static_cast<double>(k - 1999) / 500, 1e-6) << k;
  }
  EXPECT_NEAR(norm(device.sent[2599]), 2, 1e-12);
}

TEST(TickConditions, AStallBetweenTicksDoesNotShortenTheRamp) {
  // the tick after the stall has the watchdog's condition, the next one is on time
  ChainState state;
  ChainScratch scratch;
  HapticState out;
  auto p = program();
  p->limits.ramp_in_s = 0.5;
  ProbeSample probe;
  for (int k = 0; k < 600; ++k) {
    probe.t_s = 1e-3 * k;
    tick(*p, probe, state, scratch, out);
  }
  ASSERT_EQ(out.force_state, ForceState::on);
  probe.t_s += 3;
  probe.condition = TickCondition::watchdog;
  tick(*p, probe, state, scratch, out);
  EXPECT_EQ(norm(out.force_n), 0);
  probe.t_s += 1e-3;
  probe.condition = TickCondition::normal;
  tick(*p, probe, state, scratch, out);
  EXPECT_EQ(out.force_state, ForceState::ramping_in);
  EXPECT_NEAR(norm(out.force_n), 2 * 1e-3 / 0.5, 1e-9);
}

TEST(TickConditions, ARestartedServoRampsIn) {
  Scripted device([](int, DeviceInput&) {});
  auto ramped = program();
  ramped->limits.ramp_in_s = 0.1;
  Servo servo(device, ramped, {.paced = false, .max_ticks = 200});
  for (int run = 0; run < 2; ++run) {
    device.sent.clear();
    test::run_to_end(servo);
    EXPECT_LE(norm(device.sent[0]), 0.03) << run;
    EXPECT_NEAR(norm(device.sent[50]), 1, 0.05) << run;
    EXPECT_NEAR(norm(device.sent[199]), 2, 1e-12) << run;
  }
}

TEST(TickConditions, ANonFinitePoseGetsNoForceInThatTick) {
  Scripted device([](int k, DeviceInput& input) {
    if (k == 10) input.position_m.y = std::numeric_limits<double>::quiet_NaN();
    if (k == 20) input.orientation.x = std::numeric_limits<double>::infinity();
  });
  Seen seen;
  run(device, 40, seen, {.paced = false});
  for (const std::size_t k : {10u, 20u}) {
    EXPECT_EQ(norm(device.sent[k]), 0) << k;
    EXPECT_EQ(seen.outputs[k].links[0].status, LinkStatus::bad_probe);
    EXPECT_GT(norm(device.sent[k - 1]), 0) << k;
  }
  EXPECT_GT(norm(device.sent[39]), 0);
}

TEST(TickConditions, ForcesNeedBothTheUsersAndTheDevicesConsent) {
  Scripted device([](int k, DeviceInput& input) { input.forces_on = k < 20; });
  Seen seen;
  run(device, 60, seen, {.paced = false, .forces_enabled = false});
  for (std::size_t k = 0; k < 60; ++k) {
    EXPECT_EQ(seen.inputs[k].forces_on, k >= 10 && k < 20) << k;
    // after the switch-off the force ramps out over 20 ms: ticks 20 to 39
    if (k < 10 || k > 41) {
      EXPECT_FALSE(device.live[k]) << k;
    }
    if (k < 10) {
      EXPECT_EQ(norm(device.sent[k]), 0) << k;
    }
  }
  EXPECT_GT(norm(device.sent[15]), 0);
  EXPECT_TRUE(device.live[15]);
  EXPECT_FALSE(device.live.back()) << "the last zero";
}

}  // namespace catena::haptics::condition_test
