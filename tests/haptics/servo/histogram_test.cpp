// SPDX-License-Identifier: MIT
#include "haptics/servo/servo_stats.h"

#include <gtest/gtest.h>

#include <cmath>
#include <thread>
#include <vector>

#include "engine/base/numbers.h"

namespace catena::haptics::histogram_test {

TEST(Histogram, AnEmptyHistogramIsAllZero) {
  const HistogramSummary f = Histogram().summarize();
  EXPECT_EQ(f.count, 0u);
  EXPECT_EQ(f.p50_us, 0);
  EXPECT_EQ(f.max_us, 0);
}

TEST(Histogram, OfOneValueEveryQuantileIsThatValueWithinABucket) {
  for (std::int64_t ns = 1; ns < (std::int64_t{1} << 39); ns = ns * 5 / 4 + 1) {
    Histogram h;
    h.add(ns);
    const HistogramSummary f = h.summarize();
    EXPECT_EQ(f.max_us, 1e-3 * static_cast<double>(ns));
    EXPECT_NEAR(f.p50_us, f.max_us, f.max_us / 256) << ns;
    EXPECT_EQ(f.p50_us, f.p999_us);
  }
}

TEST(Histogram, QuantilesAreWithinHalfAPercent) {
  Histogram h;
  std::vector<double> exact;
  std::uint64_t seed = 7;
  for (int k = 0; k < 50000; ++k) {
    seed = seed * 6364136223846793005u + 1442695040888963407u;
    const double u = static_cast<double>(seed >> 11) * 0x1p-53;
    // a long-tailed distribution, like that of periods
    const auto ns = static_cast<std::int64_t>(3000 + 500 * u + 200 * std::pow(1 - u, -1.2));
    h.add(ns);
    exact.push_back(1e-3 * static_cast<double>(ns));
  }
  const HistogramSummary f = h.summarize();
  EXPECT_EQ(f.count, exact.size());
  EXPECT_NEAR(f.p50_us / quantile(exact, 0.5), 1, 0.005);
  EXPECT_NEAR(f.p99_us / quantile(exact, 0.99), 1, 0.005);
  EXPECT_NEAR(f.p999_us / quantile(exact, 0.999), 1, 0.005);
  EXPECT_EQ(f.max_us, quantile(exact, 1.0));
}

TEST(Histogram, EveryValueIsInExactlyOneBin) {
  Histogram h;
  for (const std::int64_t ns : {5, 15, 16, 1000, 1023, 1024, 1151, 1152, 1000000}) h.add(ns);
  const std::vector<HistogramSummary::Bin> bins = h.summarize().bins;
  const std::vector<std::pair<double, std::uint64_t>> expected = {{0, 2}, {0.016, 1}, {0.960, 2}, {1.024, 2}, {1.152, 1}, {983.040, 1}};
  ASSERT_EQ(bins.size(), expected.size());
  for (std::size_t i = 0; i < bins.size(); ++i) {
    EXPECT_NEAR(bins[i].from_us, expected[i].first, 1e-9) << i;
    EXPECT_EQ(bins[i].count, expected[i].second) << i;
  }
}

TEST(Histogram, OutOfRangeTimesAreCountedInTheEndBins) {
  Histogram h;
  h.add(-5);
  h.add(0);
  h.add(std::int64_t{1} << 62);
  const HistogramSummary f = h.summarize();
  EXPECT_EQ(f.count, 3u);
  EXPECT_EQ(f.p50_us, 0);
  EXPECT_EQ(f.max_us, 1e-3 * std::ldexp(1.0, 62));
}

TEST(Histogram, CanBeReadWhileItIsFilled) {
  Histogram h;
  constexpr std::uint64_t kCount = 200000;
  std::thread writer([&] {
    for (std::uint64_t k = 0; k < kCount; ++k) h.add(1000 + static_cast<std::int64_t>(k % 100));
  });
  std::uint64_t last = 0;
  while (last < kCount) {
    const HistogramSummary f = h.summarize();
    ASSERT_GE(f.count, last);
    if (f.count > 0) {
      ASSERT_NEAR(f.p99_us, 1.05, 0.07);
    }
    last = f.count;
  }
  writer.join();
}

}  // namespace catena::haptics::histogram_test
