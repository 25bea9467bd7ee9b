// SPDX-License-Identifier: MIT
// The paper's rules for stimuli, over 200 seeds for each task, checked independently of the generator: with a Runge-Kutta method of small
// fixed steps, in the field of the trial's scene.
#include <numbers>

#include "engine/scene/scene.h"
#include "engine/study/session.h"
#include "engine/study/trial_scene.h"
#include "tests/engine/study/study_fixture.h"

namespace stimulus_test {

using namespace catena;

constexpr int kSeeds = 200;
constexpr std::size_t kFine = 1500;  // number of steps, three times as fine as the generated path

field::AnyField field_of(const study::Task& task, int seed) {
  auto scene = scene::parse_scene(study::make_field_scene(study_rig::paper_study(), task, seed), "field.json");
  return scene::resolve_field(*scene, task.field, task.where).value();
}

/// Positions along a streamline in arc length with a fixed step; `way` is 1 downstream and -1 upstream.
std::vector<Vec3> walk(const field::VectorField& field, Vec3 p, double length, int steps, double way = 1) {
  field::Cursor cursor;
  const auto rate = [&](const Vec3& at) { return way * direction(field.sample(at, cursor).value); };
  const double h = length / steps;
  std::vector<Vec3> out{p};
  for (int i = 0; i < steps; ++i) {
    const Vec3 a = rate(p), b = rate(p + 0.5 * h * a), c = rate(p + 0.5 * h * b), d = rate(p + h * c);
    p += h / 6 * (a + 2.0 * b + 2.0 * c + d);
    out.push_back(p);
  }
  return out;
}

double distance_to(const std::vector<Vec3>& line, const Vec3& p) {
  double least = 1e300;
  for (std::size_t i = 1; i < line.size(); ++i) {
    const Vec3 way = line[i] - line[i - 1];
    const double u = std::clamp(dot(p - line[i - 1], way) / dot(way, way), 0.0, 1.0);
    least = std::min(least, norm(p - line[i - 1] - u * way));
  }
  return least;
}

/// The stimuli of 200 seeds for a task, generated once.
const std::vector<study::Stimulus>& stimuli(std::size_t task) {
  static std::array<std::vector<study::Stimulus>, 4> made;
  if (made[task].empty()) {
    study::StimulusGenerator maker(study_rig::paper_study());
    for (int seed = 0; seed < kSeeds; ++seed) made[task].push_back(maker.generate(static_cast<int>(task), 1000 * seed).value());
  }
  return made[task];
}

class StimulusGeneration : public testing::TestWithParam<std::size_t> {
 protected:
  const study::Task& task() const { return study_rig::paper_study().tasks[GetParam()]; }
};

TEST_P(StimulusGeneration, EveryPathIsAStreamlineOfTheStatedLength) {
  const double length = task().world_from_mm(100);
  for (const study::Stimulus& s : stimuli(GetParam())) {
    const field::AnyField field = field_of(task(), s.seed);
    const std::vector<Vec3> path = walk(*field.vector, s.start, length, 512);
    ASSERT_EQ(s.path.size(), static_cast<std::size_t>(study::kPathPoints));
    for (std::size_t i = 0; i < s.path.size(); ++i) ASSERT_LT(norm(s.path[i] - path[i]), 1e-5) << s.seed << " at " << i;
    EXPECT_EQ(s.start, s.path.front());
    EXPECT_EQ(s.end, s.path.back());
    EXPECT_LT(norm(s.middle - path[256]), 1e-5);
    for (const Vec3& p : s.path) ASSERT_LE(max_abs(p), 2);
    for (std::size_t i = 4; i + 4 < path.size(); i += 4) {
      // The circle through three points.
      const Vec3 a = path[i - 4] - path[i], b = path[i + 4] - path[i];
      const double bend = 2 * norm(cross(a, b)) / (norm(a) * norm(b) * norm(b - a));
      ASSERT_LT(bend * task().world_from_mm(task().rules.min_curvature_radius_mm), 1.02) << s.seed << " at " << i;
    }
    EXPECT_LE(max_abs(s.start), 1 + 1e-12) << "in the middle half of the box";
  }
}

TEST_P(StimulusGeneration, TheStartIsNotOnAContextStreamline) {
  for (std::size_t k = 0; k < kSeeds; k += 4) {
    const study::Stimulus& s = stimuli(GetParam())[k];
    const field::AnyField field = field_of(task(), s.seed);
    EXPECT_EQ(s.context_points.size(), static_cast<std::size_t>(task().rules.context_streamlines));
    for (const Vec3& seed : s.context_points)
      for (const double way : {1.0, -1.0}) {
        const double off = distance_to(walk(*field.vector, seed, s.context_length, 150, way), s.start);
        ASSERT_GT(task().mm_from_world(off), task().rules.clearance_mm - 0.05) << s.seed;
      }
  }
}

class AdvectionRules : public StimulusGeneration {};

TEST_P(AdvectionRules, TheTargetIsFirstCrossedAtThePathsEndAndSteeply) {
  const double crossing = std::sin(task().rules.crossing_deg * std::numbers::pi / 180);
  for (const study::Stimulus& s : stimuli(GetParam())) {
    const field::AnyField field = field_of(task(), s.seed);
    const std::vector<Vec3> path = walk(*field.vector, s.start, s.length, kFine);
    const Vec3 along = direction(path[kFine] - path[kFine - 1]);
    for (std::size_t i = 0; i + 1 < kFine; ++i) {
      if (task().target == study::Target::circle)
        ASSERT_LT(norm(path[i] - s.start), s.radius) << s.seed << " at " << i;
      else
        ASSERT_GT(path[i].z, s.end.z) << s.seed << " at " << i;
    }
    EXPECT_NEAR(s.radius, norm(path[kFine] - path[0]), 1e-6);
    const double steep = task().target == study::Target::circle ? dot(along, direction(path[kFine] - path[0])) : -along.z;
    EXPECT_GT(steep, crossing - 5e-3) << s.seed;
  }
}

TEST_P(StimulusGeneration, PathsAreNearlyParallelToTheImagePlane) {
  for (const study::Stimulus& s : stimuli(GetParam())) {
    double seen = 0;
    for (std::size_t i = 1; i < s.path.size(); ++i) {
      const Vec3 way = s.path[i] - s.path[i - 1];
      const double depth = dot(way, task().view_direction);
      ASSERT_TRUE(task().dimensions == 3 || std::fabs(s.path[i].z) < 1e-12);
      seen += std::sqrt(std::max(0.0, dot(way, way) - depth * depth));
    }
    EXPECT_GE(seen / s.length, task().dimensions == 2 ? 1 - 1e-4 : task().rules.parallel - 1e-4) << s.seed;
  }
}

std::string name_of(const testing::TestParamInfo<std::size_t>& of) { return study_rig::paper_study().tasks[of.param].name; }
INSTANTIATE_TEST_SUITE_P(Tasks, StimulusGeneration, testing::Values(0, 1, 2, 3), name_of);
INSTANTIATE_TEST_SUITE_P(Tasks, AdvectionRules, testing::Values(0, 2), name_of);

/// The fraction of the path that lines hide, by the angle between two rays from the camera.
double hidden(const study::Task& task, const study::Stimulus& s, const std::vector<std::vector<Vec3>>& lines) {
  int behind = 0, all = 0;
  for (std::size_t i = 0; i < s.path.size(); i += 16, ++all) {
    const Vec3 to_path = s.path[i] - task.camera_position;
    bool is_hidden = false;
    for (const auto& line : lines)
      for (const Vec3& q : line) {
        const Vec3 to_line = q - task.camera_position;
        const double off = norm(cross(direction(to_path), to_line));
        is_hidden = is_hidden || (norm(to_line) < norm(to_path) - 0.06 && off < task.world_from_mm(1.5));
      }
    behind += is_hidden;
  }
  return static_cast<double>(behind) / all;
}

TEST(Stimulus, MoreCandidatesReduceTheHiddenPart) {
  study::Study study = study_rig::paper_study();
  const study::Task& task = study.tasks[3];
  study::Study hasty = study;
  hasty.tasks[3].rules.candidates = 8;  // enough for a start, not for a choice
  study::StimulusGenerator careful_maker(study), hasty_maker(hasty);
  double careful_sum = 0, hasty_sum = 0;
  for (int seed = 0; seed < 40; ++seed) {
    const auto careful = careful_maker.generate(3, 50 * seed), quick = hasty_maker.generate(3, 50 * seed);
    ASSERT_TRUE(careful && quick);
    const field::AnyField field = field_of(task, careful->seed);
    std::vector<std::vector<Vec3>> lines;
    for (const Vec3& place : careful->context_points)
      for (const double way : {1.0, -1.0}) lines.push_back(walk(*field.vector, place, careful->context_length, 150, way));
    EXPECT_NEAR(careful->occluded_share, hidden(task, *careful, lines), 0.1) << careful->seed;
    careful_sum += careful->occluded_share;
    hasty_sum += quick->occluded_share;
    EXPECT_TRUE(careful->seed != quick->seed || careful->occluded_share <= quick->occluded_share) << careful->seed;
  }
  EXPECT_LT(careful_sum, 0.5 * hasty_sum + 1e-9);
}

TEST(Stimulus, IsRepeatableAndDependsOnTheSeed) {
  study::StimulusGenerator maker(study_rig::paper_study()), other(study_rig::paper_study());
  const auto a = maker.generate(2, 5), b = maker.generate(2, 6), again = other.generate(2, 5);
  EXPECT_EQ(a->path, again->path);
  EXPECT_NE(a->start, b->start);
}

TEST(Stimulus, ImpossibleRulesAreAnErrorWithTheirLine) {
  const std::string vortices = R"("analytic": "vortices", "dimensions": 2, "seed": "$seed")";
  study::Study long_path = study_rig::small(vortices, R"("analytic": "node")");
  long_path.tasks[0].rules.path_mm = 1000;
  const auto made = study::StimulusGenerator(long_path).generate(0, 1);
  ASSERT_FALSE(made);
  EXPECT_TRUE(made.error().message.starts_with("small.json:4: task \"trace\": no start")) << made.error().message;
  const study::Study scalar = study_rig::small(vortices, R"("analytic": "sphere")");
  EXPECT_NE(study::StimulusGenerator(scalar).generate(0, 1).error().message.find("scalar"), std::string::npos);
}

}  // namespace stimulus_test
