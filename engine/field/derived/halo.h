/// Halo: values in place of the samples that a cubic cell needs and the data does not have. Missing is what lies beyond the box of
/// voxels, what a mask of voxels takes away, and what is not finite (a mask of cells takes away none: samples beyond such a hole count);
/// along an axis of one layer nothing is. Each missing sample beside a present one (26 neighbours) has one ghost, made once, so that every
/// cell that needs it reads the same value:
///   g = 3 s1 - 3 s2 + s3,  2 s1 - s2,  or  s1      by the present samples s1, s2, s3 that follow it in a row (Keys, 1981)
/// the mean over the rows along the axes that have most of them; where no neighbour along an axis is present, over the diagonals of
/// two axes, then of three. Held within one range of the data beyond its own. Polynomials of second degree are continued exactly.
/// Made off the tick, on all cores, the same for any number of threads.
#pragma once
#include "engine/base/result.h"
#include "engine/field/grid/grid_storage.h"

namespace catena::field {

template <class T>
struct HaloGrid {
  NanoMemory memory;
  const nanovdb::NanoGrid<T>* grid = nullptr;  ///< active where a ghost is
};

struct ScalarGrid::Halo : HaloGrid<float> {};
struct VectorGrid::Halo : HaloGrid<nanovdb::Vec3f> {};

/// An error (one phrase) where there is no memory for them, or the box has more than kMaxHaloBlocks blocks of 8^3 voxels.
inline constexpr double kMaxHaloBlocks = 1 << 24;
template <class T>
Result<HaloGrid<T>> make_halo(const GridStorage<T>& storage, const GridStats& stats);

}  // namespace catena::field
