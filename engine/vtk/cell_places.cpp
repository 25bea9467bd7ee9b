#include "engine/vtk/cell_places.h"

#include <vtkCell.h>
#include <vtkCellData.h>
#include <vtkUnsignedCharArray.h>

#include <algorithm>
#include <cmath>
#include <random>

namespace catena::vtk {

std::size_t components_of(const std::vector<CellValues>& blocks) {
  return static_cast<std::size_t>(blocks.front().values->GetNumberOfComponents());
}

bool is_hidden(vtkDataSet* data, vtkIdType cell) {
  vtkUnsignedCharArray* ghosts = data->GetCellGhostArray();
  return ghosts != nullptr && (ghosts->GetValue(cell) & (vtkDataSetAttributes::HIDDENCELL | vtkDataSetAttributes::DUPLICATECELL)) != 0;
}

bool CellWork::at(vtkIdType id) {
  if (is_hidden(block_.data, id)) return false;
  block_.data->GetCell(id, cell_);
  const vtkIdType n = cell_->GetNumberOfPoints();
  if (cell_->GetCellDimension() != 3 || n < 4 || n > kMostPoints) return false;
  cell_->GetBounds(bounds_);
  values_.resize(static_cast<std::size_t>(n) * components_);
  lo_ = 1e300;
  hi_ = -1e300;
  for (vtkIdType i = 0; i < n; ++i) {
    const vtkIdType point = cell_->GetPointId(static_cast<int>(i));
    for (std::size_t c = 0; c < components_; ++c) {
      const double v = block_.values->GetComponent(point, static_cast<int>(c));
      values_[static_cast<std::size_t>(i) * components_ + c] = v;
      lo_ = std::min(lo_, v);
      hi_ = std::max(hi_, v);
    }
  }
  return true;
}

bool CellWork::inside(const Vec3& p, double& distance2) {
  const double x[3] = {p.x, p.y, p.z};
  double closest[3];
  const int answer = cell_->EvaluatePosition(x, closest, sub_id_, parametric_, distance2, weights_.data());
  if (answer < 0) distance2 = 1e300;
  return answer == 1;
}

void CellWork::value(bool was_inside, double* out) {
  if (!was_inside) cell_->InterpolateFunctions(parametric_, weights_.data());
  const auto n = static_cast<std::size_t>(cell_->GetNumberOfPoints());
  const double give = kGive * (hi_ - lo_);
  for (std::size_t c = 0; c < components_; ++c) {
    double v = 0;
    for (std::size_t i = 0; i < n; ++i) v += weights_[i] * values_[i * components_ + c];
    out[c] = was_inside || !std::isfinite(give) ? v : std::clamp(v, lo_ - give, hi_ + give);
  }
}

namespace {

/// The range of scalars, the largest length of vectors.
double range_of(const std::vector<CellValues>& blocks) {
  const std::size_t components = components_of(blocks);
  double lo = 1e300, hi = -1e300;
  for (const CellValues& block : blocks)
    for (vtkIdType i = 0; i < block.values->GetNumberOfTuples(); ++i) {
      double v = block.values->GetComponent(i, 0);
      if (components == 3) v = std::hypot(v, block.values->GetComponent(i, 1), block.values->GetComponent(i, 2));
      if (!std::isfinite(v)) continue;
      lo = std::min(lo, v);
      hi = std::max(hi, v);
    }
  if (components == 3) lo = 0;
  return std::max(hi - lo, 1e-300);
}

/// Random places inside random cells.
std::vector<CellPlaces::Place> places_inside(const std::vector<CellValues>& blocks, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  const auto unit = [&] { return static_cast<double>(random() >> 11) * 0x1p-53; };
  vtkIdType all = 0;
  for (const CellValues& block : blocks) all += block.data->GetNumberOfCells();
  std::vector<std::vector<vtkIdType>> chosen(blocks.size());
  for (int i = 0; i < CellPlaces::kSamples && all > 0; ++i) {
    auto n = static_cast<vtkIdType>(unit() * static_cast<double>(all));
    std::size_t b = 0;
    while (b + 1 < blocks.size() && n >= blocks[b].data->GetNumberOfCells()) n -= blocks[b++].data->GetNumberOfCells();
    chosen[b].push_back(std::min(n, blocks[b].data->GetNumberOfCells() - 1));
  }
  std::vector<CellPlaces::Place> places;
  for (std::size_t b = 0; b < blocks.size(); ++b) {
    CellWork work(blocks[b]);
    for (const vtkIdType cell : chosen[b]) {
      if (!work.at(cell)) continue;
      constexpr int kTries = 40;
      const Vec3 lo = work.lowest(), extent = work.highest() - lo;
      for (int t = 0; t < kTries; ++t) {
        CellPlaces::Place place{b, cell, lo + Vec3(unit(), unit(), unit()) * extent, {}};
        double distance2 = 0;
        if (!work.inside(place.at, distance2)) continue;
        work.value(true, place.value.data());
        if (std::isfinite(place.value[0] + place.value[1] + place.value[2])) places.push_back(place);
        break;
      }
    }
  }
  return places;
}

}  // namespace

CellPlaces::CellPlaces(const std::vector<CellValues>& blocks, std::uint64_t seed)
    : components_(components_of(blocks)), places_(places_inside(blocks, seed)), range_(range_of(blocks)) {}

bool CellPlaces::locate(const Lattice& lattice, const Vec3& p, int (&base)[3], double (&t)[3]) {
  const int n[3] = {lattice.size.x, lattice.size.y, lattice.size.z};
  for (int a = 0; a < 3; ++a) {
    const double at = (p[a] - lattice.origin[a]) / lattice.spacing[a];
    base[a] = std::clamp(static_cast<int>(std::floor(at)), 0, n[a] - 2);
    t[a] = at - base[a];
    if (t[a] < -kInside || t[a] > 1 + kInside) return false;
  }
  return true;
}

double CellPlaces::difference(const double* a, const std::array<double, 3>& b) const {
  double sum = 0;
  for (std::size_t c = 0; c < components_; ++c) sum += (a[c] - b[c]) * (a[c] - b[c]);
  return std::sqrt(sum);
}

ResampleError CellPlaces::error_of(std::vector<double>& errors) const {
  if (errors.empty()) return {};
  std::sort(errors.begin(), errors.end());
  return {100 * errors[static_cast<std::size_t>(0.99 * static_cast<double>(errors.size() - 1))] / range_, 100 * errors.back() / range_};
}

}  // namespace catena::vtk
