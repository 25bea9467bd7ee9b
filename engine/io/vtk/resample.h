/// Values on cells of any shape and order become a regular grid with a mask.
///   h       edges of the voxels along x, y, z: the median extents of the cells, made finer by one factor until the error is small
///           enough, the grid as large as it may be, or finer voxels do not help
///           A place in the middle of a gap, with cells on both sides along an axis, kNarrowGapVoxels voxels apart at most, is to have no
///           value: where more than kMaxGapShare of the box is such and has one, and where a cell smaller than a voxel holds the least or
///           the greatest value, voxels are made finer still, as far as there is room
///   cells   a cell of the grid is valid where it overlaps a cell of the data: where its centre, a place beside a corner, or the nearest
///   place
///           of a cell to one of these lies in both. So values end within a voxel of the last cell
///   value   at each voxel centre inside a cell: VTK's interpolation in that cell. Voxels that touch such a one: straight on from those
///           behind it, 2 v(1) - v(2), on average over the directions. Where cells are thinner than voxels: the nearest cell's
///           polynomial, a quarter of its range beyond it at most
///   error   |grid - VTK's interpolation| at random places inside random cells (each as likely, places evenly within it), fixed seed:
///           99th percentile and maximum, in % of the range of the values without outliers (vectors: of the largest length). Foreseen at
///           other places than it is measured at; where the measure says more, the grid is made again, finer
///   places  random ones of the whole box: the share that is outside the cells and in a valid cell of the grid, and the reverse
/// One thread; the same for the same cells and the same `most_voxels`.
#pragma once
#include <vtkDataArray.h>
#include <vtkDataSet.h>

#include <vector>

#include "engine/base/display_range.h"
#include "engine/base/result.h"
#include "engine/base/vec.h"
#include "engine/io/volume/load_field.h"

namespace catena::vtk {

/// One block: cells with a volume that are data, and values at their points.
struct CellValues {
  vtkDataSet* data;
  vtkDataArray* values;
};

struct ResampleGrid {
  field::Index3 size{2, 2, 2};
  Vec3 spacing{1.0}, origin{0.0};
  std::size_t voxel_count() const {
    return static_cast<std::size_t>(size.x) * static_cast<std::size_t>(size.y) * static_cast<std::size_t>(size.z);
  }
  /// Where voxel (i, j, k) stands in a list, x fastest.
  std::size_t linear_index(int i, int j, int k) const {
    return (static_cast<std::size_t>(k) * static_cast<std::size_t>(size.y) + static_cast<std::size_t>(j)) *
               static_cast<std::size_t>(size.x) +
           static_cast<std::size_t>(i);
  }
};

/// From lo to hi, both included, with edges of about so much times `factor`.
ResampleGrid make_resample_grid(const Vec3& lo, const Vec3& hi, const Vec3& edges, double factor);

struct ResampleError {
  double p99 = 0, max = 0;  ///< % of the range
};

/// Shares of the whole box.
struct ResampleShares {
  double falsely_inside = 0, falsely_outside = 0;
  double filled_gaps = 0;  ///< in the middle of gaps, and in a valid cell of the grid
};

struct ResamplePlan {
  ResampleGrid grid;
  double p99 = 0;                   ///< as foreseen
  bool meets_target = true;         ///< it is at most what was wanted
  bool refinement_stalled = false;  ///< it is not, and finer voxels did not make it smaller
};

inline constexpr double kTargetError = 1;         ///< %
inline constexpr double kUsefulErrorRatio = 0.8;  ///< of the error: what a finer grid must leave at most, else it does not help
inline constexpr double kNarrowGapVoxels = 4;     ///< voxels
inline constexpr double kMaxGapShare = 2e-4;

/// An error is a phrase: no cells with a volume, or values that are not finite.
Result<ResamplePlan> plan_resampling(const std::vector<CellValues>& blocks, double most_voxels);

struct ResampleResult {
  ResampleGrid grid;
  std::vector<float> values;        ///< components a voxel
  std::vector<std::uint8_t> valid;  ///< a byte a voxel: a corner of a valid cell
  std::vector<std::uint8_t> cells;  ///< a byte a voxel: the cell based at it is valid
  ResampleError error;
  DisplayRange range;  ///< that the error is a share of
  ResampleShares shares;
  double min_value = 0, max_value = 0;  ///< of the grid where the data have their least and their greatest value; of vectors: lengths
  double required_voxels = 0;           ///< where the error is too large: about so many would do
  bool refinement_stalled = false;      ///< it is, and finer voxels did not make it smaller
};
/// As planned, and finer where what comes of it says so.
Result<ResampleResult> resample(const std::vector<CellValues>& blocks, const ResamplePlan& plan, double most_voxels);

}  // namespace catena::vtk
