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
