// SPDX-License-Identifier: MIT
/// Voxels of a grid that a measurement counts: active, valid where the grid has a mask, and finite. Measurements read a grid in slabs of
/// eight slices; slabs run in parallel and are joined in ascending order, so that results do not depend on the number of threads.
/// Not for the haptic tick.
#pragma once
#include <algorithm>
#include <cstdint>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "engine/base/result.h"
#include "engine/base/threads.h"
#include "engine/field/grid/grid.h"
#include "engine/field/measure/moments.h"

namespace catena::field {

/// Slices of a slab, and slabs whose results are in memory at one time.
inline constexpr int kSlabLayers = 8;
inline constexpr int kSlabsAtOnce = 16;
/// Largest box of voxels that is measured.
inline constexpr double kMaxMeasuredVoxels = 0x1p34;

/// Index box of a grid.
struct VoxelBox {
  Index3 lo, size;
  std::uint64_t voxels() const { return static_cast<std::uint64_t>(size.x) * static_cast<std::uint64_t>(size.y) * size.z; }
};
/// Returns the box of voxels. Error (a message fragment): it has more than kMaxMeasuredVoxels, or there is no memory for its slabs.
Result<VoxelBox> measurable_box(const ScalarGrid& grid);

/// Numbers of voxels that a measurement leaves out.
struct LeftOut {
  std::uint64_t masked = 0;      ///< voxels of the box that are inactive or invalid
  std::uint64_t not_finite = 0;  ///< voxels that are NaN or infinite
};
LeftOut left_out(const ScalarGrid& grid, const VoxelBox& box);

/// Writes 1 for each voxel that counts, else 0; `size` voxels from `origin`, x fastest, in the index box. `values`: those of read_block().
void read_counted(const ScalarGrid& grid, const Index3& origin, const Index3& size, std::span<const float> values,
                  std::span<std::uint8_t> counted);

/// Returns true when the voxels of two grids coincide: same box, and positions equal within 1e-4 of a voxel.
bool is_same_lattice(const Field& a, const Field& b);

/// Some slices of a grid. `values`: numbers of a second field at the voxels; NaN where it has none; empty without one.
struct VoxelSlab {
  Index3 origin, size;
  std::vector<float> voxels;
  std::vector<std::uint8_t> counted;
  std::vector<double> values;
};

/// Reads slabs of a grid and of a second field, which may be null. The second field is read voxel by voxel if both are one lattice,
/// otherwise it is interpolated at the voxel centers.
class SlabReader {
 public:
  SlabReader(const ScalarGrid& grid, const VoxelBox& box, const ScalarField* values)
      : grid_(grid), box_(box), values_(values), same_(values != nullptr && values->grid() != nullptr && is_same_lattice(grid, *values)) {}
  /// Reads `layers` slices from slice `z` of the box.
  VoxelSlab read(int z, int layers) const;

 private:
  const ScalarGrid& grid_;
  VoxelBox box_;
  const ScalarField* values_;
  bool same_;
};

/// Calls work(z, layers), which returns a Part, for all slabs of `layers` slices in parallel, and join(Part) in ascending order.
template <class Part, class Work, class Join>
void for_slabs(int slices, const Work& work, const Join& join) {
  const int slabs = (slices + kSlabLayers - 1) / kSlabLayers;
  for (int first = 0; first < slabs; first += kSlabsAtOnce) {
    std::vector<Part> parts(static_cast<std::size_t>(std::min(kSlabsAtOnce, slabs - first)));
    parallel_for(parts.size(), 1, [&](std::size_t begin, std::size_t end) {
      for (std::size_t k = begin; k < end; ++k) {
        const int z = (first + static_cast<int>(k)) * kSlabLayers;
        parts[k] = work(z, std::min(kSlabLayers, slices - z));
      }
    });
    for (Part& part : parts) join(std::move(part));
  }
}

/// What is measured of a label or a connected part.
struct RegionStats {
  std::uint64_t voxels = 0;
  Moments values;       ///< of the second field, over those of the voxels at which it has a value
  Vec3 index_sum{0.0};  ///< sum of the voxels' indices
  Index3 lo, hi;        ///< bounding box in index space, both ends included

  /// Adds the voxels first..last of the row (y, z).
  void add_run(std::int32_t first, std::int32_t last, std::int32_t y, std::int32_t z);
  void merge(const RegionStats& other);
  /// Position of the mean of the voxel centers, world.
  Vec3 centroid(const Mapping& mapping) const { return mapping.world_from_index(index_sum / static_cast<double>(voxels)); }
};

/// Volume of one voxel, cubed world units.
double voxel_volume(const Mapping& mapping);

}  // namespace catena::field
