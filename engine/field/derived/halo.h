// SPDX-License-Identifier: MIT
/// Halo samples: extrapolated values for samples that a cubic cell needs and the data do not have. Missing are samples outside of the box
/// of voxels, samples excluded by a mask of voxels, and values that are not finite. A mask of cells makes no sample missing, and neither
/// does an axis with a single slice. Each missing sample that has a present one among its 26 neighbors gets one halo sample, computed once,
/// so every cell that needs it reads the same value:
///   g = 3 s1 - 3 s2 + s3,  2 s1 - s2,  or  s1      from the present samples s1, s2, s3 that follow it in a row (Keys, 1981)
/// It is the mean over the rows with the most samples along the axes; when no neighbor along an axis is present, over the diagonals in two
/// axes, then in three. Values are clamped to the range of the data extended by its length at both ends. Polynomials of second degree are
/// continued exactly. Not for the haptic tick; runs on all cores, with a result independent of the number of threads.
#pragma once
#include "engine/base/result.h"
#include "engine/field/grid/grid_storage.h"

namespace catena::field {

/// Halo samples of a grid, as a NanoVDB grid in its own memory.
template <class T>
struct HaloGrid {
  NanoMemory memory;
  const nanovdb::NanoGrid<T>* grid = nullptr;  ///< active where there is a halo sample
};

/// Halo samples of a cubic scalar grid and of a cubic vector grid.
struct ScalarGrid::Halo : HaloGrid<float> {};
struct VectorGrid::Halo : HaloGrid<nanovdb::Vec3f> {};

/// Maximum number of blocks of 8^3 voxels in the box of a grid with a halo.
inline constexpr double kMaxHaloBlocks = 1 << 24;
/// Makes the halo samples of a grid; `stats` are those of its values. Error (a message fragment without the grid's name): the memory budget
/// is exceeded, or the box has more than kMaxHaloBlocks blocks.
template <class T>
Result<HaloGrid<T>> make_halo(const GridStorage<T>& storage, const GridStats& stats);

}  // namespace catena::field
