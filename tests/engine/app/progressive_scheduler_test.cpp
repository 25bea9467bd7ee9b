// SPDX-License-Identifier: MIT
/// The window's next image, from measured render times; and the phase of animated bands, from the clock.
#include "engine/app/viewer/window/progressive_scheduler.h"

#include "tests/support/results.h"

namespace catena::app::progressive_scheduler_test {

using test::value_of;

constexpr RayWorkload kFast{true, true, false}, kExact{true, false, false}, kNoRays{false, false, false};

ProgressiveScheduler pacing(const std::string& words) { return ProgressiveScheduler(value_of(parse_quality(words))); }

/// The render time on a machine where a unit of cost takes `unit_ms` for an image of full size.
double time_of(const FrameRequest& next, double unit_ms) {
  return unit_ms * render::relative_cost(next.settings, false) / (next.pixel_stride * next.pixel_stride);
}

FrameRequest settle(ProgressiveScheduler& p, const RayWorkload& kind, double unit_ms) {
  FrameRequest next;
  for (int k = 0; k < 60; ++k) {
    next = p.interactive_frame(kind);
    p.on_rendered(time_of(next, unit_ms));
  }
  return next;
}

/// The images at rest.
std::vector<FrameRequest> rest(ProgressiveScheduler& p, const RayWorkload& kind, double unit_ms) {
  std::vector<FrameRequest> all;
  while (const auto next = p.refined_frame(kind)) {
    all.push_back(*next);
    p.on_rendered(time_of(*next, unit_ms));
    if (all.size() > 20) break;
  }
  return all;
}

TEST(ProgressiveScheduler, InteractiveImagesMeetTheTimeAndImproveWithMoreTime) {
  double before = 0;
  for (const char* words : {"time=20", "time=50", "time=200"}) {
    ProgressiveScheduler p = pacing(words);
    const FrameRequest next = settle(p, kFast, 320);
    EXPECT_LE(time_of(next, 320), std::stod(std::string(words).substr(5))) << words;
    EXPECT_LE(next.pixel_stride, before == 0 ? 2u : 1u) << "hysteresis at the shortest time";
    const double cost = render::relative_cost(next.settings, false);
    EXPECT_GT(cost, before) << words;
    before = cost;
  }
}

TEST(ProgressiveScheduler, AtRestItRefinesToEveryPixelAndEnds) {
  ProgressiveScheduler p = pacing("time=50");
  settle(p, kFast, 400);
  const auto all = rest(p, kFast, 400);
  ASSERT_GE(all.size(), 2u);
  EXPECT_EQ(all.front().settings.fast->spacing, 4u);
  for (std::size_t i = 1; i < all.size(); ++i)
    EXPECT_LE(all[i].settings.fast ? all[i].settings.fast->spacing : 1, all[i - 1].settings.fast->spacing);
  EXPECT_TRUE(!all.back().settings.fast || all.back().settings.fast->spacing == 1);
  EXPECT_TRUE(p.is_finished());
  p.interactive_frame(kFast);
  EXPECT_FALSE(p.is_finished());
  EXPECT_EQ(render::describe(p.final_frame(kFast).settings), render::describe(all.back().settings));
  EXPECT_TRUE(p.is_finished());
}

TEST(ProgressiveScheduler, TooSlowAtTheCheapestSettingsReducesTheResolution) {
  ProgressiveScheduler slow = pacing("time=50");
  const FrameRequest coarse = settle(slow, kExact, 400);  // step 4: about 130 ms
  EXPECT_EQ(coarse.pixel_stride, 2u);
  EXPECT_LE(time_of(coarse, 400), 50);
  for (const FrameRequest& next : rest(slow, kExact, 400)) EXPECT_EQ(next.pixel_stride, 1u);

  ProgressiveScheduler slower = pacing("time=50");
  EXPECT_EQ(settle(slower, kExact, 4000).pixel_stride, render::kMaxPixelScale);
  ProgressiveScheduler fast = pacing("time=50");
  const FrameRequest fewer = settle(fast, kFast, 3000);  // every 4th pixel at step 2 takes longer than the budget
  EXPECT_GT(fewer.pixel_stride, 1u);
  EXPECT_LE(time_of(fewer, 3000), 50);
  ProgressiveScheduler quick = pacing("time=50");
  EXPECT_EQ(settle(quick, kExact, 20).pixel_stride, 1u);
}

TEST(ProgressiveScheduler, TheResolutionDoesNotOscillate) {
  ProgressiveScheduler p = pacing("time=50");
  const double near = 50 / render::relative_cost(render::quality_levels({false, false}).front(), false);  // step 4 takes the budget
  settle(p, kExact, 1.05 * near);
  int changes = 0;
  std::uint32_t before = p.current().pixel_stride;
  for (int k = 0; k < 100; ++k) {
    const FrameRequest next = p.interactive_frame(kExact);
    p.on_rendered(time_of(next, (k % 2 ? 0.95 : 1.1) * near));
    changes += next.pixel_stride != before;
    before = next.pixel_stride;
  }
  EXPECT_LE(changes, 1);
}

TEST(ProgressiveScheduler, ANamedQualityAppliesToTheImageAtRest) {
  for (const auto& [words, settings] :
       {std::pair{"reference", render::reference_settings()}, std::pair{"draft", render::draft_settings()}}) {
    ProgressiveScheduler p = pacing(words);
    EXPECT_LE(time_of(settle(p, kFast, 400), 400), kFrameBudgetMs);
    const auto all = rest(p, kFast, 400);
    ASSERT_EQ(all.size(), 1u) << words;
    EXPECT_EQ(all[0].settings.step_voxels, settings.step_voxels);
    EXPECT_EQ(all[0].settings.fast.has_value(), settings.fast.has_value());
  }
}

TEST(ProgressiveScheduler, AStatedErrorEndsTheRefinement) {
  ProgressiveScheduler p = pacing("error=1");
  settle(p, kFast, 400);
  EXPECT_FALSE(p.needs_estimate()) << "while it moves nobody measures errors";
  const auto first = p.refined_frame(kFast);
  ASSERT_TRUE(first);
  EXPECT_TRUE(p.needs_estimate());
  p.set_estimate(1.7);
  p.on_rendered(100);
  EXPECT_TRUE(test::has(p.status_text(), "error 1.70"));
  ASSERT_TRUE(p.refined_frame(kFast));
  p.set_estimate(0.9);
  p.on_rendered(200);
  EXPECT_FALSE(p.refined_frame(kFast));
  EXPECT_TRUE(p.is_finished());
}

TEST(ProgressiveScheduler, AReusedImageKeepsItsQualityAndDoesNotChangeTheTimeEstimate) {
  ProgressiveScheduler p = pacing("time=50");
  settle(p, kFast, 400);
  const auto all = rest(p, kFast, 400);
  ASSERT_TRUE(p.is_finished());
  for (int k = 0; k < 20; ++k) {
    const FrameRequest reused = p.reused_frame();
    EXPECT_TRUE(reused.settings.reuse_rays);
    EXPECT_EQ(reused.settings.fast, all.back().settings.fast);
    EXPECT_EQ(reused.pixel_stride, all.back().pixel_stride);
    p.on_rendered(0.5);  // few rays were marched
  }
  // The short time of reused images must not change the estimate for interactive images.
  EXPECT_LE(time_of(p.interactive_frame(kFast), 400), 50);
}

TEST(ProgressiveScheduler, ReuseThatIsTooSlowEndsUntilTheNextRest) {
  ProgressiveScheduler p = pacing("time=50");
  settle(p, kExact, 400);
  rest(p, kExact, 400);
  p.reused_frame();
  p.on_rendered(100);
  EXPECT_TRUE(p.may_reuse());
  p.reused_frame();
  p.on_rendered(160);  // nearly the whole image was behind the moving object
  EXPECT_FALSE(p.may_reuse());
  p.on_rendered(time_of(p.interactive_frame(kExact), 400));
  EXPECT_FALSE(p.may_reuse());
  p.refined_frame(kExact);
  EXPECT_TRUE(p.may_reuse());
}

TEST(ProgressiveScheduler, RefinementBetweenReusedImagesNeedsAShortTime) {
  for (const auto& [ms, may] : {std::pair{100.0, true}, {100000.0, false}}) {
    ProgressiveScheduler p = pacing("time=50");
    settle(p, kExact, ms);
    EXPECT_EQ(p.may_refine(), may) << ms;
    rest(p, kExact, ms);
    EXPECT_TRUE(p.may_refine()) << "nothing better is to come";
  }
}

TEST(ProgressiveScheduler, ASceneWithoutRaysIsRefinedAtMostOnce) {
  ProgressiveScheduler p = pacing("time=50");
  settle(p, kNoRays, 1);
  EXPECT_TRUE(p.current().settings.smooth_edges) << "there is ample time";
  EXPECT_TRUE(rest(p, kNoRays, 1).empty()) << "what moved was whole already";
  ProgressiveScheduler busy = pacing("time=50");
  settle(busy, kNoRays, 40);
  EXPECT_FALSE(busy.current().settings.smooth_edges);
  ASSERT_EQ(rest(busy, kNoRays, 40).size(), 1u);
  EXPECT_TRUE(busy.current().settings.smooth_edges) << "at rest";
  EXPECT_FALSE(busy.reused_frame().settings.smooth_edges) << "the probe moves";
  busy.on_rendered(40);
  const auto again = busy.refined_frame(kNoRays);
  ASSERT_TRUE(again);
  EXPECT_TRUE(again->settings.smooth_edges && again->settings.reuse_rays) << "at rest again";
  EXPECT_FALSE(busy.refined_frame(kNoRays));
  ProgressiveScheduler slow = pacing("time=50");
  ASSERT_GT(settle(slow, kNoRays, 2000).pixel_stride, 1u);
  const auto all = rest(slow, kNoRays, 2000);
  ASSERT_EQ(all.size(), 1u);
  EXPECT_EQ(all[0].pixel_stride, 1u);
}

TEST(ProgressiveScheduler, TheInterfaceReducesTheDefaultTimeOfAnInteractiveFrame) {
  ProgressiveScheduler chosen = pacing("balanced"), requested = pacing("time=50");
  EXPECT_EQ(chosen.budget_ms(), 50);
  for (int k = 0; k < 200; ++k) chosen.on_interface_drawn(30), requested.on_interface_drawn(30);
  EXPECT_NEAR(chosen.budget_ms() + 30, 0.95 * 1000 / 15, 1e-6) << "15 frames per second";
  EXPECT_EQ(requested.budget_ms(), 50) << "as requested";
  for (int k = 0; k < 200; ++k) chosen.on_interface_drawn(1000);
  EXPECT_EQ(chosen.budget_ms(), 20) << "an image stays an image";
}

TEST(BandAnimationClock, RunsAtHalfAPeriodPerSecondAndPausesWhenHidden) {
  BandAnimationClock clock;
  const auto ns = [](double s) { return static_cast<std::int64_t>(1e9 * s); };
  EXPECT_FALSE(clock.advance(ns(10), true, 0.9)) << "it begins";
  EXPECT_FALSE(clock.advance(ns(10.01), true, 0.9)) << "too soon";
  const auto phase = clock.advance(ns(10.4), true, 0.9);
  ASSERT_TRUE(phase);
  EXPECT_NEAR(*phase, 0.1, 1e-9);  // 0.9 + 0.4 / 2, modulo 1
  EXPECT_FALSE(clock.advance(ns(11), false, *phase));
  EXPECT_FALSE(clock.advance(ns(20), true, *phase)) << "the pause does not count";
  EXPECT_NEAR(*clock.advance(ns(20.2), true, *phase), 0.2, 1e-9);
}

TEST(ProgressiveScheduler, TheErrorAtRestMayBeEstimatedForAnyTarget) {
  for (const char* words : {"time=50", "balanced"}) {
    ProgressiveScheduler p = pacing(words);
    settle(p, kFast, 400);
    EXPECT_FALSE(p.may_estimate()) << "it moves";
    rest(p, kFast, 400);
    EXPECT_TRUE(p.may_estimate()) << words;
    p.set_estimate(0.4);
    EXPECT_EQ(p.rmse(), 0.4);
    EXPECT_FALSE(p.may_estimate()) << "once";
    EXPECT_TRUE(test::has(p.status_text(), "error 0.40"));
    EXPECT_FALSE(p.refined_frame(kFast)) << "and nothing is drawn for it";
    p.on_rendered(time_of(p.interactive_frame(kFast), 400));
    EXPECT_FALSE(p.rmse());
  }
}

}  // namespace catena::app::progressive_scheduler_test
