/// Values on cells of any shape and order become a regular grid with a mask.
///   h       edges of the voxels along x, y, z: the median extents of the cells, made finer by one factor until the error is small
///           enough, the grid as large as it may be, or finer voxels do not help
///   value   at each voxel centre inside a cell: VTK's interpolation in that cell. Voxels that touch such a one: straight on from those
///           behind it, 2 v(1) - v(2), on average over the directions. Where cells are thinner than voxels: the nearest cell's
///           polynomial, a quarter of its range beyond it at most. So every place inside a cell lies in a valid cell of the grid
///   error   |grid - VTK's interpolation| at random places inside random cells (each as likely, places evenly within it), fixed seed:
///           99th percentile and maximum, in % of the range of the values (vectors: of the largest length). Foreseen at other places than
///           it is measured at; where the measure says more, the grid is made again, finer
/// One thread.
#pragma once
#include <vtkDataArray.h>
#include <vtkDataSet.h>

#include <vector>

#include "engine/base/result.h"
#include "engine/base/vec.h"
#include "engine/field/load.h"

namespace catena::vtk {

/// One block: cells, and values at their points.
struct CellValues {
  vtkDataSet* data;
  vtkDataArray* values;
};

struct Lattice {
  field::Index3 size{2, 2, 2};
  Vec3 spacing{1.0}, origin{0.0};
  std::size_t voxels() const {
    return static_cast<std::size_t>(size.x) * static_cast<std::size_t>(size.y) * static_cast<std::size_t>(size.z);
  }
  /// Where voxel (i, j, k) stands in a list, x fastest.
  std::size_t number(int i, int j, int k) const {
    return (static_cast<std::size_t>(k) * static_cast<std::size_t>(size.y) + static_cast<std::size_t>(j)) *
               static_cast<std::size_t>(size.x) +
           static_cast<std::size_t>(i);
  }
};

/// From lo to hi, both included, with edges of about so much times `factor`.
Lattice lattice_of(const Vec3& lo, const Vec3& hi, const Vec3& edges, double factor);

struct ResampleError {
  double p99 = 0, most = 0;  ///< % of the range
};

struct ResamplePlan {
  Lattice lattice;
  double p99 = 0;      ///< as foreseen
  bool fine = true;    ///< it is at most what was wanted
  bool jumps = false;  ///< it is not, and finer voxels did not make it smaller
};

inline constexpr double kWantedError = 1;  ///< %
inline constexpr double kWorthIt = 0.8;    ///< of the error: what a finer grid must leave at most, else it does not help

/// An error is a phrase: no cells with a volume, or values that are not finite.
Result<ResamplePlan> plan_resampling(const std::vector<CellValues>& blocks, double most_voxels);

struct Resampled {
  Lattice lattice;
  std::vector<float> values;        ///< components a voxel
  std::vector<std::uint8_t> valid;  ///< a byte a voxel
  ResampleError error;
  double wanted_voxels = 0;  ///< where the error is too large: about so many would do
  bool jumps = false;        ///< it is, and finer voxels did not make it smaller
};
/// As planned, and finer where what comes of it says so.
Result<Resampled> resample(const std::vector<CellValues>& blocks, double most_voxels);

}  // namespace catena::vtk
