// SPDX-License-Identifier: MIT
#include "haptics/chain/parameter.h"

#include <limits>

#include "engine/base/memory_limit.h"
#include "engine/field/analytic/analytic.h"
#include "engine/field/grid/grid.h"
#include "tests/haptics/chain/chain_driver.h"
#include "tests/support/simple_links.h"

namespace catena::haptics::parameter_test {

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
  const std::pair<Vec3, double> values[] = {{{0, 0, -9}, 4},  {{0, 0, -1}, 4},   {{5, 5, 0}, 2},
                                            {{0, 0, 0.3}, 2}, {{0, 0, 1.5}, 10}, {{0, 0, 1e300}, 10}};
  for (const auto& [at, value] : values) EXPECT_EQ(evaluate(map, at).value, value) << at.z;
  EXPECT_DOUBLE_EQ(evaluate(map, {0, 0, -0.25}).value, 2.5);
  EXPECT_DOUBLE_EQ(evaluate(map, {0, 0, 1.25}).value, 8);
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

HapticTransferFunction normalized_map(field::AnyField field, By by, double range_min, double range_max) {
  HapticTransferFunction map = map_of(std::move(field), by, {{0, 0}, {1, 1}});
  map.normalize = true;
  map.range_min = range_min;
  map.range_max = range_max;
  return map;
}

TEST(Parameter, NormalizesAtAnyScale) {
  for (const double scale : {1e-300, 1e-150, 1.0, 1e150, 1e300}) {
    const auto map = normalized_map(formula("plane", scale), By::value, -2 * scale, 2 * scale);
    EXPECT_NEAR(evaluate(map, {0, 0, 1}).value, 0.75, 1e-15) << scale;
    EXPECT_EQ(evaluate(map, {0, 0, -3}).value, 0) << scale;
    EXPECT_EQ(evaluate(map, {0, 0, 3}).value, 1) << scale;
    const auto speed = normalized_map(formula("circle", scale), By::magnitude, HapticTransferFunction().range_min, 4 * scale);
    EXPECT_NEAR(evaluate(speed, {0, 1, 0}).value, 0.25, 1e-15) << scale;
  }
  // a range that overflows a double, one of one unit in the last place, and an empty one
  const double after_one = std::nextafter(1.0, 2.0);
  const auto at = [](double min, double max, double z) {
    return evaluate(normalized_map(formula("plane"), By::value, min, max), {0, 0, z}).value;
  };
  EXPECT_NEAR(at(-1.7e308, 1.7e308, 0.85e308), 0.75, 1e-15);
  EXPECT_EQ(at(1, after_one, 1), 0);
  EXPECT_EQ(at(1, after_one, after_one), 1);
  EXPECT_EQ(at(1, 1, 5), 0);
}

TEST(Parameter, AMapOverAllDoublesStaysFinite) {
  const HapticTransferFunction map = map_of(formula("plane"), By::value, {{-1.7e308, -1.7e308}, {1.7e308, 1.7e308}, {1.75e308, 0}});
  for (const double z : {-1.79e308, -1e308, -1.0, 0.0, 5e-324, 1e308, 1.72e308, 1.79e308}) {
    EXPECT_TRUE(std::isfinite(evaluate(map, {0, 0, z}).value)) << z;
    EXPECT_NEAR(std::fabs(z) < 1.6e308 ? evaluate(map, {0, 0, z}).value / 1e300 : z / 1e300, z / 1e300, 1e-6) << z;
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
    // outside, far outside, masked, a NaN corner
    for (const Vec3& at : {Vec3(-0.1, 1, 1), Vec3(1e300, 1, 1), Vec3(0.5), Vec3(1.5)}) EXPECT_EQ(evaluate(map, at).value, -7) << at.x;
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
  test::ChainDriver hand({test::hold_height("a", 0.5)});
  Link& link = hand.program.links[0];
  link.stiffness_n_per_m =
      Parameter(std::make_shared<const HapticTransferFunction>(map_of(formula("plane"), By::value, {{0, 100}, {1, 300}})));
  link.active_when.button = 1;
  hand.program.coupling.ramp_s = 0.01;
  hand.program.meters_per_unit = 0.1;
  const AllocationCounter guard;
  EXPECT_EQ(norm(hand.at(0, {0, 0, 0.25}).force_n), 0);
  for (int i = 1; i <= 12; ++i) {
    hand.at(1e-3 * i, {0, 0, 0.25}, 1);
    const double k = i == 1 ? 150 : 200, w = std::min(1.0, 0.1 * i);
    EXPECT_NEAR(hand.out.force_n.z, w * k * 0.1 * 0.25, 1e-12) << i;
    EXPECT_EQ(hand.link().stiffness_n_per_m, k);
    EXPECT_EQ(hand.link().evaluations, 2);  // one for the stiffness, one for the link
  }
  EXPECT_EQ(guard.count(), 0u);
}

}  // namespace catena::haptics::parameter_test
