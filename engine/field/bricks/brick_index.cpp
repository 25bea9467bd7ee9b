// SPDX-License-Identifier: MIT
#include "engine/field/bricks/brick_index.h"

#include <bit>
#include <cmath>
#include <cstring>
#include <limits>
#include <utility>

namespace catena::field {
namespace {

/// Returns the nearest 32-bit float that is not above the value, or not below it.
float round_outward(double value, bool is_upper) {
  constexpr float kFloatInfinity = std::numeric_limits<float>::infinity(), kMax = std::numeric_limits<float>::max();
  if (std::isfinite(value) && std::fabs(value) > static_cast<double>(kMax))
    return value > 0 ? (is_upper ? kFloatInfinity : kMax) : (is_upper ? -kMax : -kFloatInfinity);
  const auto near = static_cast<float>(value);
  if (is_upper && static_cast<double>(near) < value) return std::nextafter(near, kFloatInfinity);
  if (!is_upper && static_cast<double>(near) > value) return std::nextafter(near, -kFloatInfinity);
  return near;
}

}  // namespace

std::uint32_t brick_checksum(std::size_t voxel_bytes, std::span<const std::byte> values, const Index3& size, const Index3& stored) {
  constexpr std::uint64_t kFactor = 0x9E3779B97F4A7C15ull;
  constexpr int kShift = 29;
  std::uint64_t hash = kFactor;
  const auto add = [&](std::uint64_t word) {
    hash = (hash ^ word) * kFactor;
    hash ^= hash >> kShift;
  };
  const std::size_t row_bytes = static_cast<std::size_t>(size.x) * voxel_bytes;
  for (int z = 0; z < size.z; ++z)
    for (int y = 0; y < size.y; ++y) {
      const std::size_t row = static_cast<std::size_t>(z) * static_cast<std::size_t>(stored.y) + static_cast<std::size_t>(y);
      const std::byte* from = values.data() + row * static_cast<std::size_t>(stored.x) * voxel_bytes;
      std::uint64_t word = 0;
      std::size_t at = 0;
      for (; at + sizeof word <= row_bytes; at += sizeof word) {
        std::memcpy(&word, from + at, sizeof word);
        add(word);
      }
      word = 0;
      if (at < row_bytes) {
        std::memcpy(&word, from + at, row_bytes - at);
        add(word);
      }
    }
  const auto folded = static_cast<std::uint32_t>(hash ^ (hash >> 32));
  return folded == 0 ? 1 : folded;
}

LevelIndex::LevelIndex(const Index3& counts, std::vector<std::uint64_t> bits) : counts_(counts), bits_(std::move(bits)) {
  std::uint32_t count = 0;
  before_.reserve(bits_.size());
  for (const std::uint64_t word : bits_) {
    before_.push_back(count);
    count += static_cast<std::uint32_t>(std::popcount(word));
  }
  constexpr float kUnknown = std::numeric_limits<float>::quiet_NaN();
  entries_.assign(count, {kUnknown, kUnknown});
}

LevelIndex::LevelIndex(const Index3& counts, const std::function<bool(std::uint64_t)>& has_data)
    : LevelIndex(counts, [&] {
        const std::uint64_t bricks = brick_count(counts);
        std::vector<std::uint64_t> bits((bricks + 63) / 64);
        for (std::uint64_t number = 0; number < bricks; ++number)
          if (has_data(number)) bits[number / 64] |= std::uint64_t{1} << (number % 64);
        return bits;
      }()) {}

std::vector<LevelIndex> LevelIndex::from_parts(const Index3& counts, std::vector<std::uint64_t> bits, std::vector<Entry> entries,
                                               std::vector<std::uint32_t> checksums) {
  const std::uint64_t bricks = brick_count(counts);
  if (bits.size() != (bricks + 63) / 64) return {};
  if (bricks % 64 != 0 && bits.back() >> (bricks % 64) != 0) return {};
  LevelIndex index(counts, std::move(bits));
  if (index.entries_.size() != entries.size() || !(checksums.empty() || checksums.size() == entries.size())) return {};
  index.entries_ = std::move(entries);
  index.checksums_ = std::move(checksums);
  return {std::move(index)};
}

std::size_t LevelIndex::place(std::uint64_t number) const noexcept {
  const std::uint64_t lower = bits_[number / 64] & ((std::uint64_t{1} << (number % 64)) - 1);
  return before_[number / 64] + static_cast<std::size_t>(std::popcount(lower));
}

void LevelIndex::set(std::uint64_t number, const BrickRange& range, std::uint32_t checksum) {
  if (!has_data(number)) return;
  Entry& entry = entries_[place(number)];
  if (checksum != 0) {
    checksums_.resize(entries_.size());
    checksums_[place(number)] = checksum;
  }
  if (range.is_known) entry.min = round_outward(range.min, false), entry.max = round_outward(range.max, true);
}

BrickRange LevelIndex::range(const Index3& brick, double fill_value) const noexcept {
  const std::uint64_t number = brick_number(counts_, brick);
  if (!has_data(number)) return {true, false, fill_value, fill_value};
  const Entry& known = entry(number);
  if (std::isnan(known.min)) return {};
  return {true, true, known.min, known.max};
}

BrickRange BrickIndex::range(int level, const Index3& brick) const noexcept {
  const int at = level - first_level;
  if (at < 0 || at >= static_cast<int>(levels.size())) return {};
  return levels[static_cast<std::size_t>(at)].range(brick, fill_value);
}

std::uint64_t BrickIndex::bytes() const {
  std::uint64_t bytes = 0;
  for (const LevelIndex& level : levels)
    bytes += level.bits().size() * (sizeof(std::uint64_t) + sizeof(std::uint32_t)) + level.entries().size() * sizeof(LevelIndex::Entry) +
             level.checksums().size() * sizeof(std::uint32_t);
  return bytes;
}

}  // namespace catena::field
