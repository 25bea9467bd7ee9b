// SPDX-License-Identifier: MIT
#include "engine/geometry/flow/seeds.h"

#include <gtest/gtest.h>

#include <numbers>

#include "tests/engine/geometry/flow/lambda_field.h"
#include "tests/support/results.h"

namespace catena::flow::seeds_test {

using test::sample_vector_grid;

TEST(Seeds, ALineIncludesBothEnds) {
  const auto seeds = seeds_on_line({0, 0, 0}, {3, 0, -6}, 4);
  ASSERT_EQ(seeds.size(), 4u);
  EXPECT_EQ(seeds[0], Vec3(0.0));
  EXPECT_NEAR(norm(seeds[1] - Vec3(1, 0, -2)), 0, 1e-15);
  EXPECT_EQ(seeds[3], Vec3(3, 0, -6));
  EXPECT_EQ(seeds_on_line({0, 0, 0}, {3, 0, -6}, 1).front(), Vec3(1.5, 0, -3));
}

TEST(Seeds, APlaneIncludesItsFourCorners) {
  const auto seeds = seeds_on_plane({1, 1, 1}, {2, 0, 0}, {0, 0, 4}, 3, 2);
  ASSERT_EQ(seeds.size(), 6u);
  EXPECT_EQ(seeds[0], Vec3(1, 1, 1));
  EXPECT_EQ(seeds[1], Vec3(2, 1, 1));
  EXPECT_EQ(seeds[2], Vec3(3, 1, 1));
  EXPECT_EQ(seeds[5], Vec3(3, 1, 5));
}

TEST(Seeds, ASphereIsCoveredEvenly) {
  const Vec3 centre(1, -2, 3);
  const auto seeds = seeds_on_sphere(centre, 2, 400, false);
  Vec3 mean(0.0);
  double nearest = 10;
  for (std::size_t i = 0; i < seeds.size(); ++i) {
    EXPECT_NEAR(norm(seeds[i] - centre), 2, 1e-14);
    mean += (seeds[i] - centre) / 400.0;
    for (std::size_t j = 0; j < i; ++j) nearest = std::min(nearest, norm(seeds[i] - seeds[j]));
  }
  EXPECT_LT(norm(mean), 0.01);
  EXPECT_GT(nearest, 0.5 * 2 * std::sqrt(4 * std::numbers::pi / 400));
}

TEST(Seeds, ABallIsFilledEvenlyByVolume) {
  const auto seeds = seeds_on_sphere(Vec3(0.0), 2, 4000, true);
  int inner = 0, upper_inner = 0;
  for (const Vec3& p : seeds) {
    EXPECT_LE(norm(p), 2);
    if (norm(p) < 1) ++inner;
    if (norm(p) < 1 && p.z > 0) ++upper_inner;
  }
  EXPECT_NEAR(inner, 500, 25);
  EXPECT_NEAR(upper_inner, 250, 25);
}

TEST(Seeds, AnIsosurfaceIsCoveredEvenlyByArea) {
  const auto made = field::make_analytic("sphere");
  const auto grid = field::sample_on_grid(*made->scalar, 48, -2, 2);
  for (const field::ScalarField* field : {made->scalar.get(), static_cast<const field::ScalarField*>(grid.get())}) {
    const auto seeds = seeds_on_isosurface(*field, 1.2, 800);
    ASSERT_EQ(seeds.size(), 800u);
    int octant[8] = {};
    field::Cursor cursor;
    for (const Vec3& p : seeds) {
      EXPECT_NEAR(field->sample(p, cursor).value, 1.2, 1e-12);
      ++octant[(p.x > 0) + 2 * (p.y > 0) + 4 * (p.z > 0)];
    }
    for (const int n : octant) EXPECT_NEAR(n, 100, 20);
    EXPECT_EQ(seeds, seeds_on_isosurface(*field, 1.2, 800));
    EXPECT_TRUE(seeds_on_isosurface(*field, 100, 5).empty()) << "a level without a surface";
  }
}

double length_of(const Curve& line) { return line.knots().back().s - line.knots().front().s; }

double distance_between(const Curve& a, const Curve& b) {
  double minimum = 1e9;
  for (const Knot& p : a.knots())
    for (const Knot& q : b.knots()) minimum = std::min(minimum, norm(p.p - q.p));
  return minimum;
}

std::vector<CurvePtr> evenly_spaced(const field::VectorField& field, double distance, const Vec3& start) {
  EvenSpacingOptions spacing;
  spacing.distance = distance;
  spacing.start_points = {start};
  return trace_evenly_spaced(Flow{&field}, spacing);
}

TEST(EvenlySpaced, LinesOfAParallelFlowAreAtTheDistance) {
  const auto grid = sample_vector_grid({}, {24, 24, 24}, [](const Vec3&) { return Vec3(1, 0, 0); });
  const auto lines = evenly_spaced(*grid, 4, {11, 11, 11});
  // A square lattice of lines, four voxels apart: 3, 7, 11, 15, 19, and possibly -1 and 23 at the faces of the box.
  EXPECT_GE(lines.size(), 25u);
  EXPECT_LE(lines.size(), 36u);
  EXPECT_TRUE(evenly_spaced(*grid, 1, {100, 0, 0}).empty()) << "an invalid start point";
  for (std::size_t i = 0; i < lines.size(); ++i) {
    EXPECT_NEAR(length_of(*lines[i]), 23, 1e-6);
    for (std::size_t j = 0; j < i; ++j) EXPECT_GE(distance_between(*lines[i], *lines[j]), 3.99);
  }
}

TEST(EvenlySpaced, LinesKeepTheTestDistanceAndAreRepeatable) {
  const auto made = field::make_analytic("abc");
  const auto grid = field::sample_on_grid(*made->vector, 32, -2, 2);
  constexpr double kDistance = 0.6;
  const auto lines = evenly_spaced(*grid, kDistance, {0.1, 0.2, 0.3}), again = evenly_spaced(*grid, kDistance, {0.1, 0.2, 0.3});
  ASSERT_GT(lines.size(), 10u);
  ASSERT_EQ(lines.size(), again.size());
  for (std::size_t i = 0; i < lines.size(); ++i) {
    EXPECT_EQ(lines[i]->knots().back().p, again[i]->knots().back().p);
    EXPECT_GE(length_of(*lines[i]), kDistance);
    for (std::size_t j = 0; j < i; ++j) EXPECT_GE(distance_between(*lines[i], *lines[j]), 0.95 * 0.5 * kDistance) << i << " " << j;
  }
  // There is no room for another line: every position of the inner domain has a line within two distances.
  for (double x = -1.5; x <= 1.5; x += 0.5) {
    double minimum = 1e9;
    for (const auto& line : lines)
      for (const Knot& knot : line->knots()) minimum = std::min(minimum, norm(knot.p - Vec3(x, 0.3 * x, -x)));
    EXPECT_LT(minimum, 2 * kDistance) << x;
  }
}

TEST(EvenlySpaced, CirclesStayClosed) {
  const auto made = field::make_analytic("circle");
  const auto grid = field::sample_on_grid(*made->vector, 48, -2, 2);
  const auto lines = evenly_spaced(*grid, 0.5, {1, 0, 0});
  ASSERT_FALSE(lines.empty());
  EXPECT_TRUE(lines[0]->is_closed());
  EXPECT_EQ(lines[0]->last_end(), Termination::lap);
}

TEST(Subcurve, ASubcurveEqualsTheCurveBetweenItsEnds) {
  const auto grid = sample_vector_grid({}, {16, 16, 16}, [](const Vec3& p) { return Vec3(1, 0.05 * p.x, 0); });
  const auto curve = test::value_of(trace(Flow{grid.get()}, {5, 5, 5}));
  const CurvePtr part = extract_subcurve(*curve, -1.5, 2.25);
  EXPECT_EQ(part->knots().front().s, -1.5);
  EXPECT_EQ(part->knots().back().s, 2.25);
  EXPECT_EQ(part->first_end(), Termination::length);
  for (double s = -1.5; s <= 2.25; s += 0.25) EXPECT_NEAR(norm(part->position(s) - curve->position(s)), 0, 1e-9);
}

}  // namespace catena::flow::seeds_test
