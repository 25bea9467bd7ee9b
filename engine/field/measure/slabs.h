// SPDX-License-Identifier: MIT
/// Slabs of eight slices in which measurements read a grid. Slabs run in parallel and are joined in ascending order, so that results do not
/// depend on the number of threads. Not for the haptic tick.
#pragma once
#include <span>
#include <utility>
#include <vector>

#include "engine/base/threads.h"
#include "engine/field/measure/voxels.h"

namespace catena::field {

/// Slices of a slab, and slabs whose results are in memory at one time.
inline constexpr int kSlabLayers = 8;
inline constexpr int kSlabsAtOnce = 16;

/// Writes 1 for each voxel that counts, else 0; `size` voxels from `origin`, x fastest, in the index box. `values`: those of read_block().
void read_counted(const ScalarGrid& grid, const Index3& origin, const Index3& size, std::span<const float> values,
                  std::span<std::uint8_t> counted);

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

}  // namespace catena::field
