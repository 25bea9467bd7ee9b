// SPDX-License-Identifier: MIT
// The trial scorer against cases that are worked out by hand: lengths in world units of 10 mm.
#include <gtest/gtest.h>

#include "engine/study/trial_scorer.h"

namespace trial_scorer_test {

using namespace catena;
using study::TrialScorer;
using Phase = TrialScorer::Phase;

study::Task task_of(study::TaskKind kind, int dimensions, study::Target target) {
  study::Task task;
  task.kind = kind;
  task.dimensions = dimensions;
  task.target = target;
  task.meters_per_unit = 0.01;
  task.start_radius_mm = 2;
  task.target_radius_mm = 3;
  task.limits.timeout_s = 5;
  task.view_direction = dimensions == 2 ? Vec3(0, 0, -1) : Vec3(0, 1, 0);
  return task;
}

const study::Task kTracing = task_of(study::TaskKind::tracing, 3, study::Target::end);
const study::Task kPlane = task_of(study::TaskKind::advection, 3, study::Target::plane);

/// A path with a corner: from the origin 10 along x, then 10 down.
study::Stimulus bent() {
  study::Stimulus s;
  s.path = {Vec3(0.0), Vec3(10, 0, 0), Vec3(10, 0, -10)};
  s.start = s.path.front();
  s.end = s.path.back();
  s.length = 20;
  s.radius = norm(s.end - s.start);
  return s;
}

study::Stimulus straight() {
  study::Stimulus s;
  s.path = {Vec3(0.0), Vec3(10, 0, 0)};
  s.end = s.path.back();
  s.length = s.radius = 10;
  return s;
}

TEST(TrialScorer, TheClockStartsWhenTheCursorLeavesTheStart) {
  TrialScorer scorer(kTracing, straight());
  EXPECT_EQ(scorer.tick(0, Vec3(3, 0, 0), 0), Phase::waiting) << "it has not been at the start";
  EXPECT_EQ(scorer.tick(100, Vec3(0.1, 0, 0), 9), Phase::ready) << "waiting takes no time";
  EXPECT_EQ(scorer.tick(200, Vec3(0, 0.19, 0), 9), Phase::ready);
  EXPECT_EQ(scorer.tick(300, Vec3(0.21, 0, 0), 1), Phase::running);
  EXPECT_EQ(scorer.tick(301, Vec3(5, 0, 0), 2), Phase::running);
  EXPECT_DOUBLE_EQ(scorer.running_s(), 1);
  EXPECT_EQ(scorer.tick(302, Vec3(9.71, 0, 0), 1.5), Phase::ended);
  EXPECT_TRUE(scorer.result().reached_target);
  EXPECT_DOUBLE_EQ(scorer.result().time_s, 2);
  EXPECT_NEAR(scorer.result().traveled_mm, 95, 1e-9);
  EXPECT_EQ(scorer.result().peak_force_n, 2) << "of the clock's ticks alone";
  EXPECT_EQ(scorer.tick(303, Vec3(0.0), 50), Phase::ended);
  EXPECT_EQ(scorer.result().peak_force_n, 2);
}

TEST(TrialScorer, TheTracingErrorIsTheMeanDistanceToThePath) {
  TrialScorer scorer(kTracing, bent());
  scorer.tick(0, Vec3(0.0), 0);
  scorer.tick(1, Vec3(1, 2, 0), 0);                            // 2 away from the first segment
  scorer.tick(2, Vec3(13, 0, 4), 0);                           // 5 away from the corner
  scorer.tick(3, Vec3(10.5, 0, -5), 0);                        // 0.5 away from the second segment
  const Phase phase = scorer.tick(4, Vec3(10, 0.1, -9.9), 0);  // 0.1 away; within 0.3 of the end
  ASSERT_EQ(phase, Phase::ended);
  EXPECT_NEAR(scorer.result().error_mm, 10 * (2 + 5 + 0.5 + 0.1) / 4, 1e-9);
  EXPECT_DOUBLE_EQ(scorer.result().time_s, 3);
}

TEST(TrialScorer, TwoDimensionalErrorsAreInTheImagePlane) {
  const study::Task task = task_of(study::TaskKind::tracing, 2, study::Target::end);
  TrialScorer scorer(task, straight());
  EXPECT_EQ(scorer.tick(0, Vec3(0, 0, 70), 0), Phase::ready) << "depth does not count";
  scorer.tick(1, Vec3(5, 1, -30), 0);
  EXPECT_EQ(scorer.tick(2, Vec3(10, 0.2, 12), 0), Phase::ended);
  EXPECT_NEAR(scorer.result().error_mm, 10 * (1 + 0.2) / 2, 1e-9);
  EXPECT_NEAR(scorer.result().end_mm.z, 0, 1e-12);
}

TEST(TrialScorer, ACircleIsCrossedBetweenTwoTicks) {
  const study::Task task = task_of(study::TaskKind::advection, 2, study::Target::circle);
  TrialScorer scorer(task, straight());
  scorer.tick(0, Vec3(0.0), 0);
  EXPECT_EQ(scorer.tick(1, Vec3(0, 6, 3), 0), Phase::running);
  EXPECT_EQ(scorer.tick(2, Vec3(8, 6, 3), 0), Phase::ended) << "(8, 6) is on the circle of radius 10";
  EXPECT_DOUBLE_EQ(scorer.result().time_s, 1);
  EXPECT_NEAR(scorer.result().error_mm, 10 * std::sqrt(4 + 36), 1e-9);

  TrialScorer later(task, straight());
  later.tick(0, Vec3(0.0), 0);
  later.tick(1, Vec3(8, 0, 0), 0);
  EXPECT_EQ(later.tick(2, Vec3(16, 0, 0), 0), Phase::ended);
  EXPECT_NEAR(later.result().time_s, 0.25, 1e-12) << "a quarter of the last tick's way";
  EXPECT_NEAR(later.result().error_mm, 0, 1e-9);
  EXPECT_NEAR(later.result().end_mm.x, 100, 1e-9);
}

TEST(TrialScorer, APlaneIsCrossedFromAboveOnly) {
  TrialScorer scorer(kPlane, bent());
  scorer.tick(0, Vec3(0.0), 0);
  EXPECT_EQ(scorer.tick(1, Vec3(10, 3, -8), 0), Phase::running);
  EXPECT_EQ(scorer.tick(2, Vec3(10, 3, -12), 0), Phase::ended);
  EXPECT_TRUE(scorer.result().reached_target);
  EXPECT_DOUBLE_EQ(scorer.result().time_s, 0.5);
  EXPECT_NEAR(scorer.result().error_mm, 30, 1e-9);
  EXPECT_NEAR(scorer.result().end_mm.z, -100, 1e-9);
}

TEST(TrialScorer, TheTimeLimitEndsTheTrial) {
  TrialScorer scorer(kPlane, bent());
  scorer.tick(0, Vec3(0.0), 0);
  scorer.tick(1, Vec3(1, 0, 0), 0);
  EXPECT_EQ(scorer.tick(5.999, Vec3(10, 0, -6), 0), Phase::running);
  EXPECT_EQ(scorer.tick(6, Vec3(10, 3, -6), 0), Phase::ended);
  EXPECT_FALSE(scorer.result().reached_target);
  EXPECT_DOUBLE_EQ(scorer.result().time_s, 5);
  EXPECT_NEAR(scorer.result().error_mm, 50, 1e-9) << "from the cursor to the end";

  TrialScorer never(kPlane, bent());
  never.tick(0, Vec3(0.0), 0);
  EXPECT_EQ(never.tick(1000, Vec3(0.1, 0, 0), 0), Phase::ready);
  EXPECT_FALSE(never.aborted_result().reached_target);
  EXPECT_DOUBLE_EQ(never.aborted_result().time_s, 5);
}

TEST(TrialScorer, NonFinitePositionsAreIgnored) {
  TrialScorer scorer(kTracing, straight());
  scorer.tick(0, Vec3(0.0), 0);
  scorer.tick(1, Vec3(1, 0, 0), 0);
  EXPECT_EQ(scorer.tick(2, Vec3(std::nan("")), 0), Phase::running);
  scorer.tick(3, Vec3(10, 0, 0), 0);
  EXPECT_DOUBLE_EQ(scorer.result().error_mm, 0);
}

}  // namespace trial_scorer_test
