// SPDX-License-Identifier: MIT
/// Connected parts of the voxels at or above a level. Two voxels are connected if they share a face (6 neighbors), or a face, an edge or a
/// corner (26 neighbors). Not for the haptic tick; any thread. Results do not depend on the number of threads.
///
/// Runs of voxels along x are joined by union-find (path halving), in linear time. Memory: 20 bytes per run and 8 bytes per row of voxels;
/// at most 10 bytes per voxel, for a checkerboard. It is checked against the memory budget.
#pragma once
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "engine/base/export.h"
#include "engine/field/measure/voxels.h"

namespace catena::field {

/// Voxels that are connected to a voxel.
enum class Neighbors : int {
  faces = 6,  ///< those with a common face
  all = 26    ///< those with a common face, edge or corner
};

/// Voxels first..last of a row, and the number of their part.
struct PartRun {
  std::int32_t first = 0, last = 0;  ///< x in index space
  std::uint32_t part = 0;            ///< number in MeasuredParts::parts
};

/// Runs of all parts, in the order of the voxels.
struct CATENA_EXPORT PartMap {
  VoxelBox box;                           ///< box of the grid
  std::vector<std::uint64_t> row_starts;  ///< first run of each row, with the number of runs at the end
  std::vector<PartRun> runs;              ///< runs of all rows

  /// Runs of one row.
  std::span<const PartRun> row(std::int32_t y, std::int32_t z) const {
    const std::size_t n = static_cast<std::size_t>(z - box.lo.z) * box.size.y + static_cast<std::size_t>(y - box.lo.y);
    return std::span(runs).subspan(row_starts[n], row_starts[n + 1] - row_starts[n]);
  }
  /// Returns the part that contains a voxel of the index space.
  std::optional<std::uint32_t> part_at(const Index3& voxel) const;
};

/// Parts in the order of their size, of equal ones that with the first voxel first.
struct MeasuredParts {
  std::vector<RegionStats> parts;  ///< the largest ones
  RegionStats others;              ///< all smaller parts together
  std::uint64_t count = 0;         ///< number of all parts
  LeftOut left_out;                ///< voxels that do not count
  PartMap map;                     ///< part numbers as in `parts`; parts.size() stands for the others
};

/// Measures the parts at or above `level`. `values`: the field of the statistics, null for the grid itself; `max_parts`: number of parts
/// with their own statistics, at least 1. Error (a message fragment): no voxel reaches the level, there are 2^32 runs, or the memory
/// budget is too small.
CATENA_EXPORT Result<MeasuredParts> measure_parts(const ScalarGrid& grid, double level, Neighbors neighbors, std::size_t max_parts,
                                                  const ScalarField* values);

}  // namespace catena::field
