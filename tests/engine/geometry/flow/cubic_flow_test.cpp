// SPDX-License-Identifier: MIT
// Streamlines through cubic cells: agreement with the samples, and the error compared with lines through linear cells.
#include <gtest/gtest.h>

#include <algorithm>

#include "engine/geometry/flow/curve.h"
#include "engine/geometry/flow/derivatives.h"
#include "tests/engine/field/field_helpers.h"
#include "tests/engine/geometry/flow/lambda_field.h"

namespace catena::flow {
namespace cubic_flow_test {

using test::lambda_field;
using test::sample_vector_grid;

constexpr double pi = 3.14159265358979323846;

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

field::VectorFieldPtr cubic_of(const std::shared_ptr<const field::VectorGrid>& grid) {
  auto made = grid->as_cubic();
  EXPECT_TRUE(made) << (made ? "" : made.error().message);
  return *made;
}

/// The median over 20 lines of the maximum distance from the true line, up to the length or the end of the domain.
double median_cross_track(const field::VectorField& sampled, const field::VectorField& truth, double half, double length) {
  field::test::Random random(77);
  std::vector<double> worst;
  while (worst.size() < 20) {
    const Vec3 seed = random.in_box(Vec3(-0.6 * half), Vec3(0.6 * half));
    TraceOptions options;
    options.length = length;
    auto line = trace({&sampled}, seed, options);
    options.length = 1.5 * length;
    auto exact = trace({&truth}, seed, options);
    EXPECT_TRUE(line && exact);
    const NearestOnCurve near(*exact);
    double greatest = 0;
    for (const Knot& knot : (*line)->knots()) greatest = std::max(greatest, std::sqrt(near.find(knot.p).distance2));
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
  for (const Case& c : {Case{"Lamb-Oseen", lamb_oseen, 2, 3}, Case{"ABC 1 2 3", abc, pi, 4}})
    for (const int nodes : {64, 128}) {
      const auto truth = lambda_field(c.velocity);
      const auto linear = sample_vector_grid(cube(c.half, nodes), {nodes, nodes, nodes}, c.velocity);
      const double of_linear = median_cross_track(*linear, *truth, c.half, c.length);
      const double of_cubic = median_cross_track(*cubic_of(linear), *truth, c.half, c.length);
      std::printf("%s, %d^3: linear %.3g, cubic %.3g, ratio %.1f\n", c.name, nodes, of_linear, of_cubic, of_linear / of_cubic);
      EXPECT_GT(of_linear, 20 * of_cubic) << c.name << " " << nodes;
    }
}

/// The line of small classical steps through the field's samples, without cells, equals the traced line.
TEST(CubicFlow, LinesThroughCellsEqualLinesThroughSamples) {
  const auto field = cubic_of(sample_vector_grid(cube(pi, 24), {24, 24, 24}, abc));
  field::Cursor cursor;
  const Flow flow{field.get()};
  for (const Vec3& seed : {Vec3(0.1, 0.2, 0.3), Vec3(-1.3, 0.7, 1.1)}) {
    TraceOptions options;
    options.length = 2;
    auto line = trace(flow, seed, options);
    ASSERT_TRUE(line);
    const double end = (*line)->knots().back().s;
    ASSERT_GT(end, 1);
    Vec3 p = seed;
    const int steps = 40000;
    const double h = end / steps;
    const auto u = [&](const Vec3& q) { return direction(field->sample(q, cursor).value); };
    for (int n = 0; n < steps; ++n) {
      const Vec3 a = u(p), b = u(p + 0.5 * h * a), c = u(p + 0.5 * h * b), d = u(p + h * c);
      p += (h / 6) * (a + 2.0 * b + 2.0 * c + d);
    }
    EXPECT_NEAR(norm(p - (*line)->knots().back().p), 0, 1e-9 * field->domain_length());
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
        Vec3 step(0.0);
        step[j] = 1e-5;
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
    const auto a = trace({linear.get()}, seed), b = trace({cubic.get()}, seed);
    ASSERT_TRUE(a && b);
    EXPECT_EQ((*a)->last_end(), (*b)->last_end());
    EXPECT_EQ((*a)->first_end(), (*b)->first_end());
    EXPECT_NEAR(norm((*a)->knots().back().p - (*b)->knots().back().p), 0, 1e-12);
  }
}

}  // namespace cubic_flow_test
}  // namespace catena::flow
