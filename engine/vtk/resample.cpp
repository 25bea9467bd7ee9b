#include "engine/vtk/resample.h"

#include <fmt/format.h>
#include <vtkCell.h>
#include <vtkCellData.h>
#include <vtkGenericCell.h>
#include <vtkNew.h>
#include <vtkSmartPointer.h>
#include <vtkStaticCellLocator.h>
#include <vtkUnsignedCharArray.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <random>

namespace catena::vtk {
namespace {

constexpr int kSamples = 20'000;
constexpr int kMostPoints = 216;  // of a cell: a hexahedron of order 5
constexpr double kInside = 1e-9;
constexpr double kGive = 0.25;    // of a cell's range: how far its polynomial may go beyond it
constexpr double kWorthIt = 0.8;  // of the error: what a finer grid must leave at most, else it does not help

struct Range {
  double lo = 1e300, hi = -1e300;
  double width() const { return hi - lo; }
};

bool is_hidden(vtkDataSet* data, vtkIdType cell) {
  vtkUnsignedCharArray* ghosts = data->GetCellGhostArray();
  return ghosts != nullptr && (ghosts->GetValue(cell) & (vtkDataSetAttributes::HIDDENCELL | vtkDataSetAttributes::DUPLICATECELL)) != 0;
}

/// Work on one cell of a block after the other; what a cell needs is allocated once.
class CellWork {
 public:
  explicit CellWork(const CellValues& block) : block_(block), components_(block.values->GetNumberOfComponents()) {}

  /// False: it has no volume, or too many points.
  bool at(vtkIdType id) {
    if (is_hidden(block_.data, id)) return false;
    block_.data->GetCell(id, cell_);
    const vtkIdType n = cell_->GetNumberOfPoints();
    if (cell_->GetCellDimension() != 3 || n < 4 || n > kMostPoints) return false;
    cell_->GetBounds(bounds_);
    values_.resize(static_cast<std::size_t>(n) * components_);
    range_ = {};
    for (vtkIdType i = 0; i < n; ++i) {
      const vtkIdType point = cell_->GetPointId(static_cast<int>(i));
      for (std::size_t c = 0; c < components_; ++c) {
        const double v = block_.values->GetComponent(point, static_cast<int>(c));
        values_[static_cast<std::size_t>(i) * components_ + c] = v;
        range_.lo = std::min(range_.lo, v);
        range_.hi = std::max(range_.hi, v);
      }
    }
    return true;
  }

  const double* bounds() const { return bounds_; }
  Vec3 lowest() const { return {bounds_[0], bounds_[2], bounds_[4]}; }
  Vec3 highest() const { return {bounds_[1], bounds_[3], bounds_[5]}; }

  /// Whether p lies inside; sets its distance (squared) from the cell.
  bool inside(const Vec3& p, double& distance2) {
    const double x[3] = {p.x, p.y, p.z};
    double closest[3];
    const int answer = cell_->EvaluatePosition(x, closest, sub_id_, parametric_, distance2, weights_.data());
    if (answer < 0) distance2 = 1e300;
    return answer == 1;
  }
  /// The cell's interpolation at the place last asked for; outside continued, and held back.
  void value(bool was_inside, double* out) {
    if (!was_inside) cell_->InterpolateFunctions(parametric_, weights_.data());
    const auto n = static_cast<std::size_t>(cell_->GetNumberOfPoints());
    const double give = range_.width();
    for (std::size_t c = 0; c < components_; ++c) {
      double v = 0;
      for (std::size_t i = 0; i < n; ++i) v += weights_[i] * values_[i * components_ + c];
      out[c] = was_inside || !std::isfinite(give) ? v : std::clamp(v, range_.lo - kGive * give, range_.hi + kGive * give);
    }
  }

 private:
  CellValues block_;
  std::size_t components_;
  vtkNew<vtkGenericCell> cell_;
  double bounds_[6]{};
  std::vector<double> values_;
  std::array<double, kMostPoints> weights_{};
  double parametric_[3]{};
  int sub_id_ = 0;
  Range range_;
};

struct Place {
  std::size_t block;
  vtkIdType cell;
  Vec3 at;
  std::array<double, 3> value;
};

std::size_t components_of(const std::vector<CellValues>& blocks) {
  return static_cast<std::size_t>(blocks.front().values->GetNumberOfComponents());
}

/// Random places inside random cells.
std::vector<Place> places_inside(const std::vector<CellValues>& blocks, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  const auto unit = [&] { return static_cast<double>(random() >> 11) * 0x1p-53; };
  vtkIdType all = 0;
  for (const CellValues& block : blocks) all += block.data->GetNumberOfCells();
  std::vector<std::vector<vtkIdType>> chosen(blocks.size());
  for (int i = 0; i < kSamples && all > 0; ++i) {
    auto n = static_cast<vtkIdType>(unit() * static_cast<double>(all));
    std::size_t b = 0;
    while (b + 1 < blocks.size() && n >= blocks[b].data->GetNumberOfCells()) n -= blocks[b++].data->GetNumberOfCells();
    chosen[b].push_back(std::min(n, blocks[b].data->GetNumberOfCells() - 1));
  }
  std::vector<Place> places;
  for (std::size_t b = 0; b < blocks.size(); ++b) {
    CellWork work(blocks[b]);
    for (const vtkIdType cell : chosen[b]) {
      if (!work.at(cell)) continue;
      constexpr int kTries = 40;
      const Vec3 lo = work.lowest(), extent = work.highest() - lo;
      for (int t = 0; t < kTries; ++t) {
        Place place{b, cell, lo + Vec3(unit(), unit(), unit()) * extent, {}};
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

/// What errors are told in: the range of scalars, the largest length of vectors.
double range_of(const std::vector<CellValues>& blocks) {
  const std::size_t components = components_of(blocks);
  Range range;
  for (const CellValues& block : blocks)
    for (vtkIdType i = 0; i < block.values->GetNumberOfTuples(); ++i) {
      double v = block.values->GetComponent(i, 0);
      if (components == 3) v = std::hypot(v, block.values->GetComponent(i, 1), block.values->GetComponent(i, 2));
      if (!std::isfinite(v)) continue;
      range.lo = std::min(range.lo, v);
      range.hi = std::max(range.hi, v);
    }
  if (components == 3) range.lo = 0;
  return std::max(range.width(), 1e-300);
}

double difference(const double* a, const double* b, std::size_t components) {
  double sum = 0;
  for (std::size_t c = 0; c < components; ++c) sum += (a[c] - b[c]) * (a[c] - b[c]);
  return std::sqrt(sum);
}

ResampleError error_of(std::vector<double>& errors, double range, std::size_t places) {
  ResampleError e;
  e.lost = places > 0 ? 1 - static_cast<double>(errors.size()) / static_cast<double>(places) : 0;
  if (errors.empty()) return e;
  std::sort(errors.begin(), errors.end());
  e.p99 = 100 * errors[static_cast<std::size_t>(0.99 * static_cast<double>(errors.size() - 1))] / range;
  e.most = 100 * errors.back() / range;
  return e;
}

/// The corner below, and where between it and the one above; false outside of the lattice.
bool locate(const Lattice& lattice, const Vec3& p, int (&base)[3], double (&t)[3]) {
  const int n[3] = {lattice.size.x, lattice.size.y, lattice.size.z};
  for (int a = 0; a < 3; ++a) {
    const double at = (p[a] - lattice.origin[a]) / lattice.spacing[a];
    base[a] = std::clamp(static_cast<int>(std::floor(at)), 0, n[a] - 2);
    t[a] = at - base[a];
    if (t[a] < -kInside || t[a] > 1 + kInside) return false;
  }
  return true;
}

double weight(const double (&t)[3], int corner) {
  double w = 1;
  for (int a = 0; a < 3; ++a) w *= (corner >> a & 1) != 0 ? t[a] : 1 - t[a];
  return w;
}

/// Trilinear interpolation on a lattice whose corners are asked for one by one, of the blocks themselves: what a grid would give that was
/// never made.
class Foresight {
 public:
  explicit Foresight(const std::vector<CellValues>& blocks) : blocks_(blocks), places_(places_inside(blocks, 1)), range_(range_of(blocks)) {
    for (const CellValues& block : blocks) {
      locators_.push_back(vtkSmartPointer<vtkStaticCellLocator>::New());
      locators_.back()->SetDataSet(block.data);
      locators_.back()->BuildLocator();
    }
  }
  bool empty() const { return places_.empty(); }

  double p99(const Lattice& lattice) {
    const std::size_t components = components_of(blocks_);
    std::vector<double> errors;
    std::size_t last_block = blocks_.size();
    std::optional<CellWork> work, other;
    for (std::size_t i = 0; i < places_.size(); i += kEvery) {
      const Place& place = places_[i];
      if (place.block != last_block) {
        work.emplace(blocks_[place.block]);
        other.emplace(blocks_[place.block]);
        last_block = place.block;
      }
      int base[3];
      double t[3], sum[3] = {0, 0, 0};
      if (!locate(lattice, place.at, base, t) || !work->at(place.cell)) continue;
      for (int corner = 0; corner < 8; ++corner) {
        Vec3 p;
        for (int a = 0; a < 3; ++a) p[a] = lattice.origin[a] + lattice.spacing[a] * (base[a] + (corner >> a & 1));
        double value[3] = {0, 0, 0}, distance2 = 0;
        double x[3] = {p.x, p.y, p.z};
        const vtkIdType cell = locators_[place.block]->FindCell(x);
        bool found = false;
        if (cell >= 0 && other->at(cell) && other->inside(p, distance2)) {
          other->value(true, value);
          found = true;
        }
        if (!found) work->value(work->inside(p, distance2), value);
        for (std::size_t c = 0; c < components; ++c) sum[c] += weight(t, corner) * value[c];
      }
      errors.push_back(difference(sum, place.value.data(), components));
    }
    return error_of(errors, range_, errors.size()).p99;
  }

 private:
  static constexpr std::size_t kEvery = 4;
  const std::vector<CellValues>& blocks_;
  std::vector<Place> places_;
  double range_;
  std::vector<vtkSmartPointer<vtkStaticCellLocator>> locators_;
};

double middle(std::vector<double>& values) {
  const auto at = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), at, values.end());
  return *at;
}

Lattice lattice_of(const Vec3& lo, const Vec3& hi, const Vec3& edges, double factor) {
  Lattice lattice;
  int n[3];
  for (int a = 0; a < 3; ++a) {
    constexpr double kMostAxis = 1 << 14;
    const double steps = std::clamp(std::ceil((hi[a] - lo[a]) / (edges[a] * factor) - 1e-9), 1.0, kMostAxis);
    n[a] = static_cast<int>(steps) + 1;
    lattice.spacing[a] = hi[a] > lo[a] ? (hi[a] - lo[a]) / steps : edges[a];
  }
  lattice.size = {n[0], n[1], n[2]};
  lattice.origin = lo;
  return lattice;
}

Lattice finer_than(const Lattice& lattice, double factor) {
  const Vec3 steps(lattice.size.x - 1, lattice.size.y - 1, lattice.size.z - 1);
  return lattice_of(lattice.origin, lattice.origin + lattice.spacing * steps, lattice.spacing, 1 / factor);
}

}  // namespace

Result<ResamplePlan> plan_resampling(const std::vector<CellValues>& blocks, double most_voxels) {
  Vec3 lo(1e300), hi(-1e300);
  std::vector<double> extents[3];
  for (const CellValues& block : blocks) {
    CellWork work(block);
    const vtkIdType cells = block.data->GetNumberOfCells();
    const vtkIdType every = std::max<vtkIdType>(1, cells / kSamples);
    for (vtkIdType i = 0; i < cells; ++i) {
      double b[6];
      block.data->GetCellBounds(i, b);
      if (is_hidden(block.data, i)) continue;
      for (int a = 0; a < 3; ++a) {
        lo[a] = std::min(lo[a], b[2 * a]);
        hi[a] = std::max(hi[a], b[2 * a + 1]);
      }
      if (i % every != 0 || !work.at(i)) continue;
      for (int a = 0; a < 3; ++a) extents[a].push_back(b[2 * a + 1] - b[2 * a]);
    }
  }
  if (!is_finite(lo) || !is_finite(hi)) return Error{"has points that are not finite"};
  if (extents[0].empty()) return Error{"has no cells with a volume"};
  Vec3 edges;
  for (int a = 0; a < 3; ++a) edges[a] = middle(extents[a]);
  const double largest = max_abs(hi - lo);
  for (int a = 0; a < 3; ++a) edges[a] = std::clamp(edges[a], 1e-4 * largest, std::max(largest, 1e-300));
  // as coarse as fits
  double factor = 1;
  const auto voxels = [&](double f) { return static_cast<double>(lattice_of(lo, hi, edges, f).voxels()); };
  while (voxels(factor) > most_voxels) factor *= 1.1;
  Foresight foresight(blocks);
  if (foresight.empty()) return Error{"has no finite values inside its cells"};
  ResamplePlan plan;
  double before = 1e300;
  int idle = 0;
  for (;;) {
    plan.lattice = lattice_of(lo, hi, edges, factor);
    plan.p99 = foresight.p99(plan.lattice);
    plan.fine = plan.p99 <= kWantedError * 0.9;  // the final measure has other places
    if (plan.fine) return plan;
    // an error of second order, at worst of first
    constexpr double kLeastStep = 1.2, kMostStep = 2;
    // values that jump from cell to cell do not get better with voxels
    idle = plan.p99 > kWorthIt * before ? idle + 1 : 0;
    before = plan.p99;
    constexpr int kIdle = 2;
    if (idle >= kIdle) break;
    const double finer = factor / std::clamp(std::sqrt(plan.p99 / (0.8 * kWantedError)), kLeastStep, kMostStep);
    plan.wanted_voxels = voxels(factor) * std::pow(plan.p99 / kWantedError, 1.5);
    if (voxels(finer) > most_voxels) break;
    factor = finer;
  }
  if (idle == 0) {  // as fine as fits
    while (voxels(factor / 1.1) <= most_voxels) factor /= 1.1;
    plan.lattice = lattice_of(lo, hi, edges, factor);
    plan.p99 = foresight.p99(plan.lattice);
  }
  plan.fine = plan.p99 <= kWantedError;
  return plan;
}

namespace {

struct Span3 {
  int lo[3], hi[3];
};

Span3 span_of(const Lattice& lattice, const double* bounds, double more) {
  const int n[3] = {lattice.size.x, lattice.size.y, lattice.size.z};
  Span3 span;
  for (int a = 0; a < 3; ++a) {
    const double lo = (bounds[2 * a] - lattice.origin[a]) / lattice.spacing[a],
                 hi = (bounds[2 * a + 1] - lattice.origin[a]) / lattice.spacing[a];
    span.lo[a] = std::clamp(static_cast<int>(std::ceil(lo - more - kInside)), 0, n[a]);
    span.hi[a] = std::clamp(static_cast<int>(std::floor(hi + more + kInside)), -1, n[a] - 1);
  }
  return span;
}

template <class Visit>
void each_voxel(const Lattice& lattice, const Span3& span, const Visit& visit) {
  for (int k = span.lo[2]; k <= span.hi[2]; ++k)
    for (int j = span.lo[1]; j <= span.hi[1]; ++j)
      for (int i = span.lo[0]; i <= span.hi[0]; ++i) {
        const std::size_t at = (static_cast<std::size_t>(k) * static_cast<std::size_t>(lattice.size.y) + static_cast<std::size_t>(j)) *
                                   static_cast<std::size_t>(lattice.size.x) +
                               static_cast<std::size_t>(i);
        visit(at, lattice.origin + lattice.spacing * Vec3(i, j, k));
      }
}

void put(CellWork& work, bool inside, float* values, std::size_t components) {
  double value[3];
  work.value(inside, value);
  for (std::size_t c = 0; c < components; ++c) values[c] = static_cast<float>(value[c]);
}

constexpr std::uint8_t kNear = 2;  ///< of `valid`, meanwhile: next to a voxel inside

/// Voxels that touch one inside: straight on from those behind it, 2 v(1) - v(2), on average over the directions in which both are inside.
void continue_lattice(const Lattice& lattice, std::size_t components, float* values, std::uint8_t* valid) {
  const int n[3] = {lattice.size.x, lattice.size.y, lattice.size.z};
  const auto at = [&](int i, int j, int k) {
    return (static_cast<std::size_t>(k) * static_cast<std::size_t>(n[1]) + static_cast<std::size_t>(j)) * static_cast<std::size_t>(n[0]) +
           static_cast<std::size_t>(i);
  };
  const auto inside = [&](int i, int j, int k) {
    return i >= 0 && j >= 0 && k >= 0 && i < n[0] && j < n[1] && k < n[2] && valid[at(i, j, k)] == 1;
  };
  for (int k = 0; k < n[2]; ++k)
    for (int j = 0; j < n[1]; ++j)
      for (int i = 0; i < n[0]; ++i) {
        const std::size_t here = at(i, j, k);
        if (valid[here] != 0) continue;
        double straight[3] = {0, 0, 0}, beside[3] = {0, 0, 0};
        int lines = 0, neighbours = 0;
        for (int d = 0; d < 27; ++d) {
          const int x = d % 3 - 1, y = d / 3 % 3 - 1, z = d / 9 - 1;
          if (!inside(i + x, j + y, k + z)) continue;
          const std::size_t first = at(i + x, j + y, k + z);
          const bool far = inside(i + 2 * x, j + 2 * y, k + 2 * z);
          const std::size_t second = far ? at(i + 2 * x, j + 2 * y, k + 2 * z) : first;
          ++neighbours;
          lines += far ? 1 : 0;
          for (std::size_t c = 0; c < components; ++c) {
            const double v = static_cast<double>(values[first * components + c]);
            beside[c] += v;
            if (far) straight[c] += 2 * v - static_cast<double>(values[second * components + c]);
          }
        }
        if (neighbours == 0) continue;
        for (std::size_t c = 0; c < components; ++c)
          values[here * components + c] = static_cast<float>(lines > 0 ? straight[c] / lines : beside[c] / neighbours);
        valid[here] = kNear;
      }
}

/// Where cells are thinner than voxels no voxel may lie inside: those within a voxel's diagonal of a cell get the nearest one's polynomial.
void continue_cells(const std::vector<CellValues>& blocks, const Lattice& lattice, std::size_t components, float* values,
                    std::uint8_t* valid) {
  constexpr std::uint8_t kThin = 3;
  std::vector<float> nearest;
  const double near2 = dot(lattice.spacing, lattice.spacing);  // no corner around a place inside is farther from it
  for (const CellValues& block : blocks) {
    CellWork work(block);
    for (vtkIdType id = 0; id < block.data->GetNumberOfCells(); ++id) {
      double b[6];
      block.data->GetCellBounds(id, b);
      const Span3 span = span_of(lattice, b, 1);
      bool some = false;
      each_voxel(lattice, span, [&](std::size_t at, const Vec3&) { some = some || valid[at] == 0 || valid[at] == kThin; });
      if (!some || !work.at(id)) continue;
      if (nearest.empty()) nearest.assign(lattice.voxels(), std::numeric_limits<float>::infinity());
      each_voxel(lattice, span, [&](std::size_t at, const Vec3& p) {
        if (valid[at] != 0 && valid[at] != kThin) return;
        double distance2 = 0;
        const bool inside = work.inside(p, distance2);
        if (!(static_cast<float>(distance2) < nearest[at]) || (!inside && distance2 > near2)) return;
        nearest[at] = static_cast<float>(distance2);
        put(work, inside, values + at * components, components);
        valid[at] = kThin;
      });
    }
  }
}

void fill(const std::vector<CellValues>& blocks, const Lattice& lattice, float* values, std::uint8_t* valid) {
  const std::size_t components = components_of(blocks);
  for (const CellValues& block : blocks) {
    CellWork work(block);
    for (vtkIdType id = 0; id < block.data->GetNumberOfCells(); ++id) {
      if (!work.at(id)) continue;
      each_voxel(lattice, span_of(lattice, work.bounds(), 0), [&](std::size_t at, const Vec3& p) {
        double distance2 = 0;
        if (valid[at] != 0 || !work.inside(p, distance2)) return;
        put(work, true, values + at * components, components);
        valid[at] = 1;
      });
    }
  }
  continue_lattice(lattice, components, values, valid);
  continue_cells(blocks, lattice, components, values, valid);
  for (std::size_t i = 0; i < lattice.voxels(); ++i) valid[i] = valid[i] != 0 ? 1 : 0;
}

ResampleError measure(const std::vector<CellValues>& blocks, const Lattice& lattice, const float* values, const std::uint8_t* valid) {
  const std::size_t components = components_of(blocks);
  const std::vector<Place> places = places_inside(blocks, 2);
  std::vector<double> errors;
  for (const Place& place : places) {
    int base[3];
    double t[3], sum[3] = {0, 0, 0};
    if (!locate(lattice, place.at, base, t)) continue;
    bool good = true;
    for (int corner = 0; corner < 8; ++corner) {
      std::size_t at = 0;
      const int n[3] = {lattice.size.x, lattice.size.y, lattice.size.z};
      for (int a = 2; a >= 0; --a) at = at * static_cast<std::size_t>(n[a]) + static_cast<std::size_t>(base[a] + (corner >> a & 1));
      good = good && valid[at] != 0;
      for (std::size_t c = 0; c < components; ++c) sum[c] += weight(t, corner) * static_cast<double>(values[at * components + c]);
    }
    if (good) errors.push_back(difference(sum, place.value.data(), components));
  }
  return error_of(errors, range_of(blocks), places.size());
}

}  // namespace

Result<Resampled> resample(const std::vector<CellValues>& blocks, double most_voxels) {
  CATENA_TRY(const ResamplePlan plan, plan_resampling(blocks, most_voxels));
  Resampled made;
  made.lattice = plan.lattice;
  constexpr int kMostTimes = 6;
  double before = 1e300;
  for (int time = 0; time < kMostTimes; ++time) {
    made.values.assign(made.lattice.voxels() * components_of(blocks), 0.f);
    made.valid.assign(made.lattice.voxels(), 0);
    fill(blocks, made.lattice, made.values.data(), made.valid.data());
    made.error = measure(blocks, made.lattice, made.values.data(), made.valid.data());
    if (made.error.p99 <= kWantedError) return made;
    made.jumps = made.error.p99 > kWorthIt * before || !plan.fine;
    if (made.jumps && time > 0) return made;
    before = made.error.p99;
    constexpr double kLeastStep = 1.15, kMostStep = 1.6;
    const double finer = std::clamp(std::sqrt(made.error.p99 / (0.8 * kWantedError)), kLeastStep, kMostStep);
    made.wanted_voxels = static_cast<double>(made.lattice.voxels()) * std::pow(made.error.p99 / kWantedError, 1.5);
    Lattice next = finer_than(made.lattice, finer);
    if (static_cast<double>(next.voxels()) > most_voxels) break;
    if (time + 1 < kMostTimes) made.lattice = next;
  }
  return made;
}

}  // namespace catena::vtk
