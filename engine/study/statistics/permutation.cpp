// SPDX-License-Identifier: MIT
#include "engine/study/statistics/permutation.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <random>
#include <vector>

#include "engine/study/statistics/summary.h"

namespace catena::statistics {
namespace {

/// Returns the sums for all 2^n choices of signs in increasing order.
std::vector<double> sorted_sums(std::span<const double> values) {
  std::vector<double> sums{0.0};
  for (const double x : values) {
    const std::size_t half = sums.size();
    sums.resize(2 * half);
    for (std::size_t i = 0; i < half; ++i) {
      sums[half + i] = sums[i] + std::fabs(x);
      sums[i] -= std::fabs(x);
    }
  }
  std::sort(sums.begin(), sums.end());
  return sums;
}

double exact_p(std::span<const double> values, double bound) {
  const std::vector<double> first = sorted_sums(values.subspan(0, values.size() / 2));
  const std::vector<double> second = sorted_sums(values.subspan(values.size() / 2));
  // two-pointer search: the larger the sum of one half, the smaller the required sum of the other; the sums are symmetric, so that the
  // upper tail is counted and doubled
  double extreme_count = 0;
  std::size_t j = second.size();
  for (const double x : first) {
    while (j > 0 && x + second[j - 1] >= bound) --j;
    extreme_count += static_cast<double>(second.size() - j);
  }
  return std::min(1.0, 2 * extreme_count / std::ldexp(1.0, static_cast<int>(values.size())));
}

double sampled_p(std::span<const double> values, double bound, std::uint64_t seed, int samples) {
  std::mt19937_64 random(seed);
  int extreme_count = 0;
  for (int k = 0; k < samples; ++k) {
    double sum = 0;
    std::uint64_t bits = 0;
    for (std::size_t i = 0; i < values.size(); ++i, bits >>= 1) {
      if (i % 64 == 0) bits = random();
      sum += (bits & 1) != 0 ? values[i] : -values[i];
    }
    if (std::fabs(sum) >= bound) ++extreme_count;
  }
  return (1.0 + extreme_count) / (1.0 + samples);
}

}  // namespace

Result<SignFlipTest> sign_flip_test(std::span<const double> differences, std::uint64_t seed) {
  CATENA_CHECK(check_values(differences, 2));
  double size = 0;
  for (const double d : differences) size += std::fabs(d);
  if (!std::isfinite(size)) return Error{"the values are too large to sum"};
  if (!(size > 0)) return SignFlipTest{1, true, std::ldexp(1.0, static_cast<int>(differences.size()))};
  const double bound = std::fabs(std::accumulate(differences.begin(), differences.end(), 0.0)) - 1e-12 * size;
  if (bound <= 0) return SignFlipTest{1, true, std::ldexp(1.0, static_cast<int>(differences.size()))};
  if (differences.size() <= kMaxExactFlips)
    return SignFlipTest{exact_p(differences, bound), true, std::ldexp(1.0, static_cast<int>(differences.size()))};
  const int samples = static_cast<int>(std::clamp<std::size_t>(20'000'000 / differences.size(), 100, 10'000));
  return SignFlipTest{sampled_p(differences, bound, seed, samples), false, static_cast<double>(samples)};
}

}  // namespace catena::statistics
