// SPDX-License-Identifier: MIT
#include "engine/geometry/flow/vortex_cores.h"

#include <gtest/gtest.h>

#include "tests/engine/geometry/flow/analytic_cores.h"
#include "tests/support/results.h"

namespace catena::flow::vortex_cores_test {

VortexCoresPtr cores_of(const field::VectorFieldPtr& field, CoreCriterion criterion = CoreCriterion::sujudi_haimes) {
  return test::value_of(find_vortex_cores(field, {criterion}));
}

TEST(VortexCores, AreAccurateForKnownFlows) {
  constexpr int kNodes = 33;
  for (const test::AnalyticCore& known : test::analytic_cores())
    for (const bool cubic : {false, true}) {
      const auto grid = test::sample_core_flow(known, kNodes, 0, 1);
      const auto cores = cores_of(cubic ? field::VectorFieldPtr(*grid->as_cubic()) : grid);
      const test::CoreScore score = test::score_cores(*cores, known, 2.4 / (kNodes - 1));
      EXPECT_EQ(cores->lines.size(), 1u) << known.name << " " << cubic;
      EXPECT_EQ(score.recall, 1) << known.name << " " << cubic;
      EXPECT_EQ(score.false_length, 0) << known.name << " " << cubic;
      EXPECT_LT(score.worst, 0.5) << known.name << " " << cubic << ": nearer to another voxel";
      EXPECT_EQ(cores->lines.front()->is_closed(), known.name.starts_with("ring")) << known.name;
    }
}

TEST(VortexCores, NoiseDoesNotInterruptTheCore) {
  for (const test::AnalyticCore& known : test::analytic_cores()) {
    const auto cores = cores_of(test::sample_core_flow(known, 33, 0.02, 7));
    const test::CoreScore score = test::score_cores(*cores, known, 2.4 / 32);
    EXPECT_GT(score.recall, 0.98) << known.name;
    EXPECT_LT(score.false_length, 0.02) << known.name;
  }
}

TEST(VortexCores, SecondOrderIsMoreAccurateForBentCores) {
  for (const test::AnalyticCore& known : test::analytic_cores()) {
    if (known.name != "bent") continue;
    const auto grid = test::sample_core_flow(known, 49, 0, 1);
    const auto rms = [&](CoreCriterion criterion) { return test::score_cores(*cores_of(grid, criterion), known, 0.05).rms; };
    EXPECT_LT(rms(CoreCriterion::parallel_vectors), 0.5 * rms(CoreCriterion::sujudi_haimes));
  }
}

TEST(VortexCores, AreExactForFormulas) {
  const auto ring = cores_of(test::analytic_vector("hill"));
  ASSERT_EQ(ring->lines.size(), 1u);
  const Curve& line = *ring->lines.front();
  EXPECT_TRUE(line.is_closed());
  for (int i = 0; i < 5000; ++i) {
    const Vec3 p = line.position(line.period() * i / 5000);
    ASSERT_LE(norm(p - direction(Vec3(p.x, p.y, 0)) * std::sqrt(0.5)), 1e-9) << i;
  }
}

TEST(VortexCores, ABeltramiFlowHasNoCoreByVorticity) {
  const auto abc = test::analytic_vector("abc");
  for (const field::VectorFieldPtr& field : {abc, field::VectorFieldPtr(field::sample_on_grid(*abc, 33, -2, 2))}) {
    EXPECT_TRUE(cores_of(field, CoreCriterion::vorticity)->holds_everywhere);
    EXPECT_TRUE(cores_of(field, CoreCriterion::vorticity)->lines.empty());
    EXPECT_FALSE(cores_of(field)->holds_everywhere);
    EXPECT_FALSE(cores_of(field)->lines.empty());
  }
  // A plane vortex satisfies the second-order criterion everywhere.
  EXPECT_TRUE(cores_of(test::analytic_vector("lamb-oseen"), CoreCriterion::parallel_vectors)->holds_everywhere);
}

TEST(VortexCores, EndAtTheMask) {
  // A straight vortex along z on a grid whose upper half is masked.
  constexpr int n = 17;
  std::vector<std::uint8_t> valid;
  for (int k = 0; k < n; ++k)
    for (int i = 0; i < n * n; ++i) valid.push_back(k <= 9);
  const auto grid = test::sample_vector_grid(
      field::Mapping::from_linear(Mat3(0.25), Vec3(-2.0)), {n, n, n}, [](const Vec3& p) { return Vec3(-p.y, p.x, 0.5); }, valid);
  const auto cores = cores_of(grid);
  ASSERT_EQ(cores->lines.size(), 1u);
  const Curve& line = *cores->lines.front();
  const bool up = line.knots().back().p.z > line.knots().front().p.z;
  const Knot &top = up ? line.knots().back() : line.knots().front(), &bottom = up ? line.knots().front() : line.knots().back();
  EXPECT_NEAR(top.p.z, 0.25, 1e-3);
  EXPECT_NEAR(bottom.p.z, -2, 1e-3);
  EXPECT_EQ((up ? line.last_end() : line.first_end()).status, SampleStatus::masked);
  EXPECT_EQ((up ? line.first_end() : line.last_end()).status, SampleStatus::outside_box);
}

TEST(VortexCores, AreCachedWhileInUse) {
  const auto field = test::analytic_vector("helix");
  const auto first = cores_of(field);
  EXPECT_EQ(first, cores_of(field));
  EXPECT_NE(first, cores_of(field, CoreCriterion::vorticity));
}

}  // namespace catena::flow::vortex_cores_test
