// SPDX-License-Identifier: MIT
#include "haptics/chain/parameter.h"

#include <gtest/gtest.h>

#include <limits>

#include "engine/base/memory_limit.h"
#include "engine/field/analytic/analytic.h"
#include "engine/field/grid/grid.h"
#include "haptics/chain/tick.h"
#include "tests/support/simple_links.h"

namespace catena::haptics {
namespace parameter_test {

using By = HapticTransferFunction::Quantity;

field::AnyField formula(const char* name, double scale = 1) { return *field::make_analytic(name, {.scale = scale, .part = {}}); }

HapticTransferFunction map_of(field::AnyField field, By by, std::vector<HapticTransferFunction::Point> points, double outside = -7) {
  HapticTransferFunction map;
  map.field = std::move(field);
  map.quantity = by;
  map.points = std::move(points);
  map.outside = outside;
  return map;
}

struct Evaluation {
  double value;
  int evaluations;
};
Evaluation evaluate(const HapticTransferFunction& map, const Vec3& at, int spent = 0) {
  const Parameter parameter(std::make_shared<const HapticTransferFunction>(map));
  field::Cursor cursor;
  std::int32_t evaluations = spent;
  const double value = parameter.at(at, cursor, evaluations);
  return {value, evaluations};
}

TEST(Parameter, AConstantNeedsNoFieldEvaluation) {
  const Parameter parameter = 3.5;
  field::Cursor cursor;
  std::int32_t evaluations = 0;
  EXPECT_EQ(parameter.at({1, 2, 3}, cursor, evaluations), 3.5);
  EXPECT_EQ(evaluations, 0);
  EXPECT_TRUE(parameter.is_constant());
  EXPECT_EQ(parameter.min(), 3.5);
  EXPECT_EQ(parameter.max(), 3.5);
}

TEST(Parameter, IsPiecewiseLinearAndConstantBeyondItsEnds) {
  const HapticTransferFunction map = map_of(formula("plane"), By::value, {{-1, 4}, {0, 2}, {0.5, 2}, {1.5, 10}});
  EXPECT_EQ(evaluate(map, {0, 0, -9}).value, 4);
  EXPECT_EQ(evaluate(map, {0, 0, -1}).value, 4);
  EXPECT_DOUBLE_EQ(evaluate(map, {0, 0, -0.25}).value, 2.5);
  EXPECT_EQ(evaluate(map, {5, 5, 0}).value, 2);
  EXPECT_EQ(evaluate(map, {0, 0, 0.3}).value, 2);
  EXPECT_DOUBLE_EQ(evaluate(map, {0, 0, 1.25}).value, 8);
  EXPECT_EQ(evaluate(map, {0, 0, 1.5}).value, 10);
  EXPECT_EQ(evaluate(map, {0, 0, 1e300}).value, 10);
  EXPECT_EQ(evaluate(map, {0, 0, 0.3}).evaluations, 1);
  const Parameter parameter(std::make_shared<const HapticTransferFunction>(map));
  EXPECT_FALSE(parameter.is_constant());
  EXPECT_EQ(parameter.min(), -7);  // includes the outside value
  EXPECT_EQ(parameter.max(), 10);
  EXPECT_EQ(evaluate(map_of(formula("plane"), By::value, {{0, 6}}), {0, 0, 3}).value, 6);
}

TEST(Parameter, ByGradientAndByMagnitude) {
  // |grad (x + y + z)| = sqrt 3, |(-y, x, 0)| = r
  const std::vector<HapticTransferFunction::Point> same{{0, 0}, {100, 100}};
  EXPECT_NEAR(evaluate(map_of(formula("linear"), By::gradient, same), {0.3, 0.1, 7}).value, std::sqrt(3.0), 1e-14);
  EXPECT_NEAR(evaluate(map_of(formula("circle"), By::magnitude, same), {3, 4, 9}).value, 5, 1e-14);
}

TEST(Parameter, NormalizesAtAnyScale) {
  for (const double scale : {1e-300, 1e-150, 1.0, 1e150, 1e300}) {
    HapticTransferFunction map = map_of(formula("plane", scale), By::value, {{0, 0}, {1, 1}});
    map.normalize = true;
    map.range_min = -2 * scale;
    map.range_max = 2 * scale;
    EXPECT_NEAR(evaluate(map, {0, 0, 1}).value, 0.75, 1e-15) << scale;
    EXPECT_EQ(evaluate(map, {0, 0, -3}).value, 0) << scale;
    EXPECT_EQ(evaluate(map, {0, 0, 3}).value, 1) << scale;
    HapticTransferFunction speed = map_of(formula("circle", scale), By::magnitude, {{0, 0}, {1, 1}});
    speed.normalize = true;
    speed.range_max = 4 * scale;
    EXPECT_NEAR(evaluate(speed, {0, 1, 0}).value, 0.25, 1e-15) << scale;
  }
  // a range that overflows a double, and a range of one unit in the last place
  HapticTransferFunction wide = map_of(formula("plane"), By::value, {{0, 0}, {1, 1}});
  wide.normalize = true;
  wide.range_min = -1.7e308;
  wide.range_max = 1.7e308;
  EXPECT_NEAR(evaluate(wide, {0, 0, 0.85e308}).value, 0.75, 1e-15);
  wide.range_min = 1;
  wide.range_max = std::nextafter(1.0, 2.0);
  EXPECT_EQ(evaluate(wide, {0, 0, 1}).value, 0);
  EXPECT_EQ(evaluate(wide, {0, 0, wide.range_max}).value, 1);
  // empty range
  wide.range_max = wide.range_min;
  EXPECT_EQ(evaluate(wide, {0, 0, 5}).value, 0);
}

TEST(Parameter, AMapOverAllDoublesStaysFinite) {
  const HapticTransferFunction map = map_of(formula("plane"), By::value, {{-1.7e308, -1.7e308}, {1.7e308, 1.7e308}, {1.75e308, 0}});
  for (const double z : {-1.79e308, -1e308, -1.0, 0.0, 5e-324, 1e308, 1.72e308, 1.79e308}) {
    EXPECT_TRUE(std::isfinite(evaluate(map, {0, 0, z}).value)) << z;
    if (std::fabs(z) < 1.6e308) {
      EXPECT_NEAR(evaluate(map, {0, 0, z}).value / 1e300, z / 1e300, 1e-6) << z;
    }
  }
}

TEST(Parameter, OutsideTheDomainAndAtNonFiniteValuesItIsTheOutsideValue) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  std::vector<float> values(5 * 5 * 5, 2.0F);
  values[2 + 5 * (2 + 5 * 2)] = nan;
  std::vector<std::uint8_t> valid(125, 1);
  valid[0] = 0;
  const field::Mapping mapping;
  const field::AnyField grid{field::make_scalar_grid("g", mapping, {5, 5, 5}, values, valid), nullptr};
  for (const By by : {By::value, By::gradient}) {
    const HapticTransferFunction map = map_of(grid, by, {{0, 5}});
    EXPECT_EQ(evaluate(map, {0.5, 3.5, 0.5}).value, 5);
    EXPECT_EQ(evaluate(map, {-0.1, 1, 1}).value, -7);     // outside
    EXPECT_EQ(evaluate(map, {1e300, 1, 1}).value, -7);    // far outside
    EXPECT_EQ(evaluate(map, {0.5, 0.5, 0.5}).value, -7);  // masked
    EXPECT_EQ(evaluate(map, {1.5, 1.5, 1.5}).value, -7);  // a NaN corner
    EXPECT_EQ(evaluate(map, {1.5, 1.5, 1.5}).evaluations, 1);
  }
}

TEST(Parameter, ASpentBudgetGivesTheOutsideValue) {
  const HapticTransferFunction map = map_of(formula("plane"), By::value, {{0, 5}});
  EXPECT_EQ(evaluate(map, {0, 0, 0}, kMaxEvaluations - 1).value, 5);
  EXPECT_EQ(evaluate(map, {0, 0, 0}, kMaxEvaluations - 1).evaluations, kMaxEvaluations);
  EXPECT_EQ(evaluate(map, {0, 0, 0}, kMaxEvaluations).value, -7);
  EXPECT_EQ(evaluate(map, {0, 0, 0}, kMaxEvaluations).evaluations, kMaxEvaluations);
}

TEST(Parameter, DrivesTheStiffnessInTheTick) {
  // k = 100 + 200 z at the proxy of the last tick; in the first tick at the probe
  HapticProgram program;
  program.links = {test::hold_height("a", 0.5)};
  program.links[0].stiffness_n_per_m =
      Parameter(std::make_shared<const HapticTransferFunction>(map_of(formula("plane"), By::value, {{0, 100}, {1, 300}})));
  program.coupling.max_force_n = 1e9;
  program.coupling.ramp_s = 0.01;
  program.meters_per_unit = 0.1;
  program.links[0].active_when.button = 1;
  ChainState state;
  ChainScratch scratch;
  HapticState out;
  const AllocationCounter guard;
  tick(program, {0, {0, 0, 0.25}, 0}, state, scratch, out);
  EXPECT_EQ(norm(out.force_n), 0);
  for (int i = 1; i <= 12; ++i) {
    tick(program, {1e-3 * i, {0, 0, 0.25}, 1}, state, scratch, out);
    const double k = i == 1 ? 150 : 200, w = std::min(1.0, 0.1 * i);
    EXPECT_NEAR(out.force_n.z, w * k * 0.1 * 0.25, 1e-12) << i;
    EXPECT_EQ(out.links[0].stiffness_n_per_m, k);
    EXPECT_EQ(out.links[0].evaluations, 2);  // one for the stiffness, one for the link
  }
  EXPECT_EQ(guard.count(), 0u);
}

}  // namespace parameter_test
}  // namespace catena::haptics
