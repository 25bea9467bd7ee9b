// SPDX-License-Identifier: MIT
// The default range of values in images: outliers and fill values are left out, ordinary data are not.
#include "engine/base/display_range.h"

#include <gtest/gtest.h>

#include <limits>
#include <random>

#include "engine/base/numbers.h"
#include "tests/support/results.h"

namespace catena::display_range_test {

constexpr float kMost = std::numeric_limits<float>::max();

/// `n` evenly spaced values of lo..hi, including both ends.
std::vector<float> spread(int n, double lo, double hi) {
  std::vector<float> values;
  for (int i = 0; i < n; ++i) values.push_back(static_cast<float>(lo + (hi - lo) * i / (n - 1)));
  return values;
}

std::vector<float> with(std::vector<float> values, std::size_t count, float value) {
  values.insert(values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2), count, value);
  return values;
}

TEST(DisplayRange, OutliersAndFillValuesAreLeftOut) {
  const std::vector<float> unit = spread(1000, 0, 1);
  struct Case {
    std::vector<float> values;
    const char* text;
  };
  const Case cases[] = {
      {with(unit, 1, 1e20f), "0 .. 1 (1 value of 1e20 beyond)"},
      {with(unit, 4, -12345.f), "0 .. 1 (4 values of -12345 beyond)"},
      {with(unit, 430, -9999.f), "0 .. 1 (430 values of -9999 beyond)"},
      {with(unit, 4000, -9999.f), "0 .. 1 (4000 values of -9999 beyond)"},
      {with(with(unit, 1, kMost), 1, -kMost), "0 .. 1 (1 value of -3.40282e38 below, 1 of 3.40282e38 above)"},
      {with(with(unit, 300, -999.f), 2, 1e20f), "0 .. 1 (300 values of -999 below, 2 of 1e20 above)"},
      {with(with(unit, 1, 1e20f), 1, 2e20f), "0 .. 1 (2 values of 1e20 to 2e20 beyond)"},
      {with(spread(500, -1024, 3071), 90, -32768.f), "-1024 .. 3071 (90 values of -32768 beyond)"},
      {with(spread(500, 250, 310), 90, -999.f), "250 .. 310 (90 values of -999 beyond)"},
      {with(unit, 50, 9.96921e36f), "0 .. 1 (50 values of 9.96921e36 beyond)"},
      {with(std::vector<float>(300, 5), 1, 1e20f), "5 .. 5 (1 value of 1e20 beyond)"},
      {with(std::vector<float>(300, 0), 100, -9999.f), "0 .. 0 (100 values of -9999 beyond)"},
      {with(spread(300, 0, 1e-41), 1, 1e20f), "0 .. 9.99967e-42 (1 value of 1e20 beyond)"},
      {with(spread(300, 1e19, 2e19), 1, -1e30f), "1e19 .. 2e19 (1 value of -1e30 beyond)"},
  };
  for (const Case& c : cases) EXPECT_EQ(format_range(display_range(c.values)), c.text);
}

TEST(DisplayRange, OrdinaryDataHaveTheirFullRange) {
  std::mt19937 random(1);
  std::lognormal_distribution<double> tail(0, 3);
  std::normal_distribution<double> bell;
  std::vector<float> heavy, normal, plume(20000, 0.f), noise;
  for (int i = 0; i < 20000; ++i) {
    heavy.push_back(static_cast<float>(tail(random)));
    normal.push_back(static_cast<float>(bell(random)));
    noise.push_back(static_cast<float>(100 * std::fabs(bell(random))));
  }
  for (int i = 0; i < 100; ++i) plume[static_cast<std::size_t>(200 * i)] = 1 + 0.01f * static_cast<float>(i);
  std::vector<float> vessels = noise;
  for (int i = 0; i < 100; ++i) vessels[static_cast<std::size_t>(200 * i)] = 2000.f + static_cast<float>(i);
  const std::vector<std::vector<float>> all{heavy,
                                            normal,
                                            plume,
                                            noise,
                                            vessels,
                                            {},
                                            {3},
                                            {0, 7},
                                            {0, 0, 0, 1},
                                            {0, 255},
                                            {1, 2, 1000},
                                            {-1, 1},
                                            with(std::vector<float>(500, 0), 300, 65535.f),
                                            with(std::vector<float>(500, 0), 3, 1000.f),
                                            with(spread(500, 0, 10), 500, 110.f),
                                            with(spread(300, 300, 310), 200, 0.f),
                                            with(spread(300, -9500, 0), 30, -9999.f),
                                            spread(300, -1e38, 1e38),
                                            spread(300, 0, 1e-42)};
  for (const auto& values : all) {
    const DisplayRange range = display_range(values);
    EXPECT_FALSE(range.has_outliers()) << format_range(range);
    EXPECT_EQ(range.lo, values.empty() ? 0 : *std::ranges::min_element(values));
    EXPECT_EQ(range.hi, values.empty() ? 0 : *std::ranges::max_element(values));
  }
}

TEST(DisplayRange, ManyEqualValuesMayMeanMissingData) {
  const std::string note = outlier_note(display_range(with(spread(700, 0, 1), 300, -9999.f)));
  EXPECT_TRUE(test::has(note, "30 % of the values are exactly -9999: perhaps missing data"));
  EXPECT_EQ(outlier_note(display_range(spread(700, 0, 1))), "");
}

TEST(Numbers, AreFormattedReadably) {
  const std::pair<double, const char*> cases[] = {{1e20f, "1e20"},
                                                  {0.1f, "0.1"},
                                                  {-0.0, "0"},
                                                  {-9999, "-9999"},
                                                  {101325.37, "101325"},
                                                  {65535, "65535"},
                                                  {-2147483648.0, "-2147483648"},
                                                  {1e9, "1e9"},
                                                  {1e6, "1000000"},
                                                  {1.0 / 3, "0.333333"},
                                                  {9.9692099683868690e+36, "9.96921e36"},
                                                  {2.5e-7, "2.5e-7"},
                                                  {1.4e-45f, "1.4013e-45"},
                                                  {HUGE_VAL, "inf"}};
  for (const auto& [value, text] : cases) EXPECT_EQ(format_readable(value), text);
}

}  // namespace catena::display_range_test
