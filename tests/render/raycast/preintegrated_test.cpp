// SPDX-License-Identifier: MIT
#include "render/raycast/preintegrated.h"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>

namespace catena::test::preintegrated_test {

using namespace catena::render;

TransferTable table_of(std::vector<std::array<double, 2>> extinctions) {
  TransferTable table;
  table.colors = {{0, 0, 0.5, 1}, {1, 1, 0.5, 0}};
  table.extinctions = std::move(extinctions);
  return table;
}
double sigma(const PreintegratedTable& t, int a, int b) { return std::bit_cast<float>(t.entries[a + 256 * b][0]); }
double red(const PreintegratedTable& t, int a, int b) { return (t.entries[a + 256 * b][1] & 2047) / 2047.0; }
double blue(const PreintegratedTable& t, int a, int b) { return (t.entries[a + 256 * b][1] >> 22) / 1023.0; }

TEST(Preintegrated, LinearSigmaGivesItsMeanAndTheWeightedColor) {
  const auto t = make_preintegrated(table_of({{0, 0}, {1, 2}}), 0, 1 / 255.0, false);
  for (const auto& [a, b] : {std::pair{0, 255}, {30, 90}, {90, 30}, {200, 201}, {77, 77}}) {
    EXPECT_NEAR(sigma(t, a, b), (a + b) / 255.0, 1e-6);
    // mean of v^2 over mean of v
    const double u = a / 255.0, v = b / 255.0, mean = 2.0 / 3 * (u * u + u * v + v * v) / (u + v);
    EXPECT_NEAR(red(t, a, b), mean, 2e-3) << a << " " << b;
    EXPECT_NEAR(blue(t, a, b), 1 - mean, 2e-3);
  }
}

TEST(Preintegrated, AnEmptyCodeIsEmptyAndASpikeBetweenCodesIsVisible) {
  const auto t = make_preintegrated(table_of({{0, 0}, {0.5, 0}, {0.51, 4}, {0.52, 0}, {1, 0}}), 0, 1 / 255.0, false);
  EXPECT_EQ(sigma(t, 0, 0), 0);
  EXPECT_EQ(sigma(t, 0, 127), 0);
  EXPECT_EQ(sigma(t, 140, 255), 0);
  EXPECT_NEAR(sigma(t, 0, 255), 0.04, 0.004);  // the spike's area divided by the range
  EXPECT_EQ(t.appearance.appearance_id[0], t.appearance.appearance_id[127]);
  EXPECT_EQ(t.appearance.appearance_id[133], t.appearance.appearance_id[255]);
  EXPECT_NE(t.appearance.appearance_id[127], t.appearance.appearance_id[133]);
}

TEST(Preintegrated, FeaturesNarrowerThanACodeCountByTheirArea) {
  const auto t = make_preintegrated(table_of({{0, 0}, {0.5, 0}, {0.500001, 4e5}, {0.500002, 0}, {1, 0}}), 0, 1 / 255.0, false);
  EXPECT_NEAR(sigma(t, 0, 255), 0.4, 1e-6);
  EXPECT_NEAR(sigma(t, 120, 135), 0.4 * 255 / 15, 1e-5);
  EXPECT_EQ(sigma(t, 130, 255), 0);
  EXPECT_EQ(t.max_sigma, 4e5);
}

TEST(Preintegrated, TheQuantizationChangeIsWeightedByTheValues) {
  const TransferTable rise = table_of({{0.01, 0}, {0.05, 2}, {1000, 2}});
  std::vector<float> decades, even;
  for (int i = 0; i < 600; ++i) {
    decades.push_back(float(std::pow(10, i / 100.0 - 3)));
    even.push_back(float(i) * 1000 / 599);
  }
  EXPECT_GT(quantization_change(rise, {0.01, 1000}, decades, 1), 0.1);
  EXPECT_LT(quantization_change(rise, {0.01, 1000}, even, 1), 0.01);
  EXPECT_EQ(quantization_change(rise, {3, 3}, even, 1), 0);
}

TEST(Preintegrated, TheActiveRangeIsWhereTheImageDependsOnTheValue) {
  auto active = active_interval(table_of({{0, 0}, {0.25, 0}, {0.5, 1}, {1, 1}}), {0, 1}, false);
  EXPECT_NEAR(active.min, 0.25, 1e-3);
  EXPECT_NEAR(active.max, 1, 1e-3);  // the colour changes up to the end
  active = active_interval(table_of({{0, 0}, {0.25, 0}, {0.5, 1}, {0.6, 0}}), {0, 1}, false);
  EXPECT_NEAR(active.max, 0.6, 1e-3);
}

TEST(Preintegrated, VisibleCodesOfShadedVolumesHaveDistinctAppearances) {
  const auto flat = table_of({{0, 0}, {0.3, 0}, {0.31, 1}, {1, 1}});
  TransferTable grey = flat;
  for (auto& c : grey.colors) c = {c[0], 0.5, 0.5, 0.5};
  const auto unlit = make_preintegrated(grey, 0, 1 / 255.0, false), lit = make_preintegrated(grey, 0, 1 / 255.0, true);
  EXPECT_EQ(unlit.appearance.appearance_id[90], unlit.appearance.appearance_id[200]);
  EXPECT_NE(lit.appearance.appearance_id[90], lit.appearance.appearance_id[200]);
  EXPECT_EQ(lit.appearance.appearance_id[10], lit.appearance.appearance_id[70]);  // both codes are invisible
  EXPECT_EQ(unlit.entries, lit.entries);
  EXPECT_LT(active_interval(grey, {0, 1}, false).max, 0.32);
  EXPECT_EQ(active_interval(grey, {0, 1}, true).max, 1);
  EXPECT_NEAR(active_interval(grey, {0, 1}, true).min, 0.3, 1e-3);
}

}  // namespace catena::test::preintegrated_test
