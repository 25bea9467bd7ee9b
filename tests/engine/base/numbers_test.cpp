// SPDX-License-Identifier: MIT
#include "engine/base/numbers.h"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <random>

namespace catena::numbers_test {

std::vector<std::string> labels_of(double lo, double hi, int about = 5) {
  std::vector<std::string> labels;
  for (const AxisTick& tick : nice_ticks(lo, hi, about)) labels.push_back(tick.label);
  return labels;
}

using Labels = std::vector<std::string>;

TEST(Ticks, KnownRangesHaveKnownTicks) {
  EXPECT_EQ(labels_of(0, 1), (Labels{"0.0", "0.2", "0.4", "0.6", "0.8", "1.0"}));
  EXPECT_EQ(labels_of(0, 10), (Labels{"0", "2", "4", "6", "8", "10"}));
  EXPECT_EQ(labels_of(-1, 1), (Labels{"-1.0", "-0.5", "0.0", "0.5", "1.0"}));
  EXPECT_EQ(labels_of(0.3, 0.8), (Labels{"0.3", "0.4", "0.5", "0.6", "0.7", "0.8"}));
  EXPECT_EQ(labels_of(-1024, 2986), (Labels{"-1000", "0", "1000", "2000"}));
  EXPECT_EQ(labels_of(190.9, 310.6), (Labels{"200", "220", "240", "260", "280", "300"}));
  EXPECT_EQ(labels_of(0.198, 0.707), (Labels{"0.2", "0.3", "0.4", "0.5", "0.6", "0.7"}));
  EXPECT_EQ(labels_of(273.1, 273.2, 3), (Labels{"273.10", "273.15", "273.20"}));
  EXPECT_EQ(labels_of(1, 0, 3), (Labels{"0.0", "0.5", "1.0"})) << "the other way round";
}

TEST(Ticks, LargeAndSmallNumbersHaveExponents) {
  EXPECT_EQ(labels_of(0, 3e6, 4), (Labels{"0", "1e6", "2e6", "3e6"}));
  EXPECT_EQ(labels_of(0, 4e-7), (Labels{"0", "1e-7", "2e-7", "3e-7", "4e-7"}));
  EXPECT_EQ(labels_of(0, 500000, 6), (Labels{"0", "100000", "200000", "300000", "400000", "500000"}));
  EXPECT_EQ(labels_of(1000000, 1000004), (Labels{"1000000", "1000001", "1000002", "1000003", "1000004"}))
      << "an exponent would not be shorter";
  EXPECT_EQ(labels_of(-1e300, 1e300, 3), (Labels{"-1e300", "0", "1e300"}));
}

TEST(Ticks, AnEmptyRangeHasOneTick) {
  EXPECT_EQ(labels_of(0.3, 0.3), Labels{"0.3"});
  EXPECT_EQ(labels_of(1, std::nextafter(1.0, 2.0)), Labels{"1"});
  EXPECT_TRUE(nice_ticks(0, std::nan("")).empty());
  EXPECT_TRUE(nice_ticks(-std::numeric_limits<double>::infinity(), 0).empty());
}

/// Ticks lie in the range, evenly spaced at 1, 2 or 5 times a power of ten, in the promised number; and labels equal the values.
TEST(Ticks, AnyRangeHasNiceTicks) {
  std::mt19937 random(3);
  const auto in = [&](double a, double b) { return a + (b - a) * (static_cast<double>(random()) / 4294967296.0); };
  for (int i = 0; i < 20000 && !HasFailure(); ++i) {
    const double size = std::pow(10, in(-200, 200)), offset = i % 3 == 0 ? 0 : size * std::pow(10, in(-3, 3));
    const double lo = offset - size * in(0, 1), hi = lo + size;
    const int about = 2 + i % 9;
    const auto ticks = nice_ticks(lo, hi, about);
    const double intervals = std::max(2, about - 1);
    EXPECT_GE(double(ticks.size()), std::floor(0.6 * intervals)) << lo << " " << hi;
    EXPECT_LE(double(ticks.size()), 1.5 * intervals + 1.001) << lo << " " << hi;
    const double step = ticks.size() > 1 ? ticks[1].value - ticks[0].value : 0;
    for (std::size_t k = 0; k < ticks.size(); ++k) {
      EXPECT_GE(ticks[k].value, lo - 1e-6 * size);
      EXPECT_LE(ticks[k].value, hi + 1e-6 * size);
      EXPECT_EQ(parse_double(ticks[k].label), ticks[k].value);
      EXPECT_LE(ticks[k].label.size(), 17u) << ticks[k].label;
      EXPECT_NEAR(ticks[k].value - ticks[k > 0 ? k - 1 : 0].value, k > 0 ? step : 0, 1e-6 * size);
    }
    if (ticks.size() < 2) continue;
    const double lead = step / std::pow(10, std::floor(std::log10(step) + 1e-6));
    EXPECT_TRUE(std::fabs(lead - 1) < 1e-3 || std::fabs(lead - 2) < 1e-3 || std::fabs(lead - 5) < 1e-3) << step;
    EXPECT_GT(ticks.front().value - step, lo - 1.000001 * step) << "none is missing at the start";
    EXPECT_GT(ticks.back().value + step, hi - 1e-6 * size) << "none is missing at the end";
    EXPECT_LT(ticks.front().value - step, lo + 1e-6 * size);
  }
}

TEST(Numbers, EveryDoubleReadsBackExactly) {
  std::uint64_t bits = 0x9e3779b97f4a7c15ull;
  for (int k = 0; k < 20000; ++k) {
    bits ^= bits << 13;
    bits ^= bits >> 7;
    bits ^= bits << 17;
    const double value = std::bit_cast<double>(bits);
    if (!std::isfinite(value)) continue;
    ASSERT_EQ(std::bit_cast<std::uint64_t>(*parse_double(to_text(value))), bits) << to_text(value);
  }
  for (const double value : {0.0, -0.0, 0.1, 5e-324, std::numeric_limits<double>::max()})
    EXPECT_EQ(std::bit_cast<std::uint64_t>(*parse_double(to_text(value))), std::bit_cast<std::uint64_t>(value));
}

TEST(Numbers, OnlyCompleteTextsAreNumbers) {
  for (const char* good : {"1", " 1 ", "+1", "1e3", "-.5", "1.", "\t2\r"}) EXPECT_TRUE(parse_double(good)) << good;
  for (const char* bad : {"", " ", "1x", "x1", "1 2", "0x10", "1,5", "--1", "+-1", "+"}) EXPECT_FALSE(parse_double(bad)) << bad;
}

TEST(Numbers, UnderflowIsZeroAndOverflowIsRefused) {
  EXPECT_EQ(parse_double("1e-400"), 0.0);
  EXPECT_FALSE(parse_double("1e999"));
}

}  // namespace catena::numbers_test
