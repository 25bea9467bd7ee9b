// SPDX-License-Identifier: MIT
/// A scalar field in bricks and resolution levels: one channel at one time of a data set that may be larger than memory. Paging for
/// rendering, snapshots for haptics, light and derived fields read data through this interface.
///   level 0   full resolution; each further level is coarser, with its own size and mapping
///   brick     kBrickEdge^3 voxels, fewer at the far faces; no voxel belongs to two bricks
///   values    of the stored number type, in native byte order, x fastest
#pragma once
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "engine/base/result.h"
#include "engine/field/cell.h"
#include "engine/field/mapping.h"
#include "engine/field/number_type.h"

namespace catena::field {

/// Edge of a brick, voxels.
inline constexpr int kBrickEdge = 64;

/// A resolution level.
struct BrickLevel {
  Index3 size{0, 0, 0};  ///< Voxels along x, y, z.
  Mapping mapping;       ///< World from index, at voxel centers.
};

/// Range of the finite values of a brick, as far as it is known without reading the brick.
struct BrickRange {
  bool is_known = false;    ///< False: min and max are not known.
  bool has_data = true;     ///< False: nothing is stored, every voxel has the fill value.
  double min = 0, max = 0;  ///< min > max: no value is finite.
};

/// Returns the number of bricks along each axis of a level.
inline Index3 brick_counts(const BrickLevel& level) {
  const auto count = [](int voxels) { return (voxels - 1) / kBrickEdge + 1; };
  return {count(level.size.x), count(level.size.y), count(level.size.z)};
}

/// Returns the number of voxels along each axis of a brick.
inline Index3 brick_size(const BrickLevel& level, const Index3& brick) {
  const auto edge = [](int voxels, int at) { return voxels - at * kBrickEdge < kBrickEdge ? voxels - at * kBrickEdge : kBrickEdge; };
  return {edge(level.size.x, brick.x), edge(level.size.y, brick.y), edge(level.size.z, brick.z)};
}

/// Returns the number of bricks of a level with `counts` along each axis.
inline std::uint64_t brick_count(const Index3& counts) {
  return static_cast<std::uint64_t>(counts.x) * static_cast<std::uint64_t>(counts.y) * static_cast<std::uint64_t>(counts.z);
}

/// Returns the number of a brick among `counts` bricks along each axis, x fastest.
inline std::uint64_t brick_number(const Index3& counts, const Index3& brick) {
  const auto wide = [](std::int32_t n) { return static_cast<std::uint64_t>(n); };
  return (wide(brick.z) * wide(counts.y) + wide(brick.y)) * wide(counts.x) + wide(brick.x);
}

/// Returns the brick with a number.
inline Index3 brick_at(const Index3& counts, std::uint64_t number) {
  const auto nx = static_cast<std::uint64_t>(counts.x), ny = static_cast<std::uint64_t>(counts.y);
  return {static_cast<std::int32_t>(number % nx), static_cast<std::int32_t>(number / nx % ny), static_cast<std::int32_t>(number / nx / ny)};
}

/// Source of bricks; immutable, apart from what is known of their ranges. Any thread.
class BrickSource {
 public:
  BrickSource(const NumberType& type, std::vector<BrickLevel> levels) : type_(type), levels_(std::move(levels)) {}
  virtual ~BrickSource() = default;
  BrickSource(const BrickSource&) = delete;
  BrickSource& operator=(const BrickSource&) = delete;

  /// Returns the number type of the values.
  const NumberType& type() const { return type_; }
  /// Returns the levels, the finest first; at least one.
  const std::vector<BrickLevel>& levels() const { return levels_; }
  /// Returns what is known of a brick's range; reads and waits for nothing.
  virtual BrickRange range(int level, const Index3& brick) const noexcept = 0;
  /// Returns how many voxels of a level are decoded for each voxel of a brick that is read alone.
  virtual double decoded_voxels(int /*level*/) const noexcept { return 1; }
  /// Finds the bricks of a level for which nothing is stored, so that their ranges are known. Blocks. The Error is a complete message.
  virtual Outcome find_empty_bricks(int /*level*/) const { return Done{}; }
  /// Reads all voxels of a brick; `values` has exactly their bytes. Where the store has none, the fill value is written. Blocks. The Error
  /// is a complete message.
  virtual Outcome read(int level, const Index3& brick, std::span<std::byte> values) const = 0;

 private:
  NumberType type_;
  std::vector<BrickLevel> levels_;
};

}  // namespace catena::field
