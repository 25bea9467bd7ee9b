// SPDX-License-Identifier: MIT
/// Count, mean and standard deviation of a set of numbers, in one pass. Any thread, each with its own object.
///   mean_n     = mean_(n-1) + d / n,      squares_n = squares_(n-1) + d (x - mean_n),  d = x - mean_(n-1)       (Welford 1962)
///   two parts    squares = squares_a + squares_b + (mean_b - mean_a)^2 n_a n_b / (n_a + n_b)                    (Chan et al. 1983)
/// All means are relative to the first number, so that the deviation of 1e9 +- 1e-3 is not lost to cancellation.
#pragma once
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>

namespace catena::field {

/// Accumulator of finite numbers.
class Moments {
 public:
  /// Adds a finite number.
  void add(double value) {
    if (count_++ == 0) first_ = value;
    const double x = value - first_, d = x - mean_;
    mean_ += d / static_cast<double>(count_);
    squares_ += d * (x - mean_);
    min_ = std::min(min_, value);
    max_ = std::max(max_, value);
  }
  /// Adds all numbers of another accumulator. The result depends on the order of the calls by rounding errors only.
  void merge(const Moments& other) {
    if (other.count_ == 0) return;
    if (count_ == 0) {
      *this = other;
      return;
    }
    const auto n = static_cast<double>(count_), m = static_cast<double>(other.count_);
    const double d = (other.first_ - first_) + other.mean_ - mean_;
    mean_ += d * (m / (n + m));
    squares_ += other.squares_ + d * d * (n * (m / (n + m)));
    count_ += other.count_;
    min_ = std::min(min_, other.min_);
    max_ = std::max(max_, other.max_);
  }

  /// Number of numbers.
  std::uint64_t count() const { return count_; }
  /// Smallest number; infinity when there is none.
  double min() const { return min_; }
  /// Largest number; -infinity when there is none.
  double max() const { return max_; }
  /// Mean; NaN when there is no number.
  double mean() const { return count_ > 0 ? first_ + mean_ : std::numeric_limits<double>::quiet_NaN(); }
  /// Standard deviation with the divisor N - 1 (`ddof=1` of NumPy); NaN for fewer than two numbers.
  double deviation() const {
    return count_ > 1 ? std::sqrt(std::max(0.0, squares_) / static_cast<double>(count_ - 1)) : std::numeric_limits<double>::quiet_NaN();
  }

 private:
  std::uint64_t count_ = 0;
  double first_ = 0, mean_ = 0;  ///< first number; mean of the differences from it
  double squares_ = 0;           ///< sum of the squared differences from the mean
  double min_ = std::numeric_limits<double>::infinity(), max_ = -std::numeric_limits<double>::infinity();
};

}  // namespace catena::field
