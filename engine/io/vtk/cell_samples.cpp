// SPDX-License-Identifier: MIT
#include "engine/io/vtk/cell_samples.h"

#include <vtkCell.h>
#include <vtkIdList.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "engine/base/display_range.h"

namespace catena::vtk {

std::size_t component_count(const std::vector<CellValues>& blocks) {
  return static_cast<std::size_t>(blocks.front().values->GetNumberOfComponents());
}

bool CellSampler::set_cell(vtkIdType id) {
  block_.data->GetCell(id, cell_);
  const vtkIdType n = cell_->GetNumberOfPoints();
  if (cell_->GetCellDimension() != 3 || n < 4 || n > kMaxPoints) return false;
  cell_->GetBounds(bounds_);
  values_.resize(static_cast<std::size_t>(n) * components_);
  min_value_ = 1e300;
  max_value_ = -1e300;
  for (vtkIdType i = 0; i < n; ++i) {
    const vtkIdType point = cell_->GetPointId(static_cast<int>(i));
    for (std::size_t c = 0; c < components_; ++c) {
      const double v = block_.values->GetComponent(point, static_cast<int>(c));
      values_[static_cast<std::size_t>(i) * components_ + c] = v;
      min_value_ = std::min(min_value_, v);
      max_value_ = std::max(max_value_, v);
    }
  }
  return true;
}

bool CellSampler::contains(const Vec3& p, double& distance2) {
  const double x[3] = {p.x, p.y, p.z};
  double closest[3] = {p.x, p.y, p.z};
  const int status = cell_->EvaluatePosition(x, closest, sub_id_, parametric_, distance2, weights_.data());
  if (status < 0) distance2 = 1e300;
  constexpr double kRounding = 1e-6;
  strictly_inside_ = status == 1 && cell_->GetRepresentativeCell()->GetParametricDistance(parametric_) <= kRounding;
  closest_point_ = status < 0 ? Vec3(1e300) : status == 1 ? p : Vec3(closest[0], closest[1], closest[2]);
  return status == 1;
}

void CellSampler::interpolate(bool was_inside, double* out) {
  if (!was_inside) cell_->InterpolateFunctions(parametric_, weights_.data());
  const auto n = static_cast<std::size_t>(cell_->GetNumberOfPoints());
  const double margin = kExtrapolationLimit * (max_value_ - min_value_);
  for (std::size_t c = 0; c < components_; ++c) {
    double v = 0;
    for (std::size_t i = 0; i < n; ++i) v += weights_[i] * values_[i * components_ + c];
    out[c] = was_inside || !std::isfinite(margin) ? v : std::clamp(v, min_value_ - margin, max_value_ + margin);
  }
}

namespace {

/// Returns the display range of the scalars; for vectors from 0 to the largest length. Never empty.
DisplayRange range_of(const std::vector<CellValues>& blocks) {
  const std::size_t components = component_count(blocks);
  constexpr std::size_t kSampled = 1u << 17;
  std::size_t all = 0, n = 0;
  for (const CellValues& block : blocks) all += static_cast<std::size_t>(block.values->GetNumberOfTuples());
  const std::size_t step = 1 + all / kSampled;
  std::vector<float> sample;
  double lo = 1e300, hi = -1e300;
  for (const CellValues& block : blocks)
    for (vtkIdType i = 0; i < block.values->GetNumberOfTuples(); ++i) {
      double v = block.values->GetComponent(i, 0);
      if (components == 3) v = std::hypot(v, block.values->GetComponent(i, 1), block.values->GetComponent(i, 2));
      if (n++ % step == 0) sample.push_back(static_cast<float>(v));
      if (!std::isfinite(v)) continue;
      lo = std::min(lo, v);
      hi = std::max(hi, v);
    }
  if (lo > hi) return {0, 1e-300};
  // the range excludes outliers, because an error in percent of a range with outliers is meaningless
  DisplayRange range = display_range(std::move(sample), lo, hi);
  if (components == 3) range.lo = 0;
  return range;
}

/// Returns random positions inside random cells.
std::vector<CellSamples::Sample> samples_inside(const std::vector<CellValues>& blocks, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  const auto unit = [&] { return static_cast<double>(random() >> 11) * 0x1p-53; };
  vtkIdType all = 0;
  for (const CellValues& block : blocks) all += block.data->GetNumberOfCells();
  std::vector<std::vector<vtkIdType>> chosen_cells(blocks.size());
  for (int i = 0; i < CellSamples::kSampleCount && all > 0; ++i) {
    auto n = static_cast<vtkIdType>(unit() * static_cast<double>(all));
    std::size_t b = 0;
    while (b + 1 < blocks.size() && n >= blocks[b].data->GetNumberOfCells()) n -= blocks[b++].data->GetNumberOfCells();
    chosen_cells[b].push_back(std::min(n, blocks[b].data->GetNumberOfCells() - 1));
  }
  std::vector<CellSamples::Sample> samples;
  for (std::size_t b = 0; b < blocks.size(); ++b) {
    CellSampler work(blocks[b]);
    for (const vtkIdType cell : chosen_cells[b]) {
      if (!work.set_cell(cell)) continue;
      constexpr int kTries = 40;
      const Vec3 lo = work.min_corner(), extent = work.max_corner() - lo;
      for (int t = 0; t < kTries; ++t) {
        CellSamples::Sample sample{b, cell, lo + Vec3(unit(), unit(), unit()) * extent, {}};
        double distance2 = 0;
        if (!work.contains(sample.position, distance2)) continue;
        work.interpolate(true, sample.value.data());
        if (std::isfinite(sample.value[0] + sample.value[1] + sample.value[2])) samples.push_back(sample);
        break;
      }
    }
  }
  return samples;
}

/// Returns samples at the points of cells with the minimum and the maximum value.
std::vector<CellSamples::Sample> samples_at_extremes(const std::vector<CellValues>& blocks) {
  const std::size_t components = component_count(blocks);
  struct Extreme {
    double value;
    std::size_t block = 0;
    vtkIdType cell = -1, point = -1;
  };
  Extreme minimum{1e300}, maximum{-1e300};
  vtkNew<vtkIdList> ids;
  for (std::size_t b = 0; b < blocks.size(); ++b)
    for (vtkIdType cell = 0; cell < blocks[b].data->GetNumberOfCells(); ++cell) {
      blocks[b].data->GetCellPoints(cell, ids);
      for (vtkIdType i = 0; i < ids->GetNumberOfIds(); ++i) {
        const vtkIdType p = ids->GetId(i);
        double v = blocks[b].values->GetComponent(p, 0);
        if (components == 3) v = std::hypot(v, blocks[b].values->GetComponent(p, 1), blocks[b].values->GetComponent(p, 2));
        if (!std::isfinite(v)) continue;
        if (v < minimum.value) minimum = {v, b, cell, p};
        if (v > maximum.value) maximum = {v, b, cell, p};
      }
    }
  std::vector<CellSamples::Sample> samples;
  for (const Extreme* extreme : {&minimum, &maximum}) {
    if (extreme->cell < 0) continue;
    CellSampler work(blocks[extreme->block]);
    if (!work.set_cell(extreme->cell)) continue;
    double x[3];
    blocks[extreme->block].data->GetPoint(extreme->point, x);
    constexpr double kInward = 1e-6;
    const Vec3 point(x[0], x[1], x[2]), middle = (work.min_corner() + work.max_corner()) * 0.5;
    CellSamples::Sample sample{extreme->block, extreme->cell, point + (middle - point) * kInward, {}};
    for (std::size_t c = 0; c < components; ++c)
      sample.value[c] = blocks[extreme->block].values->GetComponent(extreme->point, static_cast<int>(c));
    samples.push_back(sample);
  }
  return samples;
}

}  // namespace

CellFinder::CellFinder(const std::vector<CellValues>& blocks) {
  for (const CellValues& block : blocks) {
    locators_.push_back(vtkSmartPointer<vtkStaticCellLocator>::New());
    locators_.back()->SetDataSet(block.data);
    locators_.back()->BuildLocator();
  }
}

std::pair<std::size_t, vtkIdType> CellFinder::find_cell(const Vec3& p) {
  double x[3] = {p.x, p.y, p.z};
  for (std::size_t b = 0; b < locators_.size(); ++b)
    if (const vtkIdType cell = locators_[b]->FindCell(x); cell >= 0) return {b, cell};
  return {0, -1};
}

BoxSamples::BoxSamples(CellFinder& within, const Vec3& lo, const Vec3& hi, std::uint64_t seed) : cell_finder_(within) {
  std::mt19937_64 random(seed);
  const auto unit = [&] { return static_cast<double>(random() >> 11) * 0x1p-53; };
  for (int i = 0; i < CellSamples::kSampleCount; ++i) {
    const Vec3 at = lo + Vec3(unit(), unit(), unit()) * (hi - lo);
    samples_.push_back({at, cell_finder_.contains(at)});
  }
}

bool BoxSamples::is_in_narrow_gap(const Vec3& p, int axis, double voxel) const {
  constexpr double kStep = 0.25;   // voxels
  constexpr double kMiddle = 0.4;  // fraction of the gap width
  double distance[2] = {0, 0};
  for (const int side : {0, 1}) {
    bool hit = false;
    for (double t = kStep / 2; t + distance[0] < kNarrowGapVoxels && !hit; t += kStep) {
      Vec3 q = p;
      q[axis] += (side == 0 ? -t : t) * voxel;
      hit = cell_finder_.contains(q);
      distance[side] = t;
    }
    if (!hit) return false;
  }
  return std::min(distance[0], distance[1]) >= kMiddle * (distance[0] + distance[1]);
}

double BoxSamples::gap_fill_share(const ResampleGrid& lattice) const {
  std::size_t found = 0;
  for (const Sample& sample : samples_) {
    int base[3];
    double t[3];
    if (sample.is_inside || !CellSamples::locate_voxel_cell(lattice, sample.position, base, t)) continue;
    bool gap = false;
    for (int axis = 0; axis < 3; ++axis) gap = gap || is_in_narrow_gap(sample.position, axis, lattice.spacing[axis]);
    if (!gap) continue;
    // the voxel cell around the position intersects cells of the data
    bool overlaps = false;
    for (int c = 0; c < 8 && !overlaps; ++c) {
      Vec3 corner;
      for (int a = 0; a < 3; ++a) corner[a] = lattice.origin[a] + lattice.spacing[a] * (base[a] + ((c >> a & 1) != 0 ? 0.99 : 0.01));
      overlaps = cell_finder_.contains(corner);
    }
    found += overlaps ? 1 : 0;
  }
  return static_cast<double>(found) / static_cast<double>(samples_.size());
}

ResampleShares BoxSamples::shares(const ResampleGrid& lattice, const std::vector<std::uint8_t>& cells) const {
  std::size_t in = 0, out = 0;
  for (const Sample& sample : samples_) {
    int base[3];
    double t[3];
    const bool now =
        CellSamples::locate_voxel_cell(lattice, sample.position, base, t) && cells[lattice.linear_index(base[0], base[1], base[2])] != 0;
    in += now && !sample.is_inside ? 1 : 0;
    out += !now && sample.is_inside ? 1 : 0;
  }
  const auto all = static_cast<double>(samples_.size());
  return {static_cast<double>(in) / all, static_cast<double>(out) / all, gap_fill_share(lattice)};
}

CellSamples::CellSamples(const std::vector<CellValues>& blocks, std::uint64_t seed)
    : components_(component_count(blocks)),
      samples_(samples_inside(blocks, seed)),
      extremes_(samples_at_extremes(blocks)),
      range_(range_of(blocks)) {}

bool CellSamples::locate_voxel_cell(const ResampleGrid& lattice, const Vec3& p, int (&base)[3], double (&t)[3]) {
  const int n[3] = {lattice.size.x, lattice.size.y, lattice.size.z};
  for (int a = 0; a < 3; ++a) {
    const double at = (p[a] - lattice.origin[a]) / lattice.spacing[a];
    base[a] = std::clamp(static_cast<int>(std::floor(at)), 0, n[a] - 2);
    t[a] = at - base[a];
    if (t[a] < -kInsideTolerance || t[a] > 1 + kInsideTolerance) return false;
  }
  return true;
}

double CellSamples::difference(const double* a, const std::array<double, 3>& b) const {
  double sum = 0;
  for (std::size_t c = 0; c < components_; ++c) sum += (a[c] - b[c]) * (a[c] - b[c]);
  return std::sqrt(sum);
}

ResampleError CellSamples::summarize_errors(std::vector<double>& errors) const {
  if (errors.empty()) return {};
  std::sort(errors.begin(), errors.end());
  const double range_length = std::max(range_.hi - range_.lo, 1e-300);
  return {100 * errors[static_cast<std::size_t>(0.99 * static_cast<double>(errors.size() - 1))] / range_length,
          100 * errors.back() / range_length};
}

}  // namespace catena::vtk
