// SPDX-License-Identifier: MIT
#include "engine/geometry/flow/batch_tracer.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <limits>
#include <numbers>

#include "engine/geometry/flow/batch_rk4_step.h"
#include "engine/geometry/flow/curve.h"
#include "tests/engine/geometry/flow/lambda_field.h"
#include "tests/support/results.h"

namespace catena::flow::batch_tracer_test {

using test::analytic_vector;
using test::lambda_field;
using test::sample_vector_grid;
using GridPtr = std::shared_ptr<const field::VectorGrid>;

GridPtr sampled(const std::string& name, int nodes = 48) { return field::sample_on_grid(*analytic_vector(name), nodes, -2, 2); }

/// Positions of a fixed sequence within a box about the center.
std::vector<Vec3> places(std::size_t count, double half, const Vec3& middle = Vec3(0.0)) {
  std::vector<Vec3> seeds;
  std::uint64_t state = 7;
  const auto next = [&] {
    state = state * 6364136223846793005ull + 1442695040888963407ull;
    return half * (2 * (static_cast<double>(state >> 11) * 0x1p-53) - 1);
  };
  for (std::size_t i = 0; i < count; ++i) {
    const double x = next(), y = next();
    seeds.push_back(middle + Vec3(x, y, next()));
  }
  return seeds;
}

/// The maximum distance of a line's knots from the exact line.
double cross_track(const Curve& line, const CurvePtr& exact) {
  const NearestOnCurve nearest(exact);
  double worst = 0;
  for (const Knot& knot : line.knots()) worst = std::max(worst, std::sqrt(nearest.find(knot.p).distance2));
  return worst;
}

void expect_sound(const Curve& curve, const Vec3& seed) {
  bool has_seed = false;
  for (const Knot& knot : curve.knots()) {
    ASSERT_NEAR(norm(knot.t), 1, 1e-13);
    if (knot.s == 0) has_seed = knot.p == seed;
  }
  EXPECT_TRUE(has_seed);
}

/// A thousandth of a voxel: the error from kinks at the faces of coarsely sampled cells, which is invisible in an image.
constexpr double kTrack = 1.5e-3;

/// Expects that every line agrees with that of trace(): its ends, length and positions.
void expect_agreement(const Flow& flow, const std::vector<Vec3>& seeds, double length, double length_tolerance) {
  BatchOptions options;
  options.length = length;
  TraceOptions exactly;
  exactly.length = length;
  const auto lines = BatchTracer(flow, options).trace(seeds);
  ASSERT_EQ(lines.size(), seeds.size());
  for (std::size_t i = 0; i < seeds.size(); ++i) {
    SCOPED_TRACE(i);
    const auto exact = trace(flow, seeds[i], exactly);
    ASSERT_EQ(static_cast<bool>(lines[i]), static_cast<bool>(exact));
    if (!exact) continue;
    const Curve& line = **lines[i];
    expect_sound(line, seeds[i]);
    EXPECT_EQ(line.first_end(), (*exact)->first_end());
    EXPECT_EQ(line.last_end(), (*exact)->last_end());
    EXPECT_EQ(line.is_closed(), (*exact)->is_closed());
    EXPECT_LE(cross_track(line, *exact), kTrack * flow.field->max_voxel_edge());
    EXPECT_NEAR(line.knots().front().s, (*exact)->knots().front().s, length_tolerance);
    EXPECT_NEAR(line.knots().back().s, (*exact)->knots().back().s, length_tolerance);
  }
}

TEST(Batch, CirclesCloseAfterOneLap) {
  const auto grid = sampled("circle");
  const Flow flow{grid.get()};
  const auto lines = BatchTracer(flow).trace(std::vector<Vec3>{{0.5, 0, 0.1}, {0, 1.5, -1}});
  for (const auto& line : lines) {
    ASSERT_TRUE(line);
    EXPECT_TRUE((*line)->is_closed());
    EXPECT_EQ((*line)->last_end(), Termination::lap);
    const double radius = std::hypot((*line)->knots().front().p.x, (*line)->knots().front().p.y);
    EXPECT_NEAR((*line)->period(), 2 * std::numbers::pi * radius, 4e-5 * radius);
    for (const Knot& knot : (*line)->knots()) EXPECT_NEAR(std::hypot(knot.p.x, knot.p.y), radius, 4e-6);
    EXPECT_EQ((*line)->knots().front().p, (*line)->knots().back().p);
  }
}

TEST(Batch, AgreesWithTheExactTracer) {
  struct Case {
    const char* name;
    int nodes;
    std::vector<Vec3> seeds;
    double length, length_tolerance;
  };
  for (const Case& c : {
           Case{"abc", 48, places(24, 1.6), 3, 1e-4},
           Case{"hill", 64, {{0.5, 0, 0}, {0.1, 0.2, 1.5}, {1.5, 0, 0.3}, {-0.3, 0.4, -0.2}}, 3, 2e-4},
           // Lines end critical at the node and the saddle.
           Case{"node", 48, places(6, 1.5), 0, 1e-4},
           Case{"saddle", 48, {{0.5, 0, 0}, {0, 1.0, 0}, {0.3, 0.4, 0.2}, {0.01, 1.2, 0}}, 0, 1e-3},
       }) {
    SCOPED_TRACE(c.name);
    const auto grid = sampled(c.name, c.nodes);
    expect_agreement(Flow{grid.get()}, c.seeds, c.length, c.length_tolerance);
  }
}

TEST(Batch, AgreesOnRotatedAndAnisotropicVoxels) {
  Mat3 linear(Vec3(0.05, 0.02, 0), Vec3(-0.03, 0.08, 0.01), Vec3(0, 0.01, 0.06));
  const auto mapping = field::Mapping::from_linear(linear, {-1, -2, -1});
  const auto grid =
      sample_vector_grid(mapping, {40, 30, 35}, [](const Vec3& p) { return Vec3(1 + 0.3 * p.y, 0.5 - p.x, 0.2 + p.z * p.x); });
  expect_agreement(Flow{grid.get()}, places(8, 0.2, mapping.world_from_index({20, 15, 17})), 0, 1e-4);
}

TEST(Batch, LinesStartAndEndOnTheFacesOfTheDomain) {
  const auto grid = sample_vector_grid({}, {20, 20, 20}, [](const Vec3&) { return Vec3(1, 0.25, 0); });
  const CurvePtr line = test::value_of(BatchTracer(Flow{grid.get()}).trace(std::vector<Vec3>{{9, 10, 11}})[0]);
  EXPECT_EQ(line->first_end(), Termination::boundary);
  EXPECT_EQ(line->last_end(), Termination::boundary);
  EXPECT_NEAR(line->knots().back().p.x, 19, 1e-9);
  EXPECT_NEAR(line->knots().front().p.x, 0, 1e-9);
  EXPECT_NEAR(line->knots().back().p.y, 12.5, 1e-5);
  // A seed on a face starts inward.
  const auto straight = sample_vector_grid({}, {20, 20, 20}, [](const Vec3&) { return Vec3(1, 0, 0); });
  const auto lines = BatchTracer(Flow{straight.get()}).trace(std::vector<Vec3>{{0, 10, 19}, {19, 19, 19}});
  EXPECT_NEAR(test::value_of(lines[0])->knots().back().p.x, 19, 1e-9);
  EXPECT_NEAR(test::value_of(lines[1])->knots().front().p.x, 0, 1e-9);
  // A grid of one layer.
  const auto layer = sample_vector_grid({}, {16, 16, 1}, [](const Vec3&) { return Vec3(1, 0.5, 0); });
  const auto flat = BatchTracer(Flow{layer.get()}).trace(std::vector<Vec3>{{4, 4, 0}});
  EXPECT_NEAR(test::value_of(flat[0])->knots().back().p.x, 15, 1e-9);
}

TEST(Batch, InvalidCellsAndNonFiniteValuesEndLines) {
  std::vector<std::uint8_t> valid(24 * 24 * 24, 1);
  for (int z = 0; z < 24; ++z)
    for (int y = 0; y < 24; ++y)
      for (int x = 15; x < 17; ++x) valid[(z * 24 + y) * 24 + x] = 0;
  const auto right = [](const Vec3& p) { return Vec3(1, 0.1 * std::sin(p.x), 0.2); };
  const auto masked = sample_vector_grid({}, {24, 24, 24}, right, valid);
  expect_agreement(Flow{masked.get()}, {{3, 10, 5}, {20, 10, 12}, {13.5, 8, 8}, {15.5, 10, 10}}, 0, 1e-4);
  const auto holed = sample_vector_grid({}, {24, 24, 24}, [&](const Vec3& p) {
    return p.x == 9 && p.y == 12 && p.z == 8 ? Vec3(std::numeric_limits<double>::quiet_NaN()) : right(p);
  });
  expect_agreement(Flow{holed.get()}, {{3, 11.9, 6.6}, {3, 5, 5}, {8.5, 12.5, 7.5}}, 0, 1e-4);
}

TEST(Batch, LinesEndAtMinSpeed) {
  const auto grid = sample_vector_grid({}, {32, 16, 16}, [](const Vec3& p) { return Vec3(0.05 * (32 - p.x), 0, 0.01); });
  Flow flow{grid.get()};
  flow.min_speed = 0.5;
  expect_agreement(flow, {{5, 8, 8}, {15, 7.5, 8}, {30, 8, 8}}, 0, 1e-3);
}

TEST(Batch, RefusesTheSeedsThatTraceRefuses) {
  const auto grid = sampled("circle", 16);
  const Flow flow{grid.get()};
  const std::vector<Vec3> seeds{{5, 0, 0}, {std::numeric_limits<double>::quiet_NaN(), 0, 0}, {1, 0, 0}};
  const auto lines = BatchTracer(flow).trace(seeds);
  for (std::size_t i = 0; i < 2; ++i) EXPECT_EQ(lines[i].error().message, trace(flow, seeds[i]).error().message);
  EXPECT_TRUE(lines[2]);
  EXPECT_TRUE(BatchTracer(flow).trace({}).empty());
}

TEST(Batch, LengthsAndStepsMeetTheirLimits) {
  const auto grid = sampled("abc");
  for (const auto& [length, max_step] : {std::pair{0.777, BatchOptions{}.max_step}, {0.3, 0.03}}) {
    BatchOptions options;
    options.length = length;
    options.max_step = max_step;
    for (const auto& result : BatchTracer(Flow{grid.get()}, options).trace(places(5, 0.5))) {
      const auto knots = test::value_of(result)->knots();
      EXPECT_EQ(knots.back().s, length);
      EXPECT_EQ(knots.front().s, -length);
      EXPECT_NEAR(norm(knots.back().t), 1, 1e-13);
      for (std::size_t k = 1; k < knots.size() && max_step == 0.03; ++k)
        ASSERT_LE(knots[k].s - knots[k - 1].s, 0.0301 * grid->max_voxel_edge()) << knots[k].s;
    }
  }
}

TEST(Batch, IsInvariantUnderTheFieldsScale) {
  const auto made = [](double scale) {
    return sample_vector_grid({}, {24, 24, 24}, [scale](const Vec3& p) { return scale * Vec3(1 + 0.1 * p.y, 2 - 0.1 * p.x, 0.5); });
  };
  const std::vector<Vec3> seeds{{8, 8, 8}, {14, 3, 10}};
  const auto one = made(1);
  const auto reference = BatchTracer(Flow{one.get()}).trace(seeds);
  for (const double scale : {0x1p-100, 0x1p100}) {
    const auto grid = made(scale);
    const auto lines = BatchTracer(Flow{grid.get()}).trace(seeds);
    for (std::size_t i = 0; i < seeds.size(); ++i) {
      ASSERT_TRUE(lines[i]);
      EXPECT_EQ((*lines[i])->knots().size(), (*reference[i])->knots().size());
      EXPECT_NEAR(norm((*lines[i])->knots().back().p - (*reference[i])->knots().back().p), 0, 1e-9);
    }
  }
}

bool same_bits(const Curve& a, const Curve& b) {
  return std::equal(a.knots().begin(), a.knots().end(), b.knots().begin(), b.knots().end(), [](const Knot& k, const Knot& l) {
    return k.s == l.s && k.p == l.p && k.t == l.t && k.position_low == l.position_low;
  });
}

TEST(Batch, ALineDoesNotDependOnOtherLinesOfTheBatch) {
  const auto grid = sampled("abc");
  BatchOptions options;
  options.length = 2;
  const auto seeds = places(20, 1.5);
  const BatchTracer tracer(Flow{grid.get()}, options);
  const auto together = tracer.trace(seeds);
  for (std::size_t i = 0; i < seeds.size(); ++i) {
    const auto alone = BatchTracer(Flow{grid.get()}, options).trace(std::span(&seeds[i], 1));
    EXPECT_TRUE(same_bits(**together[i], **alone[0])) << i;
  }
}

TEST(Batch, WideLanesAreBitIdenticalToTheBaseline) {
  if (!has_avx2_lanes()) GTEST_SKIP() << "this machine has only the baseline";
  const auto grid = sampled("abc");
  const VelocityBricks bricks(*grid);
  StepControl control;
  control.tolerance2 = 1e-8f;
  LaneGroup wide{};
  const auto seeds = places(kLanes, 15, Vec3(24.0));
  for (int i = 0; i < kLanes; ++i) {
    wide.q[i] = Double4{seeds[i].x, seeds[i].y, seeds[i].z, 0};
    ASSERT_TRUE(rate_at(bricks, wide.q[i], wide.k[i]));
    wide.h[i] = i % 2 ? 0.3f : -0.7f;
  }
  wide.q[3] = Double4{0.5, 20, 20, 0};
  for (int steps = 0; steps < 20; ++steps) {
    LaneGroup base = wide;
    step_lanes(bricks, control, wide);
    step_lanes_baseline(bricks, control, base);
    for (int i = 0; i < kLanes; ++i) {
      EXPECT_EQ(wide.left_box[i], base.left_box[i]);
      if (wide.left_box[i]) continue;
      EXPECT_EQ(0, std::memcmp(&wide.end[i], &base.end[i], 3 * sizeof(double)));
      EXPECT_EQ(0, std::memcmp(&wide.k_end[i], &base.k_end[i], 3 * sizeof(float)));
      EXPECT_EQ(wide.error2[i], base.error2[i]);
      EXPECT_EQ(wide.next_h[i], base.next_h[i]);
      wide.q[i] = wide.end[i];
      wide.k[i] = wide.k_end[i];
    }
  }
}

TEST(Batch, FormulasAndLineFieldsEqualTrace) {
  const auto formula = analytic_vector("helix");
  const auto grid = sampled("circle", 16);
  for (const Flow& flow : {Flow{formula.get()}, Flow{grid.get(), true}}) {
    const std::vector<Vec3> seeds{{0.5, 0, 0}, {1, 0.2, 0.3}, {0.1, 0.4, -0.2}};
    TraceOptions options;
    options.length = 2;
    BatchOptions batch;
    batch.length = 2;
    const auto each = trace_all(flow, seeds, options);
    TraceOptions loose = options;
    loose.tolerance = loose.hermite_tolerance = batch.tolerance;
    const auto lines = BatchTracer(flow, batch).trace(seeds);
    for (std::size_t i = 0; i < seeds.size(); ++i) {
      const auto exact = test::value_of(trace(flow, seeds[i], options));
      EXPECT_TRUE(same_bits(**trace(flow, seeds[i], loose), **lines[i]));
      EXPECT_LE(cross_track(**lines[i], exact), 1e-5);
      EXPECT_TRUE(same_bits(*exact, **each[i]));
    }
  }
}

}  // namespace catena::flow::batch_tracer_test
