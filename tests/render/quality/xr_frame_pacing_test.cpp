// SPDX-License-Identifier: MIT
/// Frames of a headset on a simulated machine and display: on time if possible, otherwise at half rate.
#include "render/quality/xr_frame_pacing.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <limits>
#include <random>
#include <string>

namespace catena::test::xr_frame_pacing_test {

using namespace catena::render;

/// A display that shows a frame at the first period after its completion, and a machine whose images take their relative cost times
/// `unit_ms` within 10 %, plus `beside_ms` of other work.
struct Headset {
  explicit Headset(const QualityLevelOptions& kind = {}) : pace(kind), kind_(kind) {}

  void run(int frames) {
    for (int k = 0; k < frames; ++k) {
      const auto shown_ns = static_cast<std::int64_t>(1e6 * period_ms * static_cast<double>(slot));
      plan = pace.next(period_ms, shown_ns);
      std::uniform_real_distribution<double> noise(0.9, 1.1);
      const double ms = unit_ms * relative_cost(plan.settings, kind_.is_shaded) * noise(random) / (plan.pixel_scale * plan.pixel_scale);
      pace.record_render_ms(ms);
      messages += pace.take_message();
      slot += std::max<std::int64_t>(plan.display_periods, static_cast<std::int64_t>(std::ceil((ms + other_load_ms) / period_ms)));
    }
  }
  XrFramePacing pace;
  QualityLevelOptions kind_;
  FramePlan plan;
  std::string messages;
  std::mt19937 random{2};
  std::int64_t slot = 1;
  double period_ms = 11.1, unit_ms = 20, other_load_ms = 1;
};

double cost_of(const Headset& h) { return relative_cost(h.plan.settings, false); }

/// Cost of the next level after the current one.
double next_cost(const Headset& h) {
  double next = 1e9;
  for (const RenderSettings& s : quality_levels({})) {
    const double cost = relative_cost(s, false);
    if (cost > cost_of(h)) next = std::min(next, cost);
  }
  return next;
}

double coarsest_cost() { return relative_cost(quality_levels({}).front(), false); }

TEST(XrFramePacing, HoldsTheDisplayPeriodIfPossible) {
  for (const double unit : {1.0, 20.0, 60.0}) {
    Headset h;
    h.unit_ms = unit;
    h.run(2000);
    EXPECT_LE(h.pace.late_after_warmup(), 20) << unit << ": more than 1 % late";
    EXPECT_EQ(h.pace.frame_count(), 2000);
    EXPECT_EQ(h.pace.half_rate_frames(), 0);
    EXPECT_TRUE(h.messages.empty()) << h.messages;
    EXPECT_EQ(h.plan.display_periods, 1);
    // the period is used: the next level would not fit with the margin for an upgrade
    if (unit < 2) continue;  // the last level
    EXPECT_GT(unit * next_cost(h), 0.75 * h.pace.budget_ms()) << unit;
  }
}

TEST(XrFramePacing, OtherwiseTheCoarsestLevelRunsAtHalfRateAndReportsItOnce) {
  Headset h;
  h.unit_ms = 1.4 * h.period_ms / coarsest_cost();
  h.run(1000);
  EXPECT_EQ(h.plan.settings.fast, quality_levels({}).front().fast);
  EXPECT_EQ(h.plan.display_periods, 2);
  EXPECT_GT(h.pace.half_rate_frames(), 950);
  EXPECT_LE(h.pace.late_after_warmup(), 10);
  EXPECT_NE(h.messages.find("half rate"), std::string::npos);
  EXPECT_EQ(h.messages.find("half rate"), h.messages.rfind("half rate"));
  // the load ends and returns
  h.unit_ms = 5;
  h.run(200);
  EXPECT_EQ(h.plan.display_periods, 1);
  h.unit_ms = 1.4 * h.period_ms / coarsest_cost();
  h.run(200);
  EXPECT_EQ(h.plan.display_periods, 2);
  EXPECT_EQ(h.messages.find("half rate"), h.messages.rfind("half rate"));
}

TEST(XrFramePacing, ReducesTheBudgetUnderOtherLoadAndRestoresIt) {
  Headset h;
  h.run(300);
  const double before = h.pace.budget_ms();
  h.other_load_ms = 8;  // a compositor that exceeds the default margin
  h.run(300);
  EXPECT_LT(h.pace.budget_ms(), before);
  const int late = h.pace.late_after_warmup();
  h.run(1000);
  EXPECT_LE(h.pace.late_after_warmup() - late, 15);
  h.other_load_ms = 0;
  h.run(1000);
  EXPECT_NEAR(h.pace.budget_ms(), 0.8 * h.period_ms, 1e-9);
}

/// The budget before a stall is restored within 90 frames without late frames. A level that just fitted may become the one below it,
/// because an upgrade needs a margin.
TEST(XrFramePacing, RecoversFromAnyStallWithin90Frames) {
  for (const int frames : {1, 3, 30, 300})
    for (const double stall_ms : {15.0, 60.0, 3000.0}) {
      const std::string what = std::to_string(frames) + " of " + std::to_string(stall_ms) + " ms";
      Headset h;
      h.run(400);
      const double budget = h.pace.budget_ms(), cost = cost_of(h);
      for (int again = 0; again < 3; ++again) {
        h.other_load_ms = stall_ms;
        h.run(frames);
        h.other_load_ms = 1;
        h.run(2);  // the first frame still has the stall's delay
        const int late = h.pace.late_frames();
        h.run(90);
        EXPECT_NEAR(h.pace.budget_ms(), budget, 1e-9) << what;
        EXPECT_TRUE(cost_of(h) == cost || (cost_of(h) < cost && h.unit_ms * next_cost(h) > 0.8 * budget)) << what;
        EXPECT_EQ(h.plan.display_periods, 1) << what;
        h.run(300);
        EXPECT_LE(h.pace.late_frames() - late, 3) << what;
      }
    }
}

/// A compositor that permanently exceeds the default margin: the budget does not oscillate, and is restored when the load ends.
TEST(XrFramePacing, SteadyLoadCausesNoLateFrames) {
  for (const double unit : {5.0, 10.0, 20.0, 30.0, 40.0})
    for (const double beside : {3.0, 4.0, 5.0, 6.0, 7.0, 8.0})
      for (const unsigned seed : {1u, 2u, 3u, 4u}) {
        const std::string what = fmt::format("{} ms beside, a unit of {} ms, seed {}", beside, unit, seed);
        Headset h;
        h.random.seed(seed);
        h.unit_ms = unit;
        h.other_load_ms = beside;
        h.run(500);
        const int late = h.pace.late_frames();
        h.run(5000);
        EXPECT_LE(h.pace.late_frames() - late, 50) << what << ": more than 1 % late";
        h.other_load_ms = 0;
        h.run(800);
        EXPECT_NEAR(h.pace.budget_ms(), 0.8 * h.period_ms, 1e-9) << what;
      }
}

TEST(XrFramePacing, CountsLateFramesButNotAPause) {
  XrFramePacing pace;
  std::int64_t shown = 10'000'000;
  const auto frame = [&](std::int64_t periods) {
    shown += periods * 10'000'000;
    pace.next(10, shown);
    pace.record_render_ms(1);
  };
  for (int k = 0; k < 40; ++k) frame(1);
  EXPECT_EQ(pace.late_frames(), 0);
  frame(2);
  frame(1);
  frame(5);
  EXPECT_EQ(pace.late_frames(), 2);
  EXPECT_EQ(pace.late_after_warmup(), 2);
  pace.pause();
  frame(500);
  EXPECT_EQ(pace.late_frames(), 2);
  shown += 3'000'000;  // jitter of the runtime's prediction
  frame(1);
  EXPECT_EQ(pace.late_frames(), 2);
}

TEST(XrFramePacing, AJumpingClockKeepsTheBudgetWithinItsLimits) {
  XrFramePacing pace;
  constexpr std::int64_t kFar = std::numeric_limits<std::int64_t>::max();
  for (const std::int64_t shown : {std::int64_t(-5), -kFar, kFar, -kFar, std::int64_t(0), kFar}) {
    EXPECT_GT(pace.next(10, shown).display_periods, 0);
    pace.record_render_ms(1);
    EXPECT_GE(pace.budget_ms(), 2.5 - 1e-9);
    EXPECT_LE(pace.budget_ms(), 8 + 1e-9);
  }
  EXPECT_EQ(pace.late_frames(), 2) << "what goes back, or comes after nothing, is not late";
}

TEST(XrFramePacing, WithoutTheFastRaycastPixelsAreReduced) {
  Headset h({false, false});
  h.unit_ms = 100;
  h.run(400);
  EXPECT_GT(h.plan.pixel_scale, 1u);
  EXPECT_EQ(h.plan.display_periods, 1);
  EXPECT_LE(h.pace.late_after_warmup(), 4);
}

}  // namespace catena::test::xr_frame_pacing_test
