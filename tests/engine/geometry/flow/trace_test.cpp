// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "engine/geometry/flow/curve.h"
#include "engine/geometry/flow/derivatives.h"
#include "engine/geometry/flow/flow.h"
#include "tests/engine/field/field_helpers.h"
#include "tests/engine/geometry/flow/lambda_field.h"

namespace catena::flow::trace_test {

using test::analytic_vector;
using test::lambda_field;
using test::sample_vector_grid;

CurvePtr traced(const Flow& flow, const Vec3& seed, double length = 0) {
  TraceOptions options;
  options.length = length;
  return test::value_of(trace(flow, seed, options));
}

/// An independent reference: the classical method with tiny steps in arc length.
Vec3 brute_force(const Flow& flow, Vec3 p, double length, double step) {
  field::Cursor cursor;
  const int steps = static_cast<int>(std::ceil(std::fabs(length) / step));
  const double h = length / steps;
  for (int i = 0; i < steps; ++i) {
    const auto u = [&](const Vec3& q) { return direction(flow.field->sample(q, cursor).value); };
    const Vec3 a = u(p), b = u(p + 0.5 * h * a), c = u(p + 0.5 * h * b), d = u(p + h * c);
    p += h / 6 * (a + 2.0 * b + 2.0 * c + d);
  }
  return p;
}

const Knot& first(const CurvePtr& curve) { return curve->knots().front(); }
const Knot& last(const CurvePtr& curve) { return curve->knots().back(); }

/// Expects that s increases, tangents have unit length, and the seed is a knot at s = 0.
void expect_sound(const Curve& curve, const Vec3& seed) {
  bool has_seed = false;
  for (const Knot& knot : curve.knots()) {
    EXPECT_NEAR(norm(knot.t), 1, 1e-14);
    EXPECT_TRUE(is_finite(knot.p));
    if (knot.s == 0) {
      has_seed = true;
      EXPECT_EQ(knot.p, seed);
    }
  }
  EXPECT_TRUE(has_seed);
}

TEST(Trace, ACircleIsOneExactLap) {
  for (const double radius : {1e-5, 0.05, 0.3, 1.5, 5.0}) {
    const auto field = analytic_vector("circle");
    const Vec3 seed(radius * 0.6, -radius * 0.8, 0.25);
    const auto curve = traced({field.get()}, seed);
    expect_sound(*curve, seed);
    ASSERT_TRUE(curve->is_closed()) << radius;
    EXPECT_EQ(curve->last_end(), Termination::lap);
    EXPECT_NEAR(curve->period(), 2 * M_PI * radius, 1e-9 * 4);
    EXPECT_EQ(last(curve).p, seed);
    double worst = 0;
    for (int i = 0; i <= 5000; ++i) {
      const double s = curve->period() * i / 5000;
      const Vec3 p = curve->position(s);
      const double angle = s / radius;
      const Vec3 exact(seed.x * std::cos(angle) - seed.y * std::sin(angle), seed.x * std::sin(angle) + seed.y * std::cos(angle), seed.z);
      worst = std::max(worst, norm(p - exact));
    }
    EXPECT_LE(worst, 1e-9 * 4) << radius;
  }
}

TEST(Trace, AHelixIsExactInBothDirections) {
  const auto field = lambda_field([](const Vec3& p) { return Vec3(-2 * p.y, 2 * p.x, 0.5); });
  const Vec3 seed(0.7, 0.0, 0.1);
  const auto curve = traced({field.get()}, seed, 6);
  expect_sound(*curve, seed);
  EXPECT_FALSE(curve->is_closed());
  EXPECT_EQ(curve->first_end(), Termination::length);
  EXPECT_NEAR(first(curve).s, -6, 1e-12);
  EXPECT_NEAR(last(curve).s, 6, 1e-12);
  const double speed = std::sqrt(1.4 * 1.4 + 0.25);
  for (int i = 0; i <= 2000; ++i) {
    const double s = -6 + 12.0 * i / 2000, t = s / speed;
    EXPECT_LE(norm(curve->position(s) - Vec3(0.7 * std::cos(2 * t), 0.7 * std::sin(2 * t), 0.1 + 0.5 * t)), 4e-9);
  }
}

TEST(Trace, IsInvariantUnderTheFieldsScale) {
  for (const double scale : {1e-300, 1e300}) {
    const auto one = lambda_field([](const Vec3& p) { return Vec3(-p.y, p.x, 0.3); });
    const auto scaled = lambda_field([scale](const Vec3& p) { return scale * Vec3(-p.y, p.x, 0.3); });
    const auto a = traced({one.get()}, Vec3(0.5, 0.1, 0.0), 4), b = traced({scaled.get()}, Vec3(0.5, 0.1, 0.0), 4);
    for (const double s : {-3.9, -1.0, 0.3, 4.0}) EXPECT_LE(norm(a->position(s) - b->position(s)), 1e-9);
  }
}

TEST(Trace, ALineIntoANodeEndsCriticalAtTheNode) {
  const auto field = lambda_field([](const Vec3& p) { return Vec3(-p.x, -2 * p.y, -1.5 * p.z); });
  for (const Vec3& seed : {Vec3(1.0, 0.0, 0.0), Vec3(0.3, 0.9, -0.5), Vec3(0.0, 0.0, 1.0)}) {
    const auto curve = traced({field.get()}, seed, 8);
    expect_sound(*curve, seed);
    EXPECT_EQ(curve->last_end(), Termination::critical);
    EXPECT_LE(norm(last(curve).p), 1e-6 * 4);
    EXPECT_EQ(curve->first_end(), Termination::length);
  }
}

TEST(Trace, StableManifoldsOfASaddleEndCritical) {
  const auto straight = lambda_field([](const Vec3& p) { return Vec3(p.x, -p.y, 0.0); });
  const auto curve = traced({straight.get()}, Vec3(0.0, 1.0, 0.5), 3);
  EXPECT_EQ(curve->last_end(), Termination::critical);
  EXPECT_LE(norm(last(curve).p - Vec3(0.0, 0.0, 0.5)), 4e-6);
  // The stable manifold is x = y^2 / 3.
  const auto curved = lambda_field([](const Vec3& p) { return Vec3(p.x - p.y * p.y, -p.y, 0.0); });
  const auto bent = traced({curved.get()}, Vec3(1.0 / 3, 1.0, 0.0), 3);
  EXPECT_EQ(bent->last_end(), Termination::critical);
  EXPECT_LE(norm(last(bent).p), 4e-6);
  // Next to the manifold, the line turns away.
  const auto beside = traced({straight.get()}, Vec3(1e-2, 1.0, 0.5), 3);
  EXPECT_EQ(beside->last_end(), Termination::length);
  EXPECT_NEAR(last(beside).p.x * last(beside).p.y, 1e-2, 1e-8);
}

TEST(Trace, AFocusAndTheMinimumSpeedEndCritical) {
  const auto focus = lambda_field([](const Vec3& p) { return Vec3(-p.y - 0.3 * p.x, p.x - 0.3 * p.y, 0.0); });
  const auto spiral = traced({focus.get()}, Vec3(0.5, 0.0, 0.0), 20);
  EXPECT_EQ(spiral->last_end(), Termination::critical);
  EXPECT_LE(norm(last(spiral).p), 4e-5);
  const auto slowing = lambda_field([](const Vec3& p) { return Vec3(1 - 0.5 * p.x, 0.0, 0.0); });
  const auto curve = traced({slowing.get(), false, 0.25}, Vec3(0.0), 8);
  EXPECT_EQ(curve->last_end(), Termination::critical);
  EXPECT_NEAR(last(curve).p.x, 1.5, 1e-8);
}

TEST(Trace, BadSeedsAreOneErrorLine) {
  const auto circle = analytic_vector("circle");
  EXPECT_FALSE(trace({circle.get()}, Vec3(std::nan(""), 0.0, 0.0)));
  EXPECT_FALSE(trace({circle.get()}, Vec3(0.0)));
  EXPECT_FALSE(trace({circle.get(), false, 0.5}, Vec3(0.4, 0.0, 0.0)));
  const auto grid = sample_vector_grid(field::Mapping{}, {8, 8, 8}, [](const Vec3&) { return Vec3(1.0, 0.0, 0.0); });
  for (const char* part : {"outside", "9"}) EXPECT_TRUE(test::fails(trace({grid.get()}, Vec3(9.0, 1.0, 1.0)), part));
}

TEST(Trace, LinesEndExactlyOnTheFacesOfTheDomain) {
  const auto mapping = field::Mapping::from_linear(Mat3(0.5, 0, 0, 0, 0.25, 0, 0, 0, 2), Vec3(-1.0, 3.0, -7.0));
  const auto grid = sample_vector_grid(mapping, {9, 7, 5}, [](const Vec3&) { return Vec3(1.0, 0.25, -0.125); });
  const Vec3 seed(0.3, 3.9, -2.0);
  const auto curve = traced({grid.get()}, seed);
  expect_sound(*curve, seed);
  EXPECT_EQ(curve->first_end(), Termination::boundary);
  EXPECT_EQ(curve->last_end(), Termination::boundary);
  const Vec3 a = mapping.index_from_world(first(curve).p), b = mapping.index_from_world(last(curve).p);
  EXPECT_NEAR(a.x, 0, 1e-13);
  EXPECT_NEAR(b.y, 6, 1e-13);
  for (const Knot& knot : curve->knots()) EXPECT_LE(norm(cross(knot.p - seed, direction(Vec3(1.0, 0.25, -0.125)))), 1e-13);
}

TEST(Trace, EveryCrossingOfACellFaceIsAKnot) {
  const auto mapping = field::Mapping::from_linear(Mat3(4.0 / 23), Vec3(-2.0));
  const auto grid = sample_vector_grid(mapping, {24, 24, 24}, [](const Vec3& p) { return Vec3(-p.y, p.x, 0.2 + 0.1 * p.x); });
  const auto curve = traced({grid.get()}, Vec3(0.8, 0.1, 0.0), 6);
  for (std::size_t k = 1; k < curve->knots().size(); ++k) {
    const Vec3 a = mapping.index_from_world(curve->knots()[k - 1].p), b = mapping.index_from_world(curve->knots()[k].p);
    for (int axis = 0; axis < 3; ++axis) {
      const double lo = std::min(a[axis], b[axis]), hi = std::max(a[axis], b[axis]);
      EXPECT_LE(std::floor(hi - 1e-9) - std::floor(lo + 1e-9), 0) << k;
    }
  }
}

TEST(Trace, GridLinesAgreeWithTinySteps) {
  // An anisotropic, rotated grid with a negative origin.
  const double c = std::cos(0.4), s = std::sin(0.4);
  const Mat3 turn(c, s, 0, -s, c, 0, 0, 0, 1);
  const auto mapping = field::Mapping::from_linear(turn * Mat3(0.1, 0, 0, 0, 0.13, 0, 0, 0, 0.17), Vec3(-1.2, -2.1, -1.9));
  const auto abc = analytic_vector("abc");
  field::Cursor cursor;
  const auto grid = sample_vector_grid(mapping, {32, 28, 24}, [&](const Vec3& p) { return abc->sample(p, cursor).value; });
  std::mt19937 random(3);
  std::uniform_real_distribution<double> place(0.3, 0.7);
  double worst = 0;
  for (int i = 0; i < 4; ++i) {
    const Vec3 seed = mapping.world_from_index(Vec3(31 * place(random), 27 * place(random), 23 * place(random)));
    const auto curve = traced({grid.get()}, seed, 1.5);
    expect_sound(*curve, seed);
    for (const double at : {0.5 * last(curve).s, 0.9 * first(curve).s})
      worst = std::max(worst, norm(curve->position(at) - brute_force({grid.get()}, seed, at, 2e-5)));
  }
  EXPECT_LE(worst / grid->domain_length(), 1e-9);
}

TEST(Trace, TheErrorOnASampledHillIsThatOfTheGrid) {
  // The discretization error of the grid, within 20 %.
  const auto hill = analytic_vector("hill");
  const Vec3 seed(0.5, 0.0, 0.0);
  const auto exact = traced({hill.get()}, seed, 3.2);
  for (const auto& [nodes, floor] : {std::pair{32, 1.2e-3}, {64, 2.8e-4}, {128, 7.1e-5}}) {
    const auto grid = field::sample_on_grid(*hill, nodes, -1.2, 1.2);
    const auto curve = traced({grid.get()}, seed, 3.2);
    double worst = 0;
    for (const Knot& knot : curve->knots()) {
      // The cross-track error: the distance from the exact curve near the same arc length.
      double nearest = 1;
      for (int i = -200; i <= 200; ++i) nearest = std::min(nearest, norm(knot.p - exact->position(knot.s + i * 2e-4)));
      worst = std::max(worst, nearest);
    }
    EXPECT_NEAR(worst / 3.2, floor, 0.2 * floor) << nodes;
  }
}

TEST(Trace, MaskedCellsAreABoundary) {
  const field::Index3 size{10, 10, 10};
  std::vector<std::uint8_t> valid(1000, 1);
  for (int k = 0; k < 10; ++k)
    for (int j = 0; j < 10; ++j) valid[static_cast<std::size_t>(7 + 10 * j + 100 * k)] = 0;
  const auto grid = sample_vector_grid(
      field::Mapping{}, size, [](const Vec3&) { return Vec3(1.0, 0.1, 0.0); }, valid);
  const auto curve = traced({grid.get()}, Vec3(3.5, 4.0, 4.5));
  EXPECT_EQ(curve->last_end(), Termination::boundary);
  EXPECT_EQ(last(curve).p.x, 6.0);
  EXPECT_FALSE(trace({grid.get()}, Vec3(6.5, 4.0, 4.5)));
  EXPECT_TRUE(trace({grid.get()}, Vec3(6.0, 4.0, 4.5)));
}

TEST(Trace, ANanIsABoundary) {
  const auto grid = sample_vector_grid(field::Mapping{}, {8, 8, 8}, [](const Vec3& p) {
    return p.x == 5 && p.y == 4 ? Vec3(std::nan("")) : Vec3(1 + 0.01 * p.x, 0.0, 0.0);
  });
  const auto curve = traced({grid.get()}, Vec3(1.5, 3.5, 3.5));
  EXPECT_EQ(curve->last_end(), Termination::boundary);
  EXPECT_EQ(last(curve).p.x, 4.0);
}

TEST(Trace, LapsCloseOnFacesAndNodes) {
  const auto grid = field::sample_on_grid(*analytic_vector("circle"), 41, -2, 2);
  for (const Vec3& seed : {Vec3(0.0, -1.2, 0.0), Vec3(0.0, 0.9, 0.0), Vec3(0.5, 0.0, 1.0), Vec3(-0.9, 0.0, 0.4),
                           Vec3(0.0, 1.6384480463519915, 0.0), Vec3(0.3, 0.4, 0.1), Vec3(1.0, 0.0, -0.05)}) {
    const auto curve = traced({grid.get()}, seed);
    ASSERT_TRUE(curve->is_closed()) << seed.x << " " << seed.y;
    EXPECT_EQ(last(curve).p, seed);
    EXPECT_NEAR(curve->period(), 2 * M_PI * std::hypot(seed.x, seed.y), 1e-6);
  }
}

TEST(Trace, FollowsFlatFieldsAlongFacesAndEdges) {
  const auto grid = sample_vector_grid(field::Mapping{}, {12, 12, 4}, [](const Vec3& p) { return Vec3(-(p.y - 5.5), p.x - 5.5, 0.0); });
  for (const Vec3& seed : {Vec3(8.0, 5.5, 0.0), Vec3(8.0, 5.0, 1.0), Vec3(7.0, 7.0, 3.0), Vec3(5.5, 2.0, 2.5)}) {
    const auto curve = traced({grid.get()}, seed);
    EXPECT_TRUE(curve->is_closed());
    EXPECT_NEAR(curve->period(), 2 * M_PI * norm(seed - Vec3(5.5, 5.5, seed.z)), 1e-5);
    for (const Knot& knot : curve->knots()) EXPECT_EQ(knot.p.z, seed.z);
  }
  // A single layer, with a line along grid edges.
  const auto layer = sample_vector_grid(field::Mapping{}, {12, 12, 1}, [](const Vec3&) { return Vec3(0.0, -1.0, 0.0); });
  const auto line = traced({layer.get()}, Vec3(4.0, 5.0, 0.0));
  EXPECT_EQ(first(line).p.y, 11.0);
  EXPECT_EQ(last(line).p.y, 0.0);
}

TEST(Trace, ZeroInACellEndsTheLine) {
  const auto grid = sample_vector_grid(field::Mapping{}, {16, 16, 16}, [](const Vec3& p) { return Vec3(7.3, 7.6, 7.2) - p; });
  for (const Vec3& seed : {Vec3(2.0, 3.0, 4.0), Vec3(12.0, 7.0, 9.5)}) {
    const auto curve = traced({grid.get()}, seed);
    EXPECT_EQ(curve->last_end(), Termination::critical);
    EXPECT_LE(norm(last(curve).p - Vec3(7.3, 7.6, 7.2)), 1e-5 * 15);
    EXPECT_EQ(curve->first_end(), Termination::boundary);
  }
}

TEST(Trace, LineFieldsKeepTheirDirectionThroughSignFlips) {
  const auto helix = [](const Vec3& p) { return direction(Vec3(-2 * p.y, 2 * p.x, 0.5)); };
  const auto mapping = field::Mapping::from_linear(Mat3(4.0 / 31), Vec3(-2.0));
  const auto steady = sample_vector_grid(mapping, {32, 32, 32}, helix);
  int n = 0;
  std::mt19937 random(5);
  const auto flipping =
      sample_vector_grid(mapping, {32, 32, 32}, [&](const Vec3& p) { return (random() & 1 ? 1.0 : -1.0) * helix(p) + 0.0 * n++; });
  const Vec3 seed(1.0, 0.2, 0.1);
  const auto vector = traced({steady.get()}, seed, 3), line = traced({steady.get(), true}, seed, 3);
  const auto flipped = traced({flipping.get(), true}, seed, 3);
  const auto sense = [&](const Curve& other) { return dot(vector->position(0.01) - seed, other.position(0.01) - seed) > 0 ? 1 : -1; };
  for (const double s : {-2.0, -0.5, 1.0, 2.0}) {
    EXPECT_LE(norm(line->position(sense(*line) * s) - flipped->position(sense(*flipped) * s)), 1e-12) << s;
    // Dyads are interpolated differently from vectors: they agree within the error of the grid.
    EXPECT_LE(norm(line->position(sense(*line) * s) - vector->position(s)), 2e-5) << s;
  }
}

TEST(Trace, LinesInNoiseAlwaysEnd) {
  // Noise: adjacent cells have unrelated directions, and seeds are on nodes, edges and faces; as vectors and as a line field.
  std::mt19937 random(8);
  std::uniform_real_distribution<double> value(-1, 1);
  for (const bool line : {false, true}) {
    const auto mapping = field::Mapping::from_linear(Mat3(0.5, 0.1, 0, 0, 0.25, 0, 0.05, 0, 1), Vec3(-3.0, 5.0, 0.0));
    const auto grid =
        sample_vector_grid(mapping, {12, 12, 12}, [&](const Vec3&) { return Vec3(value(random), value(random), value(random)); });
    for (int i = 0; i < 60; ++i) {
      Vec3 index(5.5 + 5 * value(random), 5.5 + 5 * value(random), 5.5 + 5 * value(random));
      for (int axis = 0; axis < 3; ++axis)
        if (random() % 2) index[axis] = std::floor(index[axis]);
      const Vec3 seed = mapping.world_from_index(index);
      TraceOptions options;
      options.length = 20;
      const auto curve = trace({grid.get(), line, i % 4 == 0 ? 0.3 : 0.0}, seed, options);
      if (!curve) continue;
      expect_sound(**curve, seed);
      for (std::size_t k = 1; k < (*curve)->knots().size(); ++k) {
        const Knot &a = (*curve)->knots()[k - 1], &b = (*curve)->knots()[k];
        ASSERT_LE(norm(b.p - a.p), (b.s - a.s) * (1 + 1e-6) + 1e-12);
      }
    }
  }
}

TEST(Trace, HeartFibresAreSmooth) {
  const std::string path = test::shared_data("ideal_lv_fibres.vdb");
  if (path.empty()) GTEST_SKIP() << "ideal_lv_fibres.vdb is not beside the checkout";
  const auto field = field::test::read(path, "fibre").vector;
  const field::Box& box = field->index_box();
  std::mt19937 random(9);
  std::uniform_real_distribution<double> place(0, 1);
  int lines = 0;
  for (int i = 0; i < 4000 && lines < 20; ++i) {
    const Vec3 index(box.lo.x + place(random) * (box.hi.x - box.lo.x), box.lo.y + place(random) * (box.hi.y - box.lo.y),
                     box.lo.z + place(random) * (box.hi.z - box.lo.z));
    field::Cursor cursor;
    const Vec3 seed = field->mapping().world_from_index(index);
    if (!field->sample(seed, cursor).inside) continue;
    const auto curve = trace({field.get(), true, 0}, seed);
    if (!curve) continue;
    ++lines;
    const auto& knots = (*curve)->knots();
    for (std::size_t k = 1; k < knots.size(); ++k) {
      ASSERT_NEAR(norm(knots[k].t), 1, 1e-12);
      const double gap = knots[k].s - knots[k - 1].s;
      ASSERT_GT(dot(knots[k].t, knots[k - 1].t), 0.5) << "line " << lines << " knot " << k << " gap " << gap;
    }
  }
  EXPECT_EQ(lines, 20);
}

// Where the rounding of a position is coarser than the tolerance, steps must not shrink to 1e-13 L.
TEST(Trace, FarFromTheOriginTheToleranceIsTheRounding) {
  const auto made = test::value_of(field::make_analytic("helix"));
  for (const double far : {1e6, 1e9, 1e15, 1e30}) {
    const auto curve = test::value_of(trace({made.vector.get()}, {0.5, 0, far}, {}));
    EXPECT_LT(curve->knots().size(), 100000u) << far;
    for (const Knot& knot : curve->knots()) ASSERT_TRUE(is_finite(knot.p) && is_finite(knot.t)) << far;
  }
}

TEST(Trace, RealFlowsEndAndStayBounded) {
  const std::string path = test::shared_data("combustor_cfd.vdb");
  if (path.empty()) GTEST_SKIP() << "combustor_cfd.vdb is not beside the checkout";
  const auto loaded = field::test::read(path, "velocity").vector;
  const Flow flow{loaded.get()};
  const Vec3 seed(1.6, -0.57, 27.09);
  const auto curve = traced(flow, seed);
  expect_sound(*curve, seed);
  double worst = 0;
  for (const double fraction : {0.3, 0.9}) {
    const double s = std::min(fraction * last(curve).s, 8.0);
    worst = std::max(worst, norm(curve->position(s) - brute_force(flow, seed, s, 2e-5)));
  }
  EXPECT_LE(worst / loaded->domain_length(), 1e-9);
}

Vec3 lamb_oseen(const Vec3& p) {
  const double r2 = p.x * p.x + p.y * p.y, w = r2 > 0 ? -std::expm1(-r2) / r2 : 1;
  return {-p.y * w, p.x * w, 0.25};
}

/// The flow of Arnold, Beltrami and Childress with different wave numbers along the axes.
Vec3 abc(const Vec3& p) {
  return {1.7 * std::sin(3 * p.z) + std::cos(2 * p.y), 1.4 * std::sin(p.x) + 1.7 * std::cos(3 * p.z),
          std::sin(2 * p.y) + 1.4 * std::cos(p.x)};
}

field::Mapping cube(double half, int nodes) { return field::Mapping::from_linear(Mat3(2 * half / (nodes - 1)), Vec3(-half)); }

field::VectorFieldPtr cubic_of(const std::shared_ptr<const field::VectorGrid>& grid) { return field::test::value_of(grid->as_cubic()); }

/// The median over 20 lines of the maximum distance from the true line, up to the length or the end of the domain.
double median_cross_track(const field::VectorField& sampled, const field::VectorField& truth, double half, double length) {
  field::test::Random random(77);
  std::vector<double> worst;
  while (worst.size() < 20) {
    const Vec3 seed = random.in_box(Vec3(-0.6 * half), Vec3(0.6 * half));
    const NearestOnCurve near(traced({&truth}, seed, 1.5 * length));
    const CurvePtr line = traced({&sampled}, seed, length);
    double greatest = 0;
    for (const Knot& knot : line->knots()) greatest = std::max(greatest, std::sqrt(near.find(knot.p).distance2));
    worst.push_back(greatest);
  }
  std::nth_element(worst.begin(), worst.begin() + 10, worst.end());
  return worst[10];
}

TEST(CubicFlow, LinesHaveATwentiethOfTheLinearError) {
  struct Case {
    const char* name;
    Vec3 (*velocity)(const Vec3&);
    double half, length;
  };
  for (const Case& c : {Case{"Lamb-Oseen", lamb_oseen, 2, 3}, Case{"ABC 1 2 3", abc, M_PI, 4}})
    for (const int nodes : {64, 128}) {
      const auto truth = lambda_field(c.velocity);
      const auto linear = sample_vector_grid(cube(c.half, nodes), {nodes, nodes, nodes}, c.velocity);
      const double of_linear = median_cross_track(*linear, *truth, c.half, c.length);
      const double of_cubic = median_cross_track(*cubic_of(linear), *truth, c.half, c.length);
      EXPECT_GT(of_linear, 20 * of_cubic) << c.name << " " << nodes;
    }
}

/// The line of small classical steps through the field's samples, without cells, equals the traced line.
TEST(CubicFlow, LinesThroughCellsEqualLinesThroughSamples) {
  const auto field = cubic_of(sample_vector_grid(cube(M_PI, 24), {24, 24, 24}, abc));
  for (const Vec3& seed : {Vec3(0.1, 0.2, 0.3), Vec3(-1.3, 0.7, 1.1)}) {
    const CurvePtr line = traced({field.get()}, seed, 2);
    const double end = last(line).s;
    ASSERT_GT(end, 1);
    EXPECT_NEAR(norm(brute_force({field.get()}, seed, end, end / 40000) - last(line).p), 0, 1e-9 * field->domain_length());
  }
}

TEST(CubicFlow, TheVelocityGradientEqualsThatOfTheSamples) {
  for (const field::Mapping& mapping : field::test::mappings()) {
    const field::test::Block block = field::test::random_block({9, 8, 7}, 5);
    std::vector<float> xyz;
    for (std::size_t n = 0; n < block.values.size(); ++n)
      for (std::size_t c = 0; c < 3; ++c) xyz.push_back(block.values[(n * 3 + c * 5) % block.values.size()]);
    const auto field = cubic_of(field::make_vector_grid("v", mapping, block.size, xyz));
    field::Cursor cursor;
    field::test::Random random(4);
    for (int trial = 0; trial < 100; ++trial) {
      const Vec3 p = mapping.world_from_index(random.in_box(Vec3(0.1), Vec3(7.9, 6.9, 5.9)));
      int fetches = 0;
      const VelocityGradient found = compute_velocity_gradient(*field, p, cursor, fetches);
      ASSERT_TRUE(found.is_valid);
      EXPECT_EQ(fetches, 1);
      EXPECT_NEAR(norm(found.v * found.scale - field->sample(p, cursor).value), 0, 1e-11);
      for (int j = 0; j < 3; ++j) {
        const Vec3 step = field::test::along(j, 1e-5);
        const Vec3 slope = (field->sample(p + step, cursor).value - field->sample(p - step, cursor).value) * (1 / 2e-5);
        ASSERT_NEAR(norm(found.gradient[j] * found.scale - slope), 0, 2e-3);
      }
    }
  }
}

TEST(CubicFlow, LinesEndAsThoseOfLinearCells) {
  // Uniform flow with a hole in the way: the lines of linear and cubic cells are equal.
  const field::Index3 size{12, 9, 9};
  std::vector<std::uint8_t> valid(12 * 9 * 9, 1);
  valid[static_cast<std::size_t>((4 * 9 + 4) * 12 + 8)] = 0;
  const auto linear = sample_vector_grid(
      {}, size, [](const Vec3&) { return Vec3(1, 0, 0); }, valid);
  const auto cubic = cubic_of(linear);
  for (const Vec3& seed : {Vec3(3.5, 4.5, 4.5), Vec3(3.5, 1.5, 1.5), Vec3(0, 0, 0)}) {
    const auto a = traced({linear.get()}, seed), b = traced({cubic.get()}, seed);
    EXPECT_EQ(a->last_end(), b->last_end());
    EXPECT_EQ(a->first_end(), b->first_end());
    EXPECT_NEAR(norm(last(a).p - last(b).p), 0, 1e-12);
  }
}

}  // namespace catena::flow::trace_test
