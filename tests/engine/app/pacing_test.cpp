/// Which picture the window shows next, told the times; and the phase of pulses, told the clock.
#include "engine/app/viewer/shell/pacing.h"

#include <gtest/gtest.h>

namespace catena::app {
namespace pacing_test {

constexpr SceneKind kFast{true, true, false}, kExact{true, false, false}, kNoRays{false, false, false};

Pacing pacing(const std::string& words) {
  auto quality = parse_quality(words);
  EXPECT_TRUE(quality);
  return Pacing(*quality);
}

/// A machine on which a unit of cost takes `unit_ms` for a picture of full size.
double time_of(const NextPicture& next, double unit_ms) {
  return unit_ms * render::relative_cost(next.settings, false) / (next.scale * next.scale);
}

NextPicture settle(Pacing& p, const SceneKind& kind, double unit_ms) {
  NextPicture next;
  for (int k = 0; k < 60; ++k) {
    next = p.moving(kind);
    p.drawn(time_of(next, unit_ms));
  }
  return next;
}

/// The pictures of rest.
std::vector<NextPicture> rest(Pacing& p, const SceneKind& kind, double unit_ms) {
  std::vector<NextPicture> all;
  while (const auto next = p.still(kind)) {
    all.push_back(*next);
    p.drawn(time_of(*next, unit_ms));
    if (all.size() > 20) break;
  }
  return all;
}

TEST(Pacing, WhileItMovesAPictureComesInTimeAndMoreTimeMakesItBetter) {
  double before = 0;
  for (const char* words : {"time=20", "time=50", "time=200"}) {
    Pacing p = pacing(words);
    const NextPicture next = settle(p, kFast, 320);
    EXPECT_LE(time_of(next, 320), std::stod(std::string(words).substr(5))) << words;
    EXPECT_EQ(next.scale, 1u);
    const double cost = render::relative_cost(next.settings, false);
    EXPECT_GT(cost, before) << words;
    before = cost;
  }
}

TEST(Pacing, AtRestItGoesToEveryPixelAndEnds) {
  Pacing p = pacing("time=50");
  settle(p, kFast, 400);
  const auto all = rest(p, kFast, 400);
  ASSERT_GE(all.size(), 2u);
  EXPECT_EQ(all.front().settings.fast->spacing, 4u);
  for (std::size_t i = 1; i < all.size(); ++i)
    EXPECT_LE(all[i].settings.fast ? all[i].settings.fast->spacing : 1, all[i - 1].settings.fast->spacing);
  EXPECT_TRUE(!all.back().settings.fast || all.back().settings.fast->spacing == 1);
  EXPECT_TRUE(p.finished());
  p.moving(kFast);
  EXPECT_FALSE(p.finished());
  EXPECT_EQ(render::describe(p.best(kFast).settings), render::describe(all.back().settings));
  EXPECT_TRUE(p.finished());
}

TEST(Pacing, WhereEvenTheCheapestTakesTooLongThereAreFewerPixels) {
  Pacing slow = pacing("time=50");
  const NextPicture coarse = settle(slow, kExact, 400);  // step 4: some 130 ms
  EXPECT_EQ(coarse.scale, 2u);
  EXPECT_LE(time_of(coarse, 400), 50);
  for (const NextPicture& next : rest(slow, kExact, 400)) EXPECT_EQ(next.scale, 1u);

  Pacing slower = pacing("time=50");
  EXPECT_EQ(settle(slower, kExact, 4000).scale, render::kMaxScale);
  Pacing quick = pacing("time=50");
  EXPECT_EQ(settle(quick, kExact, 20).scale, 1u);
}

TEST(Pacing, TheNumberOfPixelsDoesNotComeAndGo) {
  Pacing p = pacing("time=50");
  const double near = 50 / render::relative_cost(render::quality_ladder({false, false}).front(), false);  // step 4 takes the budget
  settle(p, kExact, 1.05 * near);
  int changes = 0;
  std::uint32_t before = p.again().scale;
  for (int k = 0; k < 100; ++k) {
    const NextPicture next = p.moving(kExact);
    p.drawn(time_of(next, (k % 2 ? 0.95 : 1.1) * near));
    changes += next.scale != before;
    before = next.scale;
  }
  EXPECT_LE(changes, 1);
}

TEST(Pacing, ANamedQualityIsThePictureAtRest) {
  for (const auto& [words, settings] :
       {std::pair{"reference", render::reference_settings()}, std::pair{"draft", render::draft_settings()}}) {
    Pacing p = pacing(words);
    EXPECT_LE(time_of(settle(p, kFast, 400), 400), kBudgetMs);
    const auto all = rest(p, kFast, 400);
    ASSERT_EQ(all.size(), 1u) << words;
    EXPECT_EQ(all[0].settings.step_voxels, settings.step_voxels);
    EXPECT_EQ(all[0].settings.fast.has_value(), settings.fast.has_value());
  }
}

TEST(Pacing, AStatedErrorEndsTheRefinement) {
  Pacing p = pacing("error=1");
  settle(p, kFast, 400);
  EXPECT_FALSE(p.wants_estimate()) << "while it moves nobody measures errors";
  const auto first = p.still(kFast);
  ASSERT_TRUE(first);
  EXPECT_TRUE(p.wants_estimate());
  p.estimated(1.7);
  p.drawn(100);
  EXPECT_NE(p.words().find("error 1.70"), std::string::npos) << p.words();
  ASSERT_TRUE(p.still(kFast));
  p.estimated(0.9);
  p.drawn(200);
  EXPECT_FALSE(p.still(kFast));
  EXPECT_TRUE(p.finished());
}

TEST(Pacing, APictureThatIsKeptIsAsGoodAsTheLastAndItsTimeTeachesNothing) {
  Pacing p = pacing("time=50");
  settle(p, kFast, 400);
  const auto all = rest(p, kFast, 400);
  ASSERT_TRUE(p.finished());
  for (int k = 0; k < 20; ++k) {
    const NextPicture kept = p.kept();
    EXPECT_TRUE(kept.settings.keep);
    EXPECT_EQ(kept.settings.fast, all.back().settings.fast);
    EXPECT_EQ(kept.scale, all.back().scale);
    p.drawn(0.5);  // hardly anything was marched
  }
  // or the next that moves would come far too late
  EXPECT_LE(time_of(p.moving(kFast), 400), 50);
}

TEST(Pacing, WhatIsKeptFarTooLateIsNotKeptAgainBeforeSomethingRests) {
  Pacing p = pacing("time=50");
  settle(p, kExact, 400);
  rest(p, kExact, 400);
  p.kept();
  p.drawn(100);
  EXPECT_TRUE(p.may_keep());
  p.kept();
  p.drawn(160);  // nearly all of the picture was under what moved
  EXPECT_FALSE(p.may_keep());
  p.drawn(time_of(p.moving(kExact), 400));
  EXPECT_FALSE(p.may_keep());
  p.still(kExact);
  EXPECT_TRUE(p.may_keep());
}

TEST(Pacing, BetterPicturesComeBetweenKeptOnesUnlessTheHandsWouldStandForLong) {
  for (const auto& [ms, may] : {std::pair{100.0, true}, {100000.0, false}}) {
    Pacing p = pacing("time=50");
    settle(p, kExact, ms);
    EXPECT_EQ(p.may_improve(), may) << ms;
    rest(p, kExact, ms);
    EXPECT_TRUE(p.may_improve()) << "nothing better is to come";
  }
}

TEST(Pacing, ASceneWithoutRaysIsDrawnOnceMoreAtMost) {
  Pacing p = pacing("time=50");
  settle(p, kNoRays, 1);
  EXPECT_TRUE(rest(p, kNoRays, 1).empty()) << "what moved was whole already";
  Pacing slow = pacing("time=50");
  ASSERT_GT(settle(slow, kNoRays, 2000).scale, 1u);
  const auto all = rest(slow, kNoRays, 2000);
  ASSERT_EQ(all.size(), 1u);
  EXPECT_EQ(all[0].scale, 1u);
}

TEST(PulseClock, RunsAtHalfATurnASecondAndStandsWhileNobodyLooks) {
  PulseClock clock;
  const auto ns = [](double s) { return static_cast<std::int64_t>(1e9 * s); };
  EXPECT_FALSE(clock.advance(ns(10), true, 0.9)) << "it begins";
  EXPECT_FALSE(clock.advance(ns(10.01), true, 0.9)) << "too soon";
  const auto phase = clock.advance(ns(10.4), true, 0.9);
  ASSERT_TRUE(phase);
  EXPECT_NEAR(*phase, 0.1, 1e-9);  // 0.9 + 0.4 / 2, round
  EXPECT_FALSE(clock.advance(ns(11), false, *phase));
  EXPECT_FALSE(clock.advance(ns(20), true, *phase)) << "the pause does not count";
  EXPECT_NEAR(*clock.advance(ns(20.2), true, *phase), 0.2, 1e-9);
}

TEST(Pacing, AnyGoalMayHearTheErrorOfItsPictureAtRest) {
  for (const char* words : {"time=50", "balanced"}) {
    Pacing p = pacing(words);
    settle(p, kFast, 400);
    EXPECT_FALSE(p.may_estimate()) << "it moves";
    rest(p, kFast, 400);
    EXPECT_TRUE(p.may_estimate()) << words;
    p.estimated(0.4);
    EXPECT_EQ(p.rmse(), 0.4);
    EXPECT_FALSE(p.may_estimate()) << "once";
    EXPECT_NE(p.words().find("error 0.40"), std::string::npos) << p.words();
    EXPECT_FALSE(p.still(kFast)) << "and nothing is drawn for it";
    p.drawn(time_of(p.moving(kFast), 400));
    EXPECT_FALSE(p.rmse());
  }
}

}  // namespace pacing_test
}  // namespace catena::app
