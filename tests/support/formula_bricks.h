// SPDX-License-Identifier: MIT
/// Bricks of a formula, rounded to 16-bit integers, with two levels; and the same voxels as a grid that is in memory as a whole.
#pragma once
#include <atomic>
#include <chrono>
#include <cmath>
#include <cstring>
#include <functional>
#include <thread>

#include "engine/field/bricks/paged_grid.h"
#include "engine/field/grid/grid_from_slices.h"
#include "tests/support/results.h"

namespace catena::test {

/// Value at a world position, 0 to 65535.
using Formula = std::function<double(const Vec3&)>;

class FormulaBricks final : public field::BrickSource {
 public:
  /// Level 0 has `size` voxels with the edge `spacing`, the first at the origin; level 1 every second of them, between its neighbors.
  FormulaBricks(const field::Index3& size, double spacing, const Formula& formula)
      : BrickSource(*field::find_number_type("uint16"), levels_of(size, spacing)) {
    for (const field::BrickLevel& level : levels()) {
      std::vector<std::uint16_t>& values = voxels_.emplace_back();
      for (int z = 0; z < level.size.z; ++z)
        for (int y = 0; y < level.size.y; ++y)
          for (int x = 0; x < level.size.x; ++x)
            values.push_back(static_cast<std::uint16_t>(std::lround(formula(level.mapping.world_from_index(Vec3(x, y, z))))));
    }
  }

  field::BrickRange range(int, const field::Index3&) const noexcept override { return {}; }
  Outcome read(int level, const field::Index3& brick, std::span<std::byte> values) const override {
    if (latency_us > 0) std::this_thread::sleep_for(std::chrono::microseconds(latency_us));
    ++reads;
    if (fails || (breaks && breaks(level, brick))) return Error{"formula: the disk is gone"};
    const field::Index3 n = brick_size(levels()[static_cast<std::size_t>(level)], brick);
    const std::size_t row = static_cast<std::size_t>(n.x) * sizeof(std::uint16_t);
    std::byte* to = values.data();
    for (int z = 0; z < n.z; ++z)
      for (int y = 0; y < n.y; ++y, to += row) std::memcpy(to, &voxel(level, brick.x * 64, brick.y * 64 + y, brick.z * 64 + z), row);
    return Done{};
  }

  /// Returns a level as a grid in memory.
  std::shared_ptr<const field::ScalarGrid> whole(int level) const {
    const field::BrickLevel& of = levels()[static_cast<std::size_t>(level)];
    const auto read = [&](int z, std::span<float> out) {
      for (std::size_t i = 0; i < out.size();) {
        for (int y = 0; y < of.size.y; ++y)
          for (int x = 0; x < of.size.x; ++x) out[i++] = voxel(level, x, y, z);
        ++z;
      }
    };
    const field::AnyField made = value_of(field::make_grid_from_slices("formula", of.mapping, {of.size, false, read}));
    return std::static_pointer_cast<const field::ScalarGrid>(made.scalar);
  }

  std::atomic<int> latency_us = 0;                                    ///< time that a read takes
  std::atomic<bool> fails = false;                                    ///< reads fail
  std::function<bool(int level, const field::Index3& brick)> breaks;  ///< reads of a brick fail; set before the first one
  mutable std::atomic<int> reads = 0;                                 ///< number of reads

 private:
  static std::vector<field::BrickLevel> levels_of(const field::Index3& n, double spacing) {
    return {{n, field::Mapping::from_linear(Mat3(spacing), Vec3(0.0))},
            {{(n.x + 1) / 2, (n.y + 1) / 2, (n.z + 1) / 2}, field::Mapping::from_linear(Mat3(2 * spacing), Vec3(0.5 * spacing))}};
  }
  const std::uint16_t& voxel(int level, int x, int y, int z) const {
    const field::Index3& n = levels()[static_cast<std::size_t>(level)].size;
    return voxels_[static_cast<std::size_t>(level)][static_cast<std::size_t>(x + n.x * (y + n.y * z))];
  }

  std::vector<std::vector<std::uint16_t>> voxels_;  ///< of each level, x fastest
};

/// Returns all of level 0, over level 1.
inline std::shared_ptr<const field::PagedGrid> make_paged(const std::shared_ptr<const FormulaBricks>& source) {
  const field::BrickLevel& finest = source->levels().front();
  return std::make_shared<const field::PagedGrid>(source, field::PagedGrid::Part{{0, 0, 0}, finest.size, finest.mapping}, source->whole(1));
}

/// Returns a snapshot of bricks of a paged grid.
inline field::BrickSnapshot make_snapshot(const field::PagedGrid& grid, const std::vector<field::Index3>& bricks,
                                          std::uint64_t number = 1) {
  std::vector<field::StoredBrick> stored;
  for (const field::Index3& brick : bricks) stored.push_back({grid.brick_id(brick), value_of(grid.read(brick))});
  return {number, stored};
}

}  // namespace catena::test
