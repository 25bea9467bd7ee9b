// SPDX-License-Identifier: MIT
#include "render/raycast/transfer_tables.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "engine/base/symlog_scale.h"

namespace catena::test::transfer_tables_test {

using namespace catena::render;

/// Table lookup as in the shader (shaders/lib/tables.glsl).
double read(const TransferLut& lut, double value, int channel) {
  const float v = float(value);
  const float x = std::fmin(std::fmax((float(symlog(v, lut.linear_below)) - lut.lo) * lut.entries_per_unit, 0.0f), float(lut.last_index()));
  auto at = std::size_t(std::min(std::uint32_t(x), lut.last_index() - 1));
  float way = x - float(at);
  const bool marked = std::signbit(lut.entries[at].a);
  if (marked) {
    std::size_t before = 0, after = lut.control_points.size() - 1;
    while (after - before > 1) (lut.control_values[(before + after) / 2] <= v ? before : after) = (before + after) / 2;
    at = before;
    way = std::fmin(std::fmax((v - lut.control_values[at]) / (lut.control_values[at + 1] - lut.control_values[at]), 0.0f), 1.0f);
  }
  const std::vector<glm::vec4>& from = marked ? lut.control_points : lut.entries;
  return std::fabs(from[at][channel]) * (1 - way) + std::fabs(from[at + 1][channel]) * way;
}

TransferTable table() {
  TransferTable t;
  t.colors = {{0.1, 0, 0.5, 1}, {0.6, 1, 0.25, 0}};
  t.extinctions = {{0.2, 0}, {0.4, 0}, {0.45, 3}, {0.5, 0}, {0.9, 1}};
  return t;
}

TEST(TransferLut, FollowsTheTable) {
  const TransferLut lut = make_transfer_lut(table(), {0, 1}, 1);
  for (double v = -0.2; v < 1.2; v += 0.00371) {
    EXPECT_NEAR(read(lut, v, 3), table_value(table(), v, 3), 4e-3) << v;
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(read(lut, v, c), table_value(table(), v, c), 1e-3) << v;
  }
  EXPECT_NEAR(table_value(table(), 0.425, 3), 1.5, 1e-12);
  EXPECT_EQ(table_value(table(), 7, 3), 1);
  EXPECT_EQ(table_value(table(), 0, 2), 1);
}

TEST(TransferLut, PlacesItsSamplesAtTheOccurringValues) {
  TransferTable wide;
  wide.colors = {{-1e6, 0, 0, 0}, {1e6, 1, 1, 1}};
  wide.extinctions = {{-1e6, 0}, {1, 0}, {2, 1}, {1e6, 1}};
  const TransferLut lut = make_transfer_lut(wide, {0, 4}, 1);
  for (const double v : {0.5, 1.25, 1.5, 1.75, 3.0}) EXPECT_NEAR(read(lut, v, 3), table_value(wide, v, 3), 1e-3);
}

/// Random functions over ranges up to 1e6 with features of any width and position: at and between all points, in floats, the error is at
/// most twice the stated bound (including the rounding of positions to floats).
TEST(TransferLut, ErrorIsBelowItsStatedBound) {
  std::mt19937 random(5);
  const auto in = [&](double lo, double hi) { return lo + (hi - lo) * (double(random()) / 4294967296.0); };
  int with_points = 0;
  for (int k = 0; k < 300; ++k) {
    const double lo = k % 3 == 0 ? 0 : in(-1, 1), hi = lo + std::pow(10, in(0, 6)), length = std::pow(10, in(-1, 2));
    TransferTable t;
    if (k % 2 == 1) t.linear_below = (hi - lo) * std::pow(10, in(-6, 0));
    std::vector<double> knots;
    for (int i = 0; i < 4; ++i) {
      const double at = lo + (hi - lo) * std::pow(10, in(-6, 0)), width = (hi - lo) * std::pow(10, in(-8, -1));
      knots.insert(knots.end(), {at, at + width});
    }
    std::ranges::sort(knots);
    for (const double at : knots) {
      t.colors.push_back({at, in(0, 1), in(0, 1), in(0, 1)});
      t.extinctions.push_back({at, random() % 2 == 0 ? 0 : in(0, 10) / length});
    }
    const TransferLut lut = make_transfer_lut(t, {float(lo), float(hi)}, length);
    with_points += lut.has_control_points();
    std::vector<double> values;
    for (std::size_t i = 0; i < knots.size(); ++i) {
      const auto f = float(knots[i]);
      for (const float v : {std::nextafter(f, -HUGE_VALF), f, std::nextafter(f, HUGE_VALF)}) values.push_back(v);
      values.push_back(float(i > 0 ? in(knots[i - 1], knots[i]) : in(lo, hi)));
    }
    for (const double v : values) {
      const double sigma = table_value(t, v, 3), depth = sigma * length;
      ASSERT_LE(std::fabs(read(lut, v, 3) - sigma) * length, 2.0 * kTableTolerance * (1 + depth)) << k << " at " << v;
      for (int c = 0; c < 3; ++c)
        ASSERT_LE(std::fabs(read(lut, v, c) - table_value(t, v, c)) * std::min(1.0, depth), 2.0 * kTableTolerance) << k << " at " << v;
    }
  }
  EXPECT_GT(with_points, 100);
  TransferTable wide;
  wide.extinctions = {{0, 0}, {0.5, 1}, {1, 2}};
  EXPECT_FALSE(make_transfer_lut(wide, {0, 1}, 1).has_control_points()) << "samples suffice";
  // a kink near few values may have a small error, a rise within a sample not
  const std::vector<float> there(100, 0.4001f);
  TransferTable tent;
  tent.extinctions = {{0, 0}, {0.4001, 0}, {0.45, 4}, {0.5, 0}, {1, 0}};
  std::vector<float> spread;
  for (int i = 0; i < 4000; ++i) spread.push_back(float(i) / 3999);
  EXPECT_FALSE(make_transfer_lut(tent, {0, 1}, 2, spread).has_control_points());
  EXPECT_TRUE(make_transfer_lut(tent, {0, 1}, 2, there).has_control_points());
  EXPECT_TRUE(make_transfer_lut(tent, {0, 1}, 2).has_control_points());
  tent.extinctions[2][0] = 0.40011;
  EXPECT_TRUE(make_transfer_lut(tent, {0, 1}, 2, spread).has_control_points());
}

/// Label numbers of an atlas, too far apart for one entry each.
TEST(TransferLut, LabelsFarApartKeepTheirColors) {
  TransferTable t;
  t.is_categorical = true;
  for (const double label : {1.0, 2.0, 7.0, 997.0, 312782546.0, 614454277.0}) {
    const double c = std::fmod(label, 10) / 10;
    for (const double side : {-0.5, 0.5}) {
      t.colors.push_back({label + side, c, 1 - c, c});
      t.extinctions.push_back({label + side, label == 7 ? 0.0 : 1.0});
    }
  }
  const TransferLut lut = make_transfer_lut(t, {0, 614454277.0f}, 1);
  for (const double label : {1.0, 2.0, 7.0, 997.0, 312782560.0, 614454272.0}) {
    EXPECT_NEAR(read(lut, label, 3), label == 7 ? 0 : 1, 1e-4) << label;
    EXPECT_NEAR(read(lut, label, 0), table_value(t, label, 0), 1e-4) << label;
  }
}

TEST(TransferLut, PointsGiveVisibleAndEqualRanges) {
  TransferTable t;
  t.colors = {{0, 0, 0, 0}, {20, 1, 0.5, 0}, {400, 0, 1, 0.5}};
  t.extinctions = {{0.01, 0}, {0.02, 3}, {0.03, 0}, {200, 0}, {200, 1}, {365, 1}};
  const TransferLut lut = make_transfer_lut(t, {1e-6f, 365}, 1);
  ASSERT_TRUE(lut.has_control_points());
  EXPECT_TRUE(lut.any_visible({0.011f, 0.012f}));
  EXPECT_FALSE(lut.any_visible({0.04f, 150}));
  EXPECT_EQ(lut.appearance({0.04f, 150}), 1);
  EXPECT_EQ(lut.appearance({210, 300}), 0);
  EXPECT_EQ(lut.appearance({0.011f, 0.015f}), 0);
  EXPECT_EQ(lut.appearance({0.011f, 0.011f}), 0) << "two values of a marked interval would count as one";
  EXPECT_GT(lut.appearance({300, 300}), 1);
}

TEST(TransferLut, AConstantFieldHasOneColor) {
  const TransferLut lut = make_transfer_lut(table(), {0.45f, 0.45f}, 1);
  EXPECT_NEAR(read(lut, 0.45, 3), 3, 1e-5);
  EXPECT_TRUE(lut.any_visible({0.45f, 0.45f}));
}

TEST(TransferLut, VisibleRangesOfTransferFunctions) {
  const TransferLut lut = make_transfer_lut(table(), {0, 1}, 1);
  EXPECT_FALSE(lut.any_visible({0, 0.3f}));
  EXPECT_FALSE(lut.any_visible({0.1f, 0.1f}));
  EXPECT_TRUE(lut.any_visible({0.3f, 0.42f}));
  EXPECT_TRUE(lut.any_visible({0, 1}));
  EXPECT_TRUE(lut.any_visible({0.95f, 1}));
  EXPECT_TRUE(lut.any_visible({0.44f, 0.441f}));
}

TEST(TransferLut, AppearanceIdsAreEqualForEqualAppearance) {
  TransferTable t;
  t.colors = {{0, 0.5, 0.5, 0.5}, {1, 0.5, 0.5, 0.5}};
  t.extinctions = {{0, 0}, {0.2, 0}, {0.4, 2}, {0.6, 2}, {1, 3}};
  const TransferLut lut = make_transfer_lut(t, {0, 1}, 1);
  EXPECT_EQ(lut.appearance({0, 0.15f}), 1);
  EXPECT_EQ(lut.appearance({0.1f, 0.3f}), 0);
  EXPECT_GT(lut.appearance({0.42f, 0.58f}), 1);
  EXPECT_EQ(lut.appearance({0.42f, 0.45f}), lut.appearance({0.5f, 0.58f})) << "on one level stretch";
  EXPECT_EQ(lut.appearance({0.55f, 0.7f}), 0);
  EXPECT_GT(lut.appearance({0.7f, 0.7f}), 1) << "one value is plain on a slope too";
  EXPECT_NE(lut.appearance({0.7f, 0.7f}), lut.appearance({0.8f, 0.8f}));
  EXPECT_NE(lut.appearance({0.7f, 0.7f}), lut.appearance({0.5f, 0.5f}));
}

TEST(TransferLut, FactorsAreConstantBeyondTheirEndsAndKeepNarrowFeatures) {
  const TransferLut lut = make_gradient_factor_lut({{1, 0.2}, {3, 1}, {5, 0.5}});
  for (const auto& [g, factor] : {std::pair{0.0, 0.2}, {1.0, 0.2}, {2.0, 0.6}, {4.0, 0.75}, {5.0, 0.5}, {50.0, 0.5}})
    EXPECT_NEAR(read(lut, g, 0), factor, 1e-3) << g;
  EXPECT_EQ(make_gradient_factor_lut({{2, 0.5}}).entries.front().x, 0.5f);
  const TransferLut rise = make_gradient_factor_lut({{0, 0}, {0.01, 0}, {0.05, 1}, {1000, 1}});
  for (const auto& [g, factor] : {std::pair{0.005, 0.0}, {0.03, 0.5}, {0.06, 1.0}, {0.2, 1.0}})
    EXPECT_NEAR(read(rise, g, 0), factor, 1e-3) << g;
}

}  // namespace catena::test::transfer_tables_test
