// SPDX-License-Identifier: MIT
#include "haptics/servo/servo_stats.h"

#include <gtest/gtest.h>

#include <thread>

#include "engine/base/json.h"
#include "haptics/device/device.h"
#include "haptics/servo/servo.h"

namespace catena::haptics::servo_stats_test {

TEST(ServoStats, CanBeReadByOtherThreadsWhileTheServoRuns) {
  NullDevice device;
  Servo servo(device, std::make_shared<HapticProgram>(), {.rate_hz = 4000});
  EXPECT_TRUE(servo.start());
  std::uint64_t last = 0;
  while (last < 400) {
    const ServoStats r = servo.stats();
    EXPECT_GE(r.ticks, last);
    EXPECT_LE(r.period.p50_us, r.period.p99_us);
    EXPECT_LE(r.period.p999_us, r.period.max_us);
    EXPECT_LE(r.compute.p999_us, r.compute.max_us);
    last = r.ticks;
    std::this_thread::yield();
  }
  servo.stop();
  const ServoStats r = servo.stats();
  EXPECT_EQ(r.period.count, r.ticks - 1);
  EXPECT_EQ(r.compute.count, r.ticks);
  EXPECT_EQ(r.device.count, r.ticks);
  HapticState state;
  ASSERT_TRUE(servo.receive(state));
  EXPECT_EQ(state.tick, r.ticks);
  EXPECT_EQ(state.missed_deadlines, r.missed_deadlines);
  EXPECT_GT(state.period_us, 0);
  EXPECT_LE(state.period_us, r.period.max_us);
  EXPECT_LE(state.compute_us, r.compute.max_us);
  EXPECT_LE(state.device_us, r.device.max_us);
  // ticks plus missed deadlines equal all deadlines so far
  EXPECT_NEAR(static_cast<double>(r.ticks + r.missed_deadlines), state.t_s * 4000 + 1, 1);
}

TEST(ServoStats, JsonHasEveryFigure) {
  ServoStats r;
  r.rate_hz = 1000;
  r.seconds = 2.5;
  r.ticks = 2499;
  r.missed_deadlines = 3;
  r.late_ticks = 2;
  r.lost_ticks = 4;
  r.watchdog_trips = 1;
  r.realtime.fifo = true;
  r.realtime.cpu = 1;
  r.realtime.notes = {"one \"quoted\"", "two"};
  r.period = {2498, 1000, 1010, 1100, 1234.5};
  r.device = {2499, 1, 2, 3, 4, {{0.5, 2000}, {1, 499}}};
  const json::Node root = *json::parse(servo_json(r, "a \"device\"", 0xabcu), "stats");
  EXPECT_EQ(root.find("device")->string, "a \"device\"");
  using Row = std::pair<const char*, double>;
  for (const auto& [name, value] : {Row{"rate_hz", 1000}, Row{"seconds", 2.5}, Row{"ticks", 2499}, Row{"missed_deadlines", 3},
                                    Row{"late_ticks", 2}, Row{"lost_ticks", 4}, Row{"watchdog_trips", 1}})
    EXPECT_EQ(root.find(name)->number, value) << name;
  const json::Node& realtime = *root.find("realtime");
  EXPECT_TRUE(realtime.find("fifo")->boolean);
  EXPECT_FALSE(realtime.find("locked")->boolean);
  EXPECT_EQ(realtime.find("cpu")->number, 1);
  ASSERT_EQ(realtime.find("notes")->items.size(), 2u);
  EXPECT_EQ(realtime.find("notes")->items[0].string, "one \"quoted\"");
  EXPECT_EQ(root.find("period_us")->find("max")->number, 1234.5);
  EXPECT_EQ(root.find("period_us")->find("count")->number, 2498);
  EXPECT_EQ(root.find("device_us")->find("p999")->number, 3);
  ASSERT_EQ(root.find("device_us")->find("bins")->items.size(), 2u);
  EXPECT_EQ(root.find("device_us")->find("bins")->items[1].items[1].number, 499);
  EXPECT_TRUE(root.find("period_us")->find("bins")->items.empty());
  EXPECT_EQ(root.find("compute_us")->find("p50")->number, 0);
  EXPECT_EQ(root.find("state_hash")->string, "0000000000000abc");
}

}  // namespace catena::haptics::servo_stats_test
