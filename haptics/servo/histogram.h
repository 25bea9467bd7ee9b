/// How long something took, counted in buckets of equal ratio: fixed size, no allocation, readable while it is being filled.
///   below 128 ns: one bucket a nanosecond;  above: 128 buckets an octave, each 1/128 of its start wide, up to 2^40 ns
/// A quantile is the middle of its bucket: at most 1/256 (0.4 %) off. The maximum is exact.
/// One writer (the haptic thread), any number of readers; all relaxed atomics, nobody waits.
#pragma once
#include <array>
#include <atomic>
#include <cstdint>
#include <vector>

namespace catena::haptics {

/// What is told of a histogram, microseconds. The q-quantile as in engine/base/quantile.h.
struct HistogramFigures {
  std::uint64_t count = 0;
  double p50_us = 0, p99_us = 0, p999_us = 0, max_us = 0;
  /// For a drawing: 8 an octave, those that are not empty, each from here to the next place of the scale.
  struct Bin {
    double from_us;
    std::uint64_t count;
  };
  std::vector<Bin> bins = {};
};

class Histogram {
 public:
  void add(std::int64_t ns) noexcept;  ///< writer's thread; a negative time counts as 0
  HistogramFigures figures() const;    ///< any thread but the writer's

 private:
  static constexpr int kSubBits = 7, kTopBit = 40;
  static constexpr std::uint64_t kSub = std::uint64_t{1} << kSubBits;
  static constexpr std::size_t kBuckets = kSub * (kTopBit - kSubBits + 1);
  static std::size_t bucket(std::uint64_t ns) noexcept;
  static double first_ns(std::size_t bucket);
  static double middle_ns(std::size_t bucket);

  static_assert(std::atomic<std::uint64_t>::is_always_lock_free);
  std::array<std::atomic<std::uint64_t>, kBuckets> counts_{};
  std::atomic<std::uint64_t> max_ns_{0};
};

}  // namespace catena::haptics
