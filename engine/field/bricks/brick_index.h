// SPDX-License-Identifier: MIT
/// What is known of the bricks of a source without reading them: which ones have data, their ranges, and checksums of their values.
/// Memory: one and a half bits per brick; for each one with data 8 bytes, and 4 for its checksum if there is one. Lookup: constant time,
/// without allocation or lock. Immutable after it was filled; then any thread.
#pragma once
#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "engine/field/bricks/brick_source.h"

namespace catena::field {

/// Checksum of the first `size` voxels of an array of `stored` voxels of `voxel_bytes` each, x fastest.
std::uint32_t brick_checksum(std::size_t voxel_bytes, std::span<const std::byte> values, const Index3& size, const Index3& stored);

/// Index of one level.
class LevelIndex {
 public:
  /// What is known of a brick with data. The range is widened to 32-bit floats; not-a-number: it is not known. min > max: no value is
  /// finite.
  struct Entry {
    float min, max;
  };

  /// `counts`: bricks along x, y, z. `has_data`: returns whether the brick with a number has data; the ranges are not known.
  LevelIndex(const Index3& counts, const std::function<bool(std::uint64_t)>& has_data);
  /// Makes the index of stored parts. Empty: the parts do not match.
  static std::vector<LevelIndex> from_parts(const Index3& counts, std::vector<std::uint64_t> bits, std::vector<Entry> entries,
                                            std::vector<std::uint32_t> checksums);

  /// Sets what is known of a brick with data. `checksum`: brick_checksum(); 0: not known.
  void set(std::uint64_t number, const BrickRange& range, std::uint32_t checksum);
  /// Returns whether a brick has data.
  bool has_data(std::uint64_t number) const noexcept { return (bits_[number / 64] >> (number % 64) & 1) != 0; }
  /// Returns what is known of a brick that has data.
  const Entry& entry(std::uint64_t number) const noexcept { return entries_[place(number)]; }
  /// Returns the brick_checksum() of a brick that has data; 0: not known.
  std::uint32_t checksum(std::uint64_t number) const noexcept { return checksums_.empty() ? 0 : checksums_[place(number)]; }
  /// Returns the range of a brick; `fill_value`: the value of bricks without data.
  BrickRange range(const Index3& brick, double fill_value) const noexcept;

  /// Returns the number of bricks along x, y, z.
  const Index3& counts() const { return counts_; }
  /// Returns one bit per brick: has_data().
  const std::vector<std::uint64_t>& bits() const { return bits_; }
  /// Returns the entries of the bricks with data, by number.
  const std::vector<Entry>& entries() const { return entries_; }
  /// Returns the checksums of the bricks with data, by number; empty: none is known.
  const std::vector<std::uint32_t>& checksums() const { return checksums_; }

 private:
  LevelIndex(const Index3& counts, std::vector<std::uint64_t> bits);
  std::size_t place(std::uint64_t number) const noexcept;

  Index3 counts_;
  std::vector<std::uint64_t> bits_;
  std::vector<std::uint32_t> before_;  ///< Bricks with data before each 64.
  std::vector<Entry> entries_;
  std::vector<std::uint32_t> checksums_;
};

/// Index of consecutive levels of a source.
struct BrickIndex {
  int first_level = 0;    ///< Level of the source that the first index describes.
  double fill_value = 0;  ///< Value of bricks without data.
  std::vector<LevelIndex> levels;

  /// Returns what is known of a brick of the source; nothing for other levels.
  BrickRange range(int level, const Index3& brick) const noexcept;
  /// Returns the memory, bytes.
  std::uint64_t bytes() const;
};

}  // namespace catena::field
