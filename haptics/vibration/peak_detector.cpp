// SPDX-License-Identifier: MIT
#include "haptics/vibration/peak_detector.h"

#include <algorithm>
#include <bit>

#include "engine/base/result.h"

namespace catena::haptics {
namespace {

constexpr double kMinSpeed = 1e-3;  // m/s; below it the probe counts as at rest, and energy per distance is meaningless

// Packs two non-negative, finite floats; the packed values are ordered like the pairs, the first number first.
std::uint64_t packed(double first, double second) noexcept {
  const auto bits = [](double v) { return std::bit_cast<std::uint32_t>(static_cast<float>(std::min(v, 1e30))); };
  return std::uint64_t{bits(first)} << 32 | bits(second);
}

double first_of(std::uint64_t word) noexcept { return std::bit_cast<float>(static_cast<std::uint32_t>(word >> 32)); }
double second_of(std::uint64_t word) noexcept { return std::bit_cast<float>(static_cast<std::uint32_t>(word)); }

// Raises the peak. The other thread only writes zero, so if the first exchange fails, the value is zero and the second one succeeds.
void raise(std::atomic<std::uint64_t>& peak, std::uint64_t to) noexcept {
  std::uint64_t before = peak.load(std::memory_order_relaxed);
  for (int tries = 0; tries < 2 && to > before; ++tries)
    if (peak.compare_exchange_strong(before, to, std::memory_order_relaxed)) return;
}

}  // namespace

PeakDetector::PeakDetector(double rate_hz) : gain_(std::min(1.0, 1 / (rate_hz * kTau_s))) { CATENA_ASSERT(rate_hz > 0); }

void PeakDetector::add(const ForceSample& tick) noexcept {
  const double force_n = norm(tick.requested_force_n);
  if (!tick.is_live || !std::isfinite(force_n) || !is_finite(tick.position_m) || !std::isfinite(tick.accounted_j)) {
    has_previous_ = false;
    return;
  }
  if (!has_previous_) {
    has_previous_ = true;
    mean_n_ = tick.requested_force_n;
    lost_j_ = path_m_ = 0;
  } else {
    raise(change_, packed(norm(tick.requested_force_n - mean_n_), 0));
    mean_n_ += gain_ * (tick.requested_force_n - mean_n_);

    const double way_m = norm(tick.position_m - last_m_);
    lost_j_ += last_accounted_j_ - tick.accounted_j - gain_ * lost_j_;
    path_m_ += way_m - gain_ * path_m_;
    const double speed = path_m_ / kTau_s;
    if (lost_j_ > 0 && speed >= kMinSpeed) raise(friction_, packed(std::min(force_n, lost_j_ / path_m_), speed));
  }
  last_m_ = tick.position_m;
  last_accounted_j_ = tick.accounted_j;
}

ForcePeaks PeakDetector::take_peaks() noexcept {
  const std::uint64_t change = change_.exchange(0, std::memory_order_relaxed), friction = friction_.exchange(0, std::memory_order_relaxed);
  return {first_of(change), first_of(friction), second_of(friction)};
}

}  // namespace catena::haptics
