/// Private to resampling: one cell after the other with its values, random places inside cells with VTK's value there, and what the
/// differences at them come to.
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

inline constexpr double kInsideTolerance = 1e-9;  ///< of a voxel: rounding

std::size_t component_count(const std::vector<CellValues>& blocks);

/// Work on one cell of a block after the other; what a cell needs is allocated once.
class CellSampler {
 public:
  explicit CellSampler(const CellValues& block) : block_(block), components_(block.values->GetNumberOfComponents()) {}

  /// False: it has no volume, or too many points.
  bool set_cell(vtkIdType id);

  const double* bounds() const { return bounds_; }
  Vec3 min_corner() const { return {bounds_[0], bounds_[2], bounds_[4]}; }
  Vec3 max_corner() const { return {bounds_[1], bounds_[3], bounds_[5]}; }

  /// Whether p lies inside; sets its distance (squared) from the cell.
  bool contains(const Vec3& p, double& distance2);
  /// The same without VTK's tolerance, which is a thousandth of the cell.
  bool strictly_inside() const { return strictly_inside_; }
  /// A place of the cell, the nearest to what inside() was asked for last as far as VTK finds it.
  const Vec3& closest_point() const { return closest_point_; }
  /// The cell's points, moved a little toward their middle.
  template <class Visit>
  void for_each_corner(const Visit& visit) const;
  /// The cell's interpolation at the place last asked for; outside continued, and held back.
  void interpolate(bool was_inside, double* out);

 private:
  static constexpr int kMaxPoints = 216;               ///< of a cell: a hexahedron of order 5
  static constexpr double kExtrapolationLimit = 0.25;  ///< of its range: how far its polynomial may go beyond it

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
  double min_value_ = 0, max_value_ = 0;  ///< of its values
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

/// Which places are inside the cells.
class CellFinder {
 public:
  explicit CellFinder(const std::vector<CellValues>& blocks);
  bool contains(const Vec3& p) { return find_cell(p).second >= 0; }
  /// Block and cell; the cell is -1 where there is none.
  std::pair<std::size_t, vtkIdType> find_cell(const Vec3& p);

 private:
  std::vector<vtkSmartPointer<vtkStaticCellLocator>> locators_;
};

/// Random places of a box, and what becomes of them on a grid.
class BoxSamples {
 public:
  BoxSamples(CellFinder& within, const Vec3& lo, const Vec3& hi, std::uint64_t seed);
  /// The share of the box in the middle of gaps that cells of a lattice fill.
  double gap_fill_share(const ResampleGrid& lattice) const;
  ResampleShares shares(const ResampleGrid& lattice, const std::vector<std::uint8_t>& cells) const;

 private:
  struct Sample {
    Vec3 position;
    bool is_inside;
  };
  /// CellCache lie on both sides of a place along an axis, kNarrowGapVoxels voxels apart at most, and neither much nearer than the other.
  bool is_in_narrow_gap(const Vec3& p, int axis, double voxel) const;

  CellFinder& cell_finder_;
  std::vector<Sample> samples_;
};

/// Random places inside random cells, the same for the same seed, and what errors there are told in.
class CellSamples {
 public:
  static constexpr int kSampleCount = 20'000;
  struct Sample {
    std::size_t block;
    vtkIdType cell;
    Vec3 position;
    std::array<double, 3> value;
  };

  CellSamples(const std::vector<CellValues>& blocks, std::uint64_t seed);
  const std::vector<Sample>& samples() const { return samples_; }
  /// Where the least and the greatest value are (of vectors the greatest length): at a point of a cell, moved a little into it.
  const std::vector<Sample>& extremes() const { return extremes_; }
  /// That errors are told in: of scalars; of vectors up to the largest length.
  const DisplayRange& range() const { return range_; }
  /// The cell below a place, and where in it; false outside of the lattice.
  static bool locate_voxel_cell(const ResampleGrid& lattice, const Vec3& p, int (&base)[3], double (&t)[3]);

  /// Of the trilinear interpolation of eight corners: `corner(place, base, k, value)` gives the k-th of the lattice cell at `base`, false
  /// where it has none. Every `every`-th of the places is looked at.
  template <class Corner>
  ResampleError measure_error(const ResampleGrid& lattice, const std::vector<Sample>& places, std::size_t every,
                              const Corner& corner) const;

 private:
  double difference(const double* a, const std::array<double, 3>& b) const;
  ResampleError summarize_errors(std::vector<double>& errors) const;

  std::size_t components_;
  std::vector<Sample> samples_, extremes_;
  DisplayRange range_;
};

template <class Corner>
ResampleError CellSamples::measure_error(const ResampleGrid& lattice, const std::vector<Sample>& places, std::size_t every,
                                         const Corner& corner) const {
  std::vector<double> errors;
  for (std::size_t i = 0; i < places.size(); i += every) {
    const Sample& place = places[i];
    int base[3];
    double t[3], sum[3] = {0, 0, 0};
    bool good = locate_voxel_cell(lattice, place.position, base, t);
    for (int k = 0; k < 8 && good; ++k) {
      double value[3] = {0, 0, 0}, weight = 1;
      good = corner(place, base, k, value);
      for (int a = 0; a < 3; ++a) weight *= (k >> a & 1) != 0 ? t[a] : 1 - t[a];
      for (std::size_t c = 0; c < components_; ++c) sum[c] += weight * value[c];
    }
    if (good) errors.push_back(difference(sum, place.value));
  }
  return summarize_errors(errors);
}

}  // namespace catena::vtk
