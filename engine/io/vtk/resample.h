// SPDX-License-Identifier: MIT
/// Resamples values on cells of any shape and order to a regular grid with a mask.
///   h       voxel edges along x, y, z: the median extents of the cells, refined by a common factor until the error is small enough, the
///           grid has its maximum size, or finer voxels do not help
///           A position in the middle of a gap, with cells on both sides along an axis, at most kNarrowGapVoxels voxels apart, should have
///           no value: if more than kMaxGapShare of the box are such positions with a value, or a cell smaller than a voxel holds the
///           minimum or maximum, voxels are refined further, as far as the maximum size allows
///   cells   a cell of the grid is valid if it overlaps a cell of the data: if its center, a position near a corner, or the point of a
///           data cell nearest to one of these lies in both. Thus values end within a voxel of the outermost cell
///   value   at each voxel center inside a cell: VTK's interpolation in that cell. Voxels adjacent to such a voxel: linear extrapolation
///           from the voxels behind it, 2 v(1) - v(2), averaged over the directions. If cells are thinner than voxels: the polynomial of
///           the nearest cell, which may exceed its range by at most a quarter
///   error   |grid - VTK's interpolation| at random positions inside random cells (cells equally likely, positions uniform in the cell),
///           fixed seed: 99th percentile and maximum, in % of the range of the values without outliers (vectors: of the largest length).
///           Predicted at other positions than those where it is measured; if the measured error is larger, the grid is refined again
///   shares  at random positions in the whole box: the fraction outside the data cells but in a valid cell of the grid, and the reverse
/// One thread; deterministic for the same cells and the same `max_voxels`.
#pragma once
#include <vtkDataArray.h>
#include <vtkDataSet.h>

#include <vector>

#include "engine/base/display_range.h"
#include "engine/base/result.h"
#include "engine/base/vec.h"
#include "engine/io/volume/load_field.h"

namespace catena::vtk {

/// One block: its valid cells with a volume, and values at their points.
struct CellValues {
  vtkDataSet* data;
  vtkDataArray* values;
};

/// Size and placement of a regular grid with axes along x, y, z; world units.
struct ResampleGrid {
  field::Index3 size{2, 2, 2};
  Vec3 spacing{1.0}, origin{0.0};
  std::size_t voxel_count() const {
    return static_cast<std::size_t>(size.x) * static_cast<std::size_t>(size.y) * static_cast<std::size_t>(size.z);
  }
  /// Index of voxel (i, j, k), x fastest.
  std::size_t linear_index(int i, int j, int k) const {
    return (static_cast<std::size_t>(k) * static_cast<std::size_t>(size.y) + static_cast<std::size_t>(j)) *
               static_cast<std::size_t>(size.x) +
           static_cast<std::size_t>(i);
  }
};

/// Creates a grid from lo to hi, both included, with voxel edges of about edges * factor.
ResampleGrid make_resample_grid(const Vec3& lo, const Vec3& hi, const Vec3& edges, double factor);

/// Resampling error, over the sampled positions.
struct ResampleError {
  double p99 = 0, max = 0;  ///< In % of the range.
};

/// Misclassified positions, as fractions of the whole box.
struct ResampleShares {
  /// Outside the data but in a valid grid cell, and the reverse.
  double falsely_inside = 0, falsely_outside = 0;
  double filled_gaps = 0;  ///< In the middle of a narrow gap but in a valid grid cell.
};

/// A grid for resampling, with its predicted error.
struct ResamplePlan {
  ResampleGrid grid;
  double p99 = 0;                   ///< Predicted 99th percentile of the error, %.
  bool meets_target = true;         ///< The predicted error is at most kTargetError.
  bool refinement_stalled = false;  ///< The predicted error is larger, and finer voxels did not reduce it.
};

inline constexpr double kTargetError = 1;  ///< Target of the error, %.
/// A finer grid must reduce the error at least to this fraction, or refinement stops.
inline constexpr double kUsefulErrorRatio = 0.8;
inline constexpr double kNarrowGapVoxels = 4;  ///< Width of a narrow gap, voxels.
/// Maximum fraction of the box that may be filled narrow gaps, see above.
inline constexpr double kMaxGapShare = 2e-4;

/// Plans a grid with at most `max_voxels` voxels. Returns an Error with a message fragment when there are no cells with a volume, or
/// values or points are not finite.
Result<ResamplePlan> plan_resampling(const std::vector<CellValues>& blocks, double max_voxels);

/// A resampled grid.
struct ResampleResult {
  ResampleGrid grid;
  std::vector<float> values;        ///< All components per voxel, x fastest.
  std::vector<std::uint8_t> valid;  ///< One byte per voxel: 1 at the corners of valid cells.
  std::vector<std::uint8_t> cells;  ///< One byte per voxel: 1 if the cell based there is valid.
  ResampleError error;
  DisplayRange range;  ///< Range to which the error is related.
  ResampleShares shares;
  double min_value = 0, max_value = 0;  ///< Grid values at the positions of the data's minimum and maximum; of vectors: lengths.
  double required_voxels = 0;           ///< If the error is too large: about the number of voxels that would suffice.
  bool refinement_stalled = false;      ///< The error is too large, and finer voxels did not reduce it.
};
/// Resamples to the planned grid, or to a finer one if the measured error requires it, with at most `max_voxels` voxels.
Result<ResampleResult> resample(const std::vector<CellValues>& blocks, const ResamplePlan& plan, double max_voxels);

}  // namespace catena::vtk
