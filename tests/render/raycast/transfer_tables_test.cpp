#include "render/raycast/transfer_tables.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace catena::test {
namespace transfer_tables_test {

using namespace catena::render;

/// As the shader reads it.
double read(const TransferLut& lut, double value, int channel) {
  const float x = std::fmin(std::fmax((float(value) - lut.lo) * lut.per_value, 0.0f), float(lut.last()));
  const auto cell = std::min(std::uint32_t(x), lut.last() - 1);
  const float f = x - float(cell);
  return lut.entries[cell][channel] * (1 - f) + lut.entries[cell + 1][channel] * f;
}

TransferTable table() {
  TransferTable t;
  t.colors = {{0.1, 0, 0.5, 1}, {0.6, 1, 0.25, 0}};
  t.extinctions = {{0.2, 0}, {0.4, 0}, {0.45, 3}, {0.5, 0}, {0.9, 1}};
  return t;
}

TEST(TransferLut, FollowsTheTable) {
  const TransferLut lut = make_transfer_lut(table(), {0, 1});
  for (double v = -0.2; v < 1.2; v += 0.00371) {
    EXPECT_NEAR(read(lut, v, 3), table_value(table(), v, 3), 0.01) << v;  // a sample's width beside the peak
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(read(lut, v, c), table_value(table(), v, c), 1e-3) << v;
  }
  EXPECT_NEAR(table_value(table(), 0.425, 3), 1.5, 1e-12);
  EXPECT_EQ(table_value(table(), 7, 3), 1);
  EXPECT_EQ(table_value(table(), 0, 2), 1);
}

TEST(TransferLut, SpendsItsSamplesOnTheValuesThatAreThere) {
  TransferTable wide;
  wide.colors = {{-1e6, 0, 0, 0}, {1e6, 1, 1, 1}};
  wide.extinctions = {{-1e6, 0}, {1, 0}, {2, 1}, {1e6, 1}};
  const TransferLut lut = make_transfer_lut(wide, {0, 4});
  for (const double v : {0.5, 1.25, 1.5, 1.75, 3.0}) EXPECT_NEAR(read(lut, v, 3), table_value(wide, v, 3), 1e-3);
}

TEST(TransferLut, WhatSamplesWouldMissIsKeptExactly) {
  TransferTable t;
  t.colors = {{0, 0, 0, 0}, {20, 1, 0.5, 0}, {400, 0, 1, 0.5}};
  t.extinctions = {{0.01, 0}, {0.02, 3}, {0.03, 0}, {200, 0}, {200, 1}, {365, 1}};
  const TransferLut lut = make_transfer_lut(t, {1e-6f, 365});
  ASSERT_TRUE(lut.uneven());
  EXPECT_LT(lut.per_value, 0);
  const std::vector<glm::vec4> words = lut.words();
  // as the shader reads it
  const auto own = [&](std::size_t i) { return words[lut.entries.size() + i / 4][int(i % 4)]; };
  const auto read_own = [&](float value, int channel) {
    std::size_t before = 0, after = lut.last();
    while (after - before > 1) (own((before + after) / 2) <= value ? before : after) = (before + after) / 2;
    const float f = std::fmin(std::fmax((value - own(before)) / (own(after) - own(before)), 0.0f), 1.0f);
    return words[before][channel] * (1 - f) + words[after][channel] * f;
  };
  for (const double v : {-1.0, 1e-6, 0.005, 0.0125, 0.02, 0.021, 0.0299, 0.1, 19.0, 21.0, 199.9, 200.1, 364.0, 365.0, 500.0})
    for (int c = 0; c < 4; ++c)
      EXPECT_NEAR(read_own(float(v), c), table_value(t, std::clamp(v, 1e-6, 365.0), c), 2e-6 * 3) << v << " " << c;
  EXPECT_TRUE(lut.visible({0.011f, 0.012f}));
  EXPECT_FALSE(lut.visible({0.04f, 150}));
  EXPECT_EQ(lut.look({0.04f, 150}), 1);
  EXPECT_GT(lut.look({210, 300}), -1);
  EXPECT_EQ(lut.look({0.011f, 0.015f}), 0);
}

TEST(TransferLut, SamplesTakeStepsHoweverSharpAndNoNarrowPeaksAndGaps) {
  const auto sampled = [](std::vector<std::array<double, 2>> extinctions) {
    TransferTable t;
    t.extinctions = std::move(extinctions);
    return is_sampled(t, 0, 1, 4096);
  };
  EXPECT_TRUE(sampled({{0, 0}, {0.5, 0}, {0.5 + 1e-9, 1}, {1, 1}}));
  EXPECT_TRUE(sampled({{0, 0}, {0.5, 0}, {0.5, 1}, {1, 0.2}}));
  EXPECT_TRUE(sampled({{0, 0}, {0.48, 0}, {0.5, 1}, {0.52, 0}, {1, 0}}));
  EXPECT_TRUE(sampled({{0, 1}, {0.50001, 0}, {1, 1}})) << "a gap as wide as all";
  EXPECT_TRUE(sampled({{0, 0}, {0.49, 1}, {0.50001, 0}, {0.51, 1}, {1, 0}})) << "a gap of 80 samples";
  EXPECT_TRUE(sampled({{0.3, 2}}));
  EXPECT_TRUE(sampled({}));
  EXPECT_FALSE(sampled({{0, 0}, {0.5, 0}, {0.50001, 1}, {0.50002, 0}, {1, 0}})) << "a peak";
  EXPECT_FALSE(sampled({{0, 0}, {0.5, 1}, {0.50001, 0}, {0.50002, 1}, {1, 0}})) << "a gap";
  EXPECT_FALSE(sampled({{0, 0}, {1e-6, 1}, {2e-6, 0}, {1, 0}})) << "at the end";
}

TEST(TransferLut, AConstantFieldHasOneColour) {
  const TransferLut lut = make_transfer_lut(table(), {0.45f, 0.45f});
  EXPECT_NEAR(read(lut, 0.45, 3), 3, 1e-5);
  EXPECT_TRUE(lut.visible({0.45f, 0.45f}));
}

TEST(TransferLut, VisibleRanges) {
  const TransferLut lut = make_transfer_lut(table(), {0, 1});
  EXPECT_FALSE(lut.visible({0, 0.3f}));
  EXPECT_FALSE(lut.visible({0.1f, 0.1f}));
  EXPECT_TRUE(lut.visible({0.3f, 0.42f}));
  EXPECT_TRUE(lut.visible({0, 1}));
  EXPECT_TRUE(lut.visible({0.95f, 1}));
  EXPECT_TRUE(lut.visible({0.44f, 0.441f}));
}

TEST(TransferLut, LooksAreEqualWhereTheyAreAlike) {
  TransferTable t;
  t.colors = {{0, 0.5, 0.5, 0.5}, {1, 0.5, 0.5, 0.5}};
  t.extinctions = {{0, 0}, {0.2, 0}, {0.4, 2}, {0.6, 2}, {1, 3}};
  const TransferLut lut = make_transfer_lut(t, {0, 1});
  EXPECT_EQ(lut.look({0, 0.15f}), 1);
  EXPECT_EQ(lut.look({0.1f, 0.3f}), 0);
  EXPECT_GT(lut.look({0.42f, 0.58f}), 1);
  EXPECT_EQ(lut.look({0.42f, 0.45f}), lut.look({0.5f, 0.58f})) << "on one level stretch";
  EXPECT_EQ(lut.look({0.55f, 0.7f}), 0);
  EXPECT_GT(lut.look({0.7f, 0.7f}), 1) << "one value is plain on a slope too";
  EXPECT_NE(lut.look({0.7f, 0.7f}), lut.look({0.8f, 0.8f}));
  EXPECT_NE(lut.look({0.7f, 0.7f}), lut.look({0.5f, 0.5f}));
}

TEST(TransferLut, FactorsAreHeldBeyondTheirEnds) {
  const FactorLut lut = make_factor_lut({{1, 0.2}, {3, 1}, {5, 0.5}});
  const auto at = [&](double g) {
    const double x = std::clamp((g - lut.lo) * lut.per_gradient, 0.0, double(lut.entries.size() - 1));
    const auto i = std::min(std::size_t(x), lut.entries.size() - 2);
    return lut.entries[i].x + (x - double(i)) * (lut.entries[i + 1].x - lut.entries[i].x);
  };
  for (const auto& [g, factor] : {std::pair{0.0, 0.2}, {1.0, 0.2}, {2.0, 0.6}, {4.0, 0.75}, {5.0, 0.5}, {50.0, 0.5}})
    EXPECT_NEAR(at(g), factor, 1e-3) << g;
  EXPECT_EQ(make_factor_lut({{2, 0.5}}).entries.front().x, 0.5f);
}

}  // namespace transfer_tables_test
}  // namespace catena::test
