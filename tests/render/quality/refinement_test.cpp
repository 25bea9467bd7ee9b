// SPDX-License-Identifier: MIT
/// Quality levels, their expected times, and the refinement steps of a viewer.
#include "render/quality/refinement.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>

namespace catena::test::refinement_test {

using namespace catena::render;

/// Time of an image on a machine with `unit_ms` per unit of cost.
double time_of(const RenderSettings& settings, double unit_ms, bool shaded = false) { return unit_ms * relative_cost(settings, shaded); }

/// The level on which a moving camera settles.
RefinementStep settle(Refinement& refinement, double unit_ms, bool shaded = false) {
  RefinementStep step;
  for (int k = 0; k < 60; ++k) {
    step = *refinement.next(true);
    refinement.record_render_ms(time_of(step.settings, unit_ms, shaded));
  }
  return step;
}

TEST(QualityLevels, RiseInCostAndEndWithExactRays) {
  for (const bool fast : {false, true})
    for (const bool shaded : {false, true}) {
      const auto ladder = quality_levels({fast, shaded});
      ASSERT_GE(ladder.size(), 4u);
      for (std::size_t i = 1; i < ladder.size(); ++i) EXPECT_GE(relative_cost(ladder[i], shaded), relative_cost(ladder[i - 1], shaded));
      EXPECT_FALSE(ladder.back().fast);
      EXPECT_EQ(ladder.front().fast.has_value(), fast);
    }
}

TEST(QualityLevels, CostsDependOnRaysStepsAndShading) {
  RenderSettings coarse, fine;
  coarse.fast = FastSettings{4, 4, -1, -1};
  fine.fast = FastSettings{4, 1, 0, -1};
  EXPECT_GT(relative_cost(fine, false), 4 * relative_cost(coarse, false));
  RenderSettings refined = coarse;
  refined.fast->refine_half_255 = 0.5;
  EXPECT_GT(relative_cost(refined, false), relative_cost(coarse, false));
  RenderSettings smooth = fine;
  smooth.fast->smooth_gradients = true;
  EXPECT_GT(relative_cost(smooth, true), relative_cost(fine, true));
  EXPECT_GT(relative_cost({}, true), relative_cost(fine, true));
}

/// The cheapest shaded levels use the gradient of the cell; all levels after the first with smooth gradients use those.
TEST(QualityLevels, TheCheapestShadedLevelsUseCellGradients) {
  const auto ladder = quality_levels({true, true});
  const auto smooth = [](const RenderSettings& s) { return !s.fast || s.fast->smooth_gradients; };
  EXPECT_FALSE(smooth(ladder.front()));
  EXPECT_TRUE(std::ranges::is_partitioned(ladder, [&](const RenderSettings& s) { return !smooth(s); }));
  for (const RenderSettings& plain : quality_levels({true, false})) EXPECT_FALSE(plain.fast && plain.fast->smooth_gradients);
}

TEST(TimeModel, FollowsMeasurementsAndIgnoresPipelineCreation) {
  TimeModel times({0.1, 1}, 100);
  EXPECT_DOUBLE_EQ(times.expected_ms(0), 10);
  times.add_measurement(0, 80);  // the first image created a pipeline
  EXPECT_DOUBLE_EQ(times.expected_ms(0), 10);
  for (int k = 0; k < 20; ++k) times.add_measurement(0, 20);
  EXPECT_NEAR(times.expected_ms(0), 20, 1e-6);
  EXPECT_GT(times.expected_ms(1), 110);  // a measurement of one level scales the others
  times.add_measurement(0, 20);
  EXPECT_NEAR(times.expected_ms(0), 20, 1e-6);
  TimeModel quick({0.1, 1}, 100);
  quick.add_measurement(0, 5);  // faster than expected: not caused by a pipeline
  EXPECT_LT(quick.expected_ms(0), 10);
}

TEST(TimeModel, UnmeasuredLevelsAreEstimatedFromTheirNeighbours) {
  TimeModel times({1, 2, 4, 8}, 10);
  for (int k = 0; k < 20; ++k) times.add_measurement(1, 5);  // four times faster than the initial estimate
  EXPECT_NEAR(times.expected_ms(1), 5, 1e-6);
  EXPECT_NEAR(times.expected_ms(2), 10, 1e-6);
  EXPECT_NEAR(times.expected_ms(0), 2.5, 1e-6);
  // between two measured levels the slower scale applies
  for (int k = 0; k < 40; ++k) times.add_measurement(3, 40), times.add_measurement(1, 5);
  EXPECT_NEAR(times.expected_ms(3), 40, 0.1);
  EXPECT_NEAR(times.expected_ms(2), 20, 0.1);
}

TEST(Refinement, AMovingCameraStaysWithinItsBudget) {
  double last_cost = 0;
  for (const double budget : {40.0, 55.0, 80.0, 200.0}) {
    Refinement refinement(budget, {true, false});
    const RefinementStep step = settle(refinement, 600);
    EXPECT_LE(time_of(step.settings, 600), budget) << budget;
    EXPECT_NEAR(step.expected_ms, time_of(step.settings, 600), 0.05 * budget);
    EXPECT_GE(relative_cost(step.settings, false), last_cost) << budget;
    last_cost = relative_cost(step.settings, false);
  }
  EXPECT_GT(last_cost, 0.1);
}

TEST(Refinement, ASlowMachineGetsTheCheapestLevel) {
  Refinement refinement(5, {true, true});
  const RefinementStep step = settle(refinement, 1e5, true);
  EXPECT_EQ(step.settings.fast->step_voxels, 8);
  EXPECT_EQ(step.settings.fast->spacing, 4u);
  EXPECT_GT(step.expected_ms, 5);  // the expected time exceeds the budget
}

TEST(Refinement, AStillViewRefinesToEveryPixelAndEnds) {
  for (const bool shaded : {false, true}) {
    Refinement refinement(20, {true, shaded});
    const RefinementStep moving = settle(refinement, 600, shaded);
    std::vector<std::uint32_t> spacings{moving.settings.fast->spacing};
    double cost = relative_cost(moving.settings, shaded);
    bool finished = false;
    for (int k = 0; k < 10; ++k) {
      const auto step = refinement.next(false);
      if (!step) break;
      EXPECT_FALSE(finished);
      EXPECT_GT(relative_cost(step->settings, shaded), cost);
      cost = relative_cost(step->settings, shaded);
      spacings.push_back(step->settings.fast->spacing);
      finished = step->is_final;
      refinement.record_render_ms(time_of(step->settings, 600, shaded));
    }
    EXPECT_TRUE(finished);
    EXPECT_FALSE(refinement.next(false));
    EXPECT_EQ(spacings.front(), 4u);
    EXPECT_EQ(spacings.back(), 1u);
    EXPECT_TRUE(std::is_sorted(spacings.rbegin(), spacings.rend()));
    EXPECT_LE(spacings.size(), 5u);
    // a moving view restarts
    const auto again = refinement.next(true);
    ASSERT_TRUE(again);
    EXPECT_LE(relative_cost(again->settings, shaded), relative_cost(moving.settings, shaded));
  }
}

TEST(Refinement, TheLevelIsStableUnderNoise) {
  // with times that vary by a tenth, at most two neighbouring levels remain
  Refinement refinement(66, {true, false});
  std::map<double, int> seen;
  for (int k = 0; k < 200; ++k) {
    const RefinementStep step = *refinement.next(true);
    const double wavering = 1 + 0.1 * (k % 3 - 1);
    refinement.record_render_ms(time_of(step.settings, 600) * wavering);
    if (k >= 100) ++seen[relative_cost(step.settings, false)];
  }
  EXPECT_LE(seen.size(), 2u);
}

TEST(Refinement, WithoutTheFastRaycastStepsAreRefined) {
  Refinement refinement(50, {false, false});
  const RefinementStep moving = settle(refinement, 1000);
  EXPECT_FALSE(moving.settings.fast);
  EXPECT_EQ(moving.settings.step_voxels, 4);
  std::vector<double> steps;
  while (const auto step = refinement.next(false)) {
    steps.push_back(step->settings.step_voxels);
    refinement.record_render_ms(100);
  }
  EXPECT_EQ(steps, (std::vector<double>{2, 1, 0.5}));
}

}  // namespace catena::test::refinement_test
