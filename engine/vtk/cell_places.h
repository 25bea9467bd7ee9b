/// Private to resampling: one cell after the other with its values, random places inside cells with VTK's value there, and what the
/// differences at them come to.
#pragma once
#include <vtkGenericCell.h>
#include <vtkNew.h>

#include <array>
#include <cstdint>
#include <vector>

#include "engine/vtk/resample.h"

namespace catena::vtk {

inline constexpr double kInside = 1e-9;  ///< of a voxel: rounding

std::size_t components_of(const std::vector<CellValues>& blocks);
/// Of a block: blanked, or in another block, too.
bool is_hidden(vtkDataSet* data, vtkIdType cell);

/// Work on one cell of a block after the other; what a cell needs is allocated once.
class CellWork {
 public:
  explicit CellWork(const CellValues& block) : block_(block), components_(block.values->GetNumberOfComponents()) {}

  /// False: it is hidden, has no volume, or too many points.
  bool at(vtkIdType id);

  const double* bounds() const { return bounds_; }
  Vec3 lowest() const { return {bounds_[0], bounds_[2], bounds_[4]}; }
  Vec3 highest() const { return {bounds_[1], bounds_[3], bounds_[5]}; }

  /// Whether p lies inside; sets its distance (squared) from the cell.
  bool inside(const Vec3& p, double& distance2);
  /// The cell's interpolation at the place last asked for; outside continued, and held back.
  void value(bool was_inside, double* out);

 private:
  static constexpr int kMostPoints = 216;  ///< of a cell: a hexahedron of order 5
  static constexpr double kGive = 0.25;    ///< of its range: how far its polynomial may go beyond it

  CellValues block_;
  std::size_t components_;
  vtkNew<vtkGenericCell> cell_;
  double bounds_[6]{};
  std::vector<double> values_;
  std::array<double, kMostPoints> weights_{};
  double parametric_[3]{};
  int sub_id_ = 0;
  double lo_ = 0, hi_ = 0;  ///< of its values
};

/// Random places inside random cells, the same for the same seed, and what errors there are told in.
class CellPlaces {
 public:
  static constexpr int kSamples = 20'000;
  struct Place {
    std::size_t block;
    vtkIdType cell;
    Vec3 at;
    std::array<double, 3> value;
  };

  CellPlaces(const std::vector<CellValues>& blocks, std::uint64_t seed);
  const std::vector<Place>& places() const { return places_; }

  /// Of the trilinear interpolation of eight corners: `corner(place, base, k, value)` gives the k-th of the lattice cell at `base`, false
  /// where it has none. Every `every`-th place is looked at.
  template <class Corner>
  ResampleError error_on(const Lattice& lattice, std::size_t every, const Corner& corner) const;

 private:
  /// The corner below, and where between it and the one above; false outside of the lattice.
  static bool locate(const Lattice& lattice, const Vec3& p, int (&base)[3], double (&t)[3]);
  double difference(const double* a, const std::array<double, 3>& b) const;
  ResampleError error_of(std::vector<double>& errors) const;

  std::size_t components_;
  std::vector<Place> places_;
  double range_;  ///< of scalars; of vectors the largest length
};

template <class Corner>
ResampleError CellPlaces::error_on(const Lattice& lattice, std::size_t every, const Corner& corner) const {
  std::vector<double> errors;
  for (std::size_t i = 0; i < places_.size(); i += every) {
    const Place& place = places_[i];
    int base[3];
    double t[3], sum[3] = {0, 0, 0};
    bool good = locate(lattice, place.at, base, t);
    for (int k = 0; k < 8 && good; ++k) {
      double value[3] = {0, 0, 0}, weight = 1;
      good = corner(place, base, k, value);
      for (int a = 0; a < 3; ++a) weight *= (k >> a & 1) != 0 ? t[a] : 1 - t[a];
      for (std::size_t c = 0; c < components_; ++c) sum[c] += weight * value[c];
    }
    if (good) errors.push_back(difference(sum, place.value));
  }
  return error_of(errors);
}

}  // namespace catena::vtk
