// SPDX-License-Identifier: MIT
#include "haptics/servo/servo_stats.h"

#include <fmt/format.h>
#include <algorithm>
#include <bit>

#include "engine/base/json_text.h"

namespace catena::haptics {

std::size_t Histogram::bucket(std::uint64_t ns) noexcept {
  if (ns < kSub) return static_cast<std::size_t>(ns);
  const int octave = static_cast<int>(std::bit_width(ns)) - 1;
  if (octave >= kTopBit) return kBuckets - 1;
  const int shift = octave - kSubBits;
  return static_cast<std::size_t>(kSub * static_cast<std::uint64_t>(shift) + (ns >> shift));
}

double Histogram::first_ns(std::size_t bucket) {
  if (bucket < kSub) return static_cast<double>(bucket);
  const std::uint64_t shift = bucket / kSub - 1;
  return static_cast<double>((bucket - kSub * shift) << shift);
}

double Histogram::middle_ns(std::size_t bucket) {
  return bucket < kSub ? first_ns(bucket) : 0.5 * (first_ns(bucket) + first_ns(bucket + 1) - 1);
}

void Histogram::add(std::int64_t ns) noexcept {
  const auto value = static_cast<std::uint64_t>(std::max<std::int64_t>(0, ns));
  std::atomic<std::uint64_t>& count = counts_[bucket(value)];
  count.store(count.load(std::memory_order_relaxed) + 1, std::memory_order_relaxed);
  if (value > max_ns_.load(std::memory_order_relaxed)) max_ns_.store(value, std::memory_order_relaxed);
}

HistogramSummary Histogram::summarize() const {
  std::array<std::uint64_t, kBuckets> counts;
  HistogramSummary out;
  for (std::size_t i = 0; i < kBuckets; ++i) out.count += counts[i] = counts_[i].load(std::memory_order_relaxed);
  if (out.count == 0) return out;
  const double max_ns = static_cast<double>(max_ns_.load(std::memory_order_relaxed));
  out.max_us = 1e-3 * max_ns;
  const auto quantile_us = [&](double q) {
    const auto rank = std::min(out.count - 1, static_cast<std::uint64_t>(q * static_cast<double>(out.count)));
    std::uint64_t below = 0;
    std::size_t i = 0;
    while (i + 1 < kBuckets && below + counts[i] <= rank) below += counts[i++];
    return 1e-3 * std::min(middle_ns(i), max_ns);
  };
  out.p50_us = quantile_us(0.5);
  out.p99_us = quantile_us(0.99);
  out.p999_us = quantile_us(0.999);
  constexpr std::size_t kPerBin = kSub / 8;
  for (std::size_t i = 0; i < kBuckets; i += kPerBin) {
    HistogramSummary::Bin bin{1e-3 * first_ns(i), 0};
    for (std::size_t k = 0; k < kPerBin; ++k) bin.count += counts[i + k];
    if (bin.count > 0) out.bins.push_back(bin);
  }
  return out;
}

namespace {

std::string figures_json(const char* name, const HistogramSummary& f) {
  std::string bins;
  for (const HistogramSummary::Bin& bin : f.bins) bins += fmt::format("{}[{:.3f}, {}]", bins.empty() ? "" : ", ", bin.from_us, bin.count);
  return fmt::format(
      "  \"{}\": {{\"p50\": {:.3f}, \"p99\": {:.3f}, \"p999\": {:.3f}, \"max\": {:.3f}, \"count\": {},\n    \"bins\": [{}]}},\n", name,
      f.p50_us, f.p99_us, f.p999_us, f.max_us, f.count, bins);
}

std::string figures_line(const char* name, const HistogramSummary& f) {
  return fmt::format("  {:<8} {:>10.2f} {:>10.2f} {:>10.2f} {:>10.2f}\n", name, f.p50_us, f.p99_us, f.p999_us, f.max_us);
}

}  // namespace

std::string servo_json(const ServoStats& r, const std::string& device_name, std::uint64_t state_hash) {
  std::string notes;
  for (const std::string& note : r.realtime.notes) notes += (notes.empty() ? "" : ", ") + json_string(note);
  std::string out = fmt::format(
      "{{\n  \"device\": {},\n  \"rate_hz\": {},\n  \"seconds\": {:.6f},\n  \"ticks\": {},\n  \"missed_deadlines\": {},\n"
      "  \"late_ticks\": {},\n  \"lost_ticks\": {},\n  \"watchdog_trips\": {},\n"
      "  \"realtime\": {{\"fifo\": {}, \"locked\": {}, \"cpu\": {}, \"notes\": [{}]}},\n",
      json_string(device_name), r.rate_hz, r.seconds, r.ticks, r.missed_deadlines, r.late_ticks, r.lost_ticks, r.watchdog_trips,
      r.realtime.fifo, r.realtime.locked, r.realtime.cpu < 0 ? "null" : std::to_string(r.realtime.cpu), notes);
  out += figures_json("period_us", r.period) + figures_json("compute_us", r.compute) + figures_json("device_us", r.device);
  return out + fmt::format("  \"state_hash\": \"{:016x}\"\n}}\n", state_hash);
}

std::string servo_summary(const ServoStats& r, const std::string& device_name) {
  std::string out = fmt::format("{}: {} ticks in {:.2f} s, {} missed deadlines, {} late, {} without the device, {} watchdog trips\n",
                                device_name, r.ticks, r.seconds, r.missed_deadlines, r.late_ticks, r.lost_ticks, r.watchdog_trips);
  out += fmt::format("  {:<8} {:>10} {:>10} {:>10} {:>10}\n", "us", "p50", "p99", "p99.9", "max");
  out += figures_line("period", r.period) + figures_line("compute", r.compute) + figures_line("device", r.device);
  const std::string core = r.realtime.cpu < 0 ? "any core" : fmt::format("core {}", r.realtime.cpu);
  return out + fmt::format("  {} priority, memory {}, {}\n", r.realtime.fifo ? "real-time" : "normal",
                           r.realtime.locked ? "locked" : "not locked", core);
}

}  // namespace catena::haptics
