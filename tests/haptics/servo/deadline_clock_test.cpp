// SPDX-License-Identifier: MIT
#include "haptics/servo/deadline_clock.h"

#include <gtest/gtest.h>

namespace catena::haptics::deadline_clock_test {

constexpr std::int64_t kMs = 1'000'000, kFirst = 77 * kMs;

std::int64_t at(double periods) { return kFirst + static_cast<std::int64_t>(periods * kMs); }

TEST(DeadlineClock, TicksOnTimeFollowTheGrid) {
  DeadlineClock pace(kMs, kFirst);
  for (int k = 0; k < 100; ++k) {
    EXPECT_EQ(pace.next_wake_ns(), at(k));
    const TickTiming beat = pace.begin_tick(at(k + 0.06 * (k % 3)));
    EXPECT_EQ(beat.time_ns, k * kMs) << "the time is the deadline's, whatever the wake-up";
    EXPECT_EQ(beat.missed, 0);
    EXPECT_FALSE(beat.late);
    pace.end_tick(at(k + 0.8));
  }
}

TEST(DeadlineClock, AnOverrunSkipsToTheNextDeadlineAndCountsTheMissedOnes) {
  // duration of a tick in periods, the missed deadlines, and whether the next tick is late
  const struct {
    double takes;
    std::int64_t missed;
    bool late;
  } cases[] = {{0.99, 0, false}, {1.01, 1, false}, {1.99, 1, false}, {2.01, 2, true}, {7.5, 7, true}};
  for (const auto& c : cases) {
    DeadlineClock pace(kMs, kFirst);
    pace.begin_tick(at(0));
    pace.end_tick(at(c.takes));
    EXPECT_EQ(pace.next_wake_ns(), at(static_cast<double>(c.missed + 1))) << c.takes;
    const TickTiming beat = pace.begin_tick(pace.next_wake_ns() + 50'000);
    EXPECT_EQ(beat.missed, c.missed) << c.takes;
    EXPECT_EQ(beat.late, c.late) << c.takes;
    EXPECT_EQ(beat.time_ns, (c.missed + 1) * kMs) << c.takes;
  }
}

TEST(DeadlineClock, ATickIsLateOnlyAfterMoreThanTwoPeriods) {
  for (const std::int64_t more : {0, 1}) {
    DeadlineClock pace(kMs, kFirst);
    pace.begin_tick(at(0.5));  // the time of a late tick is its actual start: 0.5
    pace.end_tick(at(1.0));
    const TickTiming beat = pace.begin_tick(at(2.5) + more);
    EXPECT_EQ(beat.time_ns, at(2.5) + more - kFirst);
    EXPECT_EQ(beat.late, more == 1);
    EXPECT_EQ(beat.missed, 1);
  }
}

TEST(DeadlineClock, ALateWakeUpHasItsActualTimeAndSkipsATooNearDeadline) {
  DeadlineClock pace(kMs, kFirst);
  pace.begin_tick(at(0));
  pace.end_tick(at(0.1));
  const TickTiming slow = pace.begin_tick(at(1.9));
  EXPECT_EQ(slow.time_ns, at(1.9) - kFirst);
  EXPECT_EQ(slow.missed, 0);
  pace.end_tick(at(1.95));
  EXPECT_EQ(pace.next_wake_ns(), at(3)) << "2 is too near";
  EXPECT_EQ(pace.begin_tick(at(3)).missed, 1);
}

TEST(DeadlineClock, TicksPlusMissedDeadlinesCountAllPeriods) {
  DeadlineClock pace(kMs, kFirst);
  std::uint64_t seed = 1;
  const auto random = [&] { return static_cast<double>((seed = seed * 6364136223846793005u + 1442695040888963407u) >> 40) / (1 << 24); };
  std::int64_t clock = kFirst, last_time = -kMs, ticks = 0, missed = 0;
  for (int k = 0; k < 20000; ++k) {
    clock = std::max(clock, pace.next_wake_ns()) + static_cast<std::int64_t>(random() * random() * random() * 2 * kMs);
    const TickTiming beat = pace.begin_tick(clock);
    ++ticks;
    missed += beat.missed;
    EXPECT_GE(beat.time_ns - last_time, kMs / 2 - 1);
    EXPECT_EQ(beat.late, k > 0 && beat.time_ns - last_time > 2 * kMs);
    EXPECT_LE(clock - kFirst - beat.time_ns, kMs / 4);
    EXPECT_EQ(ticks + missed, (clock - kFirst) / kMs + 1);
    last_time = beat.time_ns;
    clock += static_cast<std::int64_t>(random() * random() * 4 * kMs);
    pace.end_tick(clock);
  }
  EXPECT_GT(missed, 1000);
}

TEST(DeadlineClock, AGapLongerThanTheLimitMarksTheNextTickAsStalled) {
  for (const double gap : {1.0, 49.0, 51.0, 5000.0}) {
    DeadlineClock pace(kMs, kFirst, 50 * kMs);
    EXPECT_FALSE(pace.begin_tick(at(0)).stalled);
    pace.end_tick(at(0.5));
    EXPECT_EQ(pace.begin_tick(at(0.5 + gap)).stalled, gap > 50) << gap;
    pace.end_tick(at(0.6 + gap));
    EXPECT_FALSE(pace.begin_tick(at(1.6 + gap)).stalled) << "once";
  }
  DeadlineClock pace(kMs, kFirst);
  pace.begin_tick(at(0));
  EXPECT_FALSE(pace.begin_tick(at(1e9)).stalled) << "without a limit";
}

}  // namespace catena::haptics::deadline_clock_test
