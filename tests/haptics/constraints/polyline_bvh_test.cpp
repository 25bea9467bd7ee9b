// SPDX-License-Identifier: MIT
#include "haptics/constraints/shapes/polyline_bvh.h"

#include "tests/haptics/constraints/constraint_fixture.h"

namespace catena::haptics::tests::polyline_bvh_test {

std::vector<LineSegment> pieces_of(const std::vector<Vec3>& points) {
  std::vector<LineSegment> pieces;
  for (std::size_t i = 0; i + 1 < points.size(); ++i) pieces.emplace_back(points[i], points[i + 1]);
  return pieces;
}

std::vector<Vec3> walk(Random& random, int count, double step) {
  std::vector<Vec3> points{random.box(1)};
  for (int i = 1; i < count; ++i) points.push_back(points.back() * 0.999 + random.box(step));
  return points;
}

double distance(const LineSegment& piece, const Vec3& x) { return norm(x - piece.at(piece.along(x))); }

/// The closest piece, by an unlimited search.
const LineSegment& nearest(const PolylineBvh& tree, const std::vector<LineSegment>& pieces, const Vec3& x, SearchState state = {}) {
  tree.search(pieces, x, 1 << 20, state);
  EXPECT_FALSE(state.in_progress);
  return pieces[state.best_item];
}

double brute(const std::vector<LineSegment>& pieces, const Vec3& x) {
  double minimum = 1e308;
  for (const LineSegment& piece : pieces) minimum = std::min(minimum, distance(piece, x));
  return minimum;
}

TEST(PolylineSearch, FindsTheClosestPoint) {
  Random random(4);
  for (const int count : {2, 3, 9, 10, 17, 100, 1000, 5000}) {
    const auto pieces = pieces_of(walk(random, count, 0.1));
    const PolylineBvh tree(pieces);
    for (int i = 0; i < 200; ++i) {
      const Vec3 x = random.box(i % 2 ? 2 : 60);
      ASSERT_LE(distance(nearest(tree, pieces, x), x), brute(pieces, x) * (1 + 1e-14));
    }
  }
}

TEST(PolylineSearch, AFarProbeFindsTheExtremePointInItsDirection) {
  Random random(5);
  const auto points = walk(random, 3000, 0.1);
  const auto pieces = pieces_of(points);
  const PolylineBvh tree(pieces);
  for (const double far : {1e9, 1e20, 1e160, 1e300}) {
    for (int i = 0; i < 50; ++i) {
      const Vec3 way = random.unit();
      double maximum = -1e300;
      for (const Vec3& p : points) maximum = std::max(maximum, dot(p, way));
      const LineSegment& best = nearest(tree, pieces, way * far);
      EXPECT_LE(maximum - dot(best.at(best.along(way * far)), way), 10 / far + 1e-15) << far;
    }
  }
}

TEST(PolylineSearch, ALongCurveNeedsFewVisits) {
  std::vector<Vec3> points;
  for (int i = 0; i <= 100000; ++i) points.emplace_back(std::cos(i * 0.01), std::sin(i * 0.01), i * 2e-5);
  const auto pieces = pieces_of(points);
  const PolylineBvh tree(pieces);
  Random random(6);
  Quantiles visits;
  for (int i = 0; i < 2000; ++i) {
    SearchState state{};
    const int k = static_cast<int>(random.uniform(0, 100000));
    tree.search(pieces, points[static_cast<std::size_t>(k)] + random.box(0.05), 1 << 20, state);
    visits.add(state.visits);
  }
  EXPECT_LE(visits.at_quantile(0.5), 256);
  EXPECT_LE(visits.at_quantile(0.99), 2048);
}

TEST(PolylineSearch, ContinuesOverTicksWithinItsVisits) {
  // from its centre all points of the circle are equally near, except one dent
  std::vector<Vec3> points;
  for (int i = 0; i <= 50000; ++i) {
    const double r = i == 31234 ? 0.9 : 1 + 1e-9 * (i % 7);
    points.emplace_back(r * std::cos(i * 1.2e-4), r * std::sin(i * 1.2e-4), 0);
  }
  const auto pieces = pieces_of(points);
  const PolylineBvh tree(pieces);
  SearchState state{};
  int ticks = 0;
  double last = 2;
  do {
    tree.search(pieces, Vec3(0.0), 256, state);
    ASSERT_LE(state.visits, 256);
    ASSERT_LE(distance(pieces[state.best_item], Vec3(0.0)), last);
    last = distance(pieces[state.best_item], Vec3(0.0));
    ++ticks;
  } while (state.in_progress && ticks < 1000);
  EXPECT_FALSE(state.in_progress);
  EXPECT_GT(ticks, 1);
  EXPECT_NEAR(last, 0.9, 1e-12);
}

TEST(PolylineSearch, TinyAndHugeCurves) {
  Random random(7);
  for (const double scale : {1e-290, 1e-200, 1e200, 1e290}) {
    auto points = walk(random, 300, 0.1);
    for (Vec3& p : points) p *= scale;
    const auto pieces = pieces_of(points);
    const PolylineBvh tree(pieces);
    for (int i = 0; i < 50; ++i) {
      const Vec3 x = random.box(1.5) * scale;
      EXPECT_LE(distance(nearest(tree, pieces, x), x), brute(pieces, x) * (1 + 1e-14)) << scale;
    }
  }
}

}  // namespace catena::haptics::tests::polyline_bvh_test
