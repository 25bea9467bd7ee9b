// SPDX-License-Identifier: MIT
/// Private to resampling: evaluates single cells, samples random positions in cells with VTK's interpolated values, and measures the
/// resampling error at them.
#pragma once
#include <vtkGenericCell.h>
#include <vtkNew.h>
#include <vtkPoints.h>
#include <vtkSmartPointer.h>
#include <vtkStaticCellLocator.h>

#include <array>
#include <cstdint>
#include <utility>
#include <vector>

#include "engine/io/vtk/resample.h"

namespace catena::vtk {

inline constexpr double kInsideTolerance = 1e-9;  ///< Tolerance for rounding, voxels.

/// Number of components of the values.
std::size_t component_count(const std::vector<CellValues>& blocks);

/// Evaluates one cell of a block at a time; buffers are allocated once. Not thread-safe.
class CellSampler {
 public:
  explicit CellSampler(const CellValues& block) : block_(block), components_(block.values->GetNumberOfComponents()) {}

  /// Selects a cell. Returns false when it has no volume, or too many points.
  bool set_cell(vtkIdType id);

  /// Bounding box of the cell: x min, x max, y min, ...
  const double* bounds() const { return bounds_; }
  Vec3 min_corner() const { return {bounds_[0], bounds_[2], bounds_[4]}; }
  Vec3 max_corner() const { return {bounds_[1], bounds_[3], bounds_[5]}; }

  /// Returns whether p lies inside, with VTK's tolerance; `distance2`: receives the squared distance from the cell.
  bool contains(const Vec3& p, double& distance2);
  /// Returns whether the last contains() found p inside without VTK's tolerance, which is a thousandth of the cell.
  bool strictly_inside() const { return strictly_inside_; }
  /// Point of the cell nearest to the p of the last contains(), as found by VTK.
  const Vec3& closest_point() const { return closest_point_; }
  /// Calls visit() for the center of the cell, and for its points, moved 2 % toward the center.
  template <class Visit>
  void for_each_corner(const Visit& visit) const;
  /// Interpolates at the p of the last contains(); outside, the polynomial is extrapolated and clamped.
  void interpolate(bool was_inside, double* out);

 private:
  static constexpr int kMaxPoints = 216;  ///< Maximum number of points of a cell: a hexahedron of order 5.
  /// Maximum distance of an extrapolated value from the range of the cell's values, as a fraction of this range.
  static constexpr double kExtrapolationLimit = 0.25;

  CellValues block_;
  std::size_t components_;
  vtkNew<vtkGenericCell> cell_;
  double bounds_[6]{};
  std::vector<double> values_;
  std::array<double, kMaxPoints> weights_{};
  double parametric_[3]{};
  Vec3 closest_point_{0.0};
  bool strictly_inside_ = false;
  int sub_id_ = 0;
  double min_value_ = 0, max_value_ = 0;  ///< Range of the cell's values.
};

template <class Visit>
void CellSampler::for_each_corner(const Visit& visit) const {
  const vtkIdType n = cell_->GetNumberOfPoints();
  Vec3 middle(0.0);
  double p[3];
  for (vtkIdType i = 0; i < n; ++i) {
    cell_->GetPoints()->GetPoint(i, p);
    middle += Vec3(p[0], p[1], p[2]) * (1.0 / static_cast<double>(n));
  }
  constexpr double kInward = 0.02;
  visit(middle);
  for (vtkIdType i = 0; i < n; ++i) {
    cell_->GetPoints()->GetPoint(i, p);
    const Vec3 corner(p[0], p[1], p[2]);
    visit(corner + (middle - corner) * kInward);
  }
}

/// Finds the cell that contains a position.
class CellFinder {
 public:
  /// Builds a locator for each block.
  explicit CellFinder(const std::vector<CellValues>& blocks);
  bool contains(const Vec3& p) { return find_cell(p).second >= 0; }
  /// Returns block and cell; cell -1: p is in no cell.
  std::pair<std::size_t, vtkIdType> find_cell(const Vec3& p);

 private:
  std::vector<vtkSmartPointer<vtkStaticCellLocator>> locators_;
};

/// Random positions in a box, and their classification by a sampling grid.
class BoxSamples {
 public:
  BoxSamples(CellFinder& within, const Vec3& lo, const Vec3& hi, std::uint64_t seed);
  /// Fraction of the positions in the middle of narrow gaps that would be filled by cells of a sampling grid.
  double gap_fill_share(const ResampleGrid& lattice) const;
  /// Misclassified fractions of the box, for a sampling grid with these valid cells.
  ResampleShares shares(const ResampleGrid& lattice, const std::vector<std::uint8_t>& cells) const;

 private:
  struct Sample {
    Vec3 position;
    bool is_inside;
  };
  /// Returns whether there are cells on both sides of p along the axis, at most kNarrowGapVoxels voxels apart, with p near the middle
  /// between them.
  bool is_in_narrow_gap(const Vec3& p, int axis, double voxel) const;

  CellFinder& cell_finder_;
  std::vector<Sample> samples_;
};

/// Random positions inside random cells, deterministic for a seed, and the range to which errors are related.
class CellSamples {
 public:
  static constexpr int kSampleCount = 20'000;
  /// A sampled position and VTK's value there.
  struct Sample {
    std::size_t block;
    vtkIdType cell;
    Vec3 position;
    std::array<double, 3> value;
  };

  CellSamples(const std::vector<CellValues>& blocks, std::uint64_t seed);
  const std::vector<Sample>& samples() const { return samples_; }
  /// Positions of the minimum and the maximum value (of vectors: of the length): at a point of a cell, moved slightly inward.
  const std::vector<Sample>& extremes() const { return extremes_; }
  /// Range to which errors are related: of the scalars; of vectors from 0 to the largest length.
  const DisplayRange& range() const { return range_; }
  /// Finds the grid cell that contains p: its base voxel and the position inside it, 0 to 1. Returns false outside of the grid.
  static bool locate_voxel_cell(const ResampleGrid& lattice, const Vec3& p, int (&base)[3], double (&t)[3]);

  /// Error of the trilinear interpolation in grid cells: `corner(sample, base, k, value)` gives the value at corner k of the grid cell at
  /// `base`, and returns false if there is none. Uses every `every`-th of the positions.
  template <class Corner>
  ResampleError measure_error(const ResampleGrid& lattice, const std::vector<Sample>& samples, std::size_t every,
                              const Corner& corner) const;

 private:
  double difference(const double* a, const std::array<double, 3>& b) const;
  ResampleError summarize_errors(std::vector<double>& errors) const;

  std::size_t components_;
  std::vector<Sample> samples_, extremes_;
  DisplayRange range_;
};

template <class Corner>
ResampleError CellSamples::measure_error(const ResampleGrid& lattice, const std::vector<Sample>& samples, std::size_t every,
                                         const Corner& corner) const {
  std::vector<double> errors;
  for (std::size_t i = 0; i < samples.size(); i += every) {
    const Sample& sample = samples[i];
    int base[3];
    double t[3], sum[3] = {0, 0, 0};
    bool is_valid = locate_voxel_cell(lattice, sample.position, base, t);
    for (int k = 0; k < 8 && is_valid; ++k) {
      double value[3] = {0, 0, 0}, weight = 1;
      is_valid = corner(sample, base, k, value);
      for (int a = 0; a < 3; ++a) weight *= (k >> a & 1) != 0 ? t[a] : 1 - t[a];
      for (std::size_t c = 0; c < components_; ++c) sum[c] += weight * value[c];
    }
    if (is_valid) errors.push_back(difference(sum, sample.value));
  }
  return summarize_errors(errors);
}

}  // namespace catena::vtk
