// SPDX-License-Identifier: MIT
#include "engine/io/vtk/resample.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "engine/io/vtk/cell_samples.h"

namespace catena::vtk {
namespace {

struct Span3 {
  int lo[3], hi[3];
};

Span3 span_of(const ResampleGrid& lattice, const double* bounds, double more) {
  const int n[3] = {lattice.size.x, lattice.size.y, lattice.size.z};
  Span3 span;
  for (int a = 0; a < 3; ++a) {
    const double lo = (bounds[2 * a] - lattice.origin[a]) / lattice.spacing[a],
                 hi = (bounds[2 * a + 1] - lattice.origin[a]) / lattice.spacing[a];
    span.lo[a] = std::clamp(static_cast<int>(std::ceil(lo - more - kInsideTolerance)), 0, n[a]);
    span.hi[a] = std::clamp(static_cast<int>(std::floor(hi + more + kInsideTolerance)), -1, n[a] - 1);
  }
  return span;
}

template <class Visit>
void each_voxel(const ResampleGrid& lattice, const Span3& span, const Visit& visit) {
  for (int k = span.lo[2]; k <= span.hi[2]; ++k)
    for (int j = span.lo[1]; j <= span.hi[1]; ++j)
      for (int i = span.lo[0]; i <= span.hi[0]; ++i) visit(lattice.linear_index(i, j, k), lattice.origin + lattice.spacing * Vec3(i, j, k));
}

void put(CellSampler& work, bool inside, float* values, std::size_t components) {
  double value[3];
  work.interpolate(inside, value);
  for (std::size_t c = 0; c < components; ++c) values[c] = static_cast<float>(value[c]);
}

constexpr std::uint8_t kNear = 2;  ///< temporary value in `valid`: next to a voxel inside

/// Extrapolates to voxels next to one inside, linearly from those behind it, 2 v(1) - v(2), averaged over the directions in which both are
/// inside.
void continue_lattice(const ResampleGrid& lattice, std::size_t components, float* values, std::uint8_t* valid) {
  const int n[3] = {lattice.size.x, lattice.size.y, lattice.size.z};
  const auto inside = [&](int i, int j, int k) {
    return i >= 0 && j >= 0 && k >= 0 && i < n[0] && j < n[1] && k < n[2] && valid[lattice.linear_index(i, j, k)] == 1;
  };
  for (int k = 0; k < n[2]; ++k)
    for (int j = 0; j < n[1]; ++j)
      for (int i = 0; i < n[0]; ++i) {
        const std::size_t voxel = lattice.linear_index(i, j, k);
        if (valid[voxel] != 0) continue;
        double extrapolated[3] = {0, 0, 0}, neighbour_mean[3] = {0, 0, 0};
        int lines = 0, neighbours = 0;
        for (int d = 0; d < 27; ++d) {
          const int x = d % 3 - 1, y = d / 3 % 3 - 1, z = d / 9 - 1;
          if (!inside(i + x, j + y, k + z)) continue;
          const std::size_t first = lattice.linear_index(i + x, j + y, k + z);
          const bool far = inside(i + 2 * x, j + 2 * y, k + 2 * z);
          const std::size_t second = far ? lattice.linear_index(i + 2 * x, j + 2 * y, k + 2 * z) : first;
          ++neighbours;
          lines += far ? 1 : 0;
          for (std::size_t c = 0; c < components; ++c) {
            const double v = static_cast<double>(values[first * components + c]);
            neighbour_mean[c] += v;
            if (far) extrapolated[c] += 2 * v - static_cast<double>(values[second * components + c]);
          }
        }
        if (neighbours == 0) continue;
        for (std::size_t c = 0; c < components; ++c)
          values[voxel * components + c] = static_cast<float>(lines > 0 ? extrapolated[c] / lines : neighbour_mean[c] / neighbours);
        valid[voxel] = kNear;
      }
}

/// Fills voxels near cells that are thinner than voxels, in which no voxel may lie: those within a voxel's diagonal of a cell get the value
/// of the nearest cell's polynomial.
void continue_cells(const std::vector<CellValues>& blocks, const ResampleGrid& lattice, std::size_t components, float* values,
                    std::uint8_t* valid) {
  constexpr std::uint8_t kThin = 3;
  std::vector<float> nearest;
  const double near2 = dot(lattice.spacing, lattice.spacing);  // no corner of the voxel cell around a position is farther away
  for (const CellValues& block : blocks) {
    CellSampler work(block);
    for (vtkIdType id = 0; id < block.data->GetNumberOfCells(); ++id) {
      double b[6];
      block.data->GetCellBounds(id, b);
      const Span3 span = span_of(lattice, b, 1);
      bool some = false;
      each_voxel(lattice, span, [&](std::size_t at, const Vec3&) { some = some || valid[at] == 0 || valid[at] == kThin; });
      if (!some || !work.set_cell(id)) continue;
      if (nearest.empty()) nearest.assign(lattice.voxel_count(), std::numeric_limits<float>::infinity());
      each_voxel(lattice, span, [&](std::size_t at, const Vec3& p) {
        if (valid[at] != 0 && valid[at] != kThin) return;
        double distance2 = 0;
        const bool inside = work.contains(p, distance2);
        if (!(static_cast<float>(distance2) < nearest[at]) || (!inside && distance2 > near2)) return;
        nearest[at] = static_cast<float>(distance2);
        put(work, inside, values + at * components, components);
        valid[at] = kThin;
      });
    }
  }
}

void fill(const std::vector<CellValues>& blocks, const ResampleGrid& lattice, float* values, std::uint8_t* valid) {
  const std::size_t components = component_count(blocks);
  for (const CellValues& block : blocks) {
    CellSampler work(block);
    for (vtkIdType id = 0; id < block.data->GetNumberOfCells(); ++id) {
      if (!work.set_cell(id)) continue;
      each_voxel(lattice, span_of(lattice, work.bounds(), 0), [&](std::size_t at, const Vec3& p) {
        double distance2 = 0;
        if (valid[at] != 0 || !work.contains(p, distance2)) return;
        put(work, true, values + at * components, components);
        valid[at] = 1;
      });
    }
  }
  continue_lattice(lattice, components, values, valid);
  continue_cells(blocks, lattice, components, values, valid);
}

/// The cells of a sampling grid that overlap cells of the data.
class Overlap {
 public:
  Overlap(const ResampleGrid& lattice, std::vector<std::uint8_t>& cells) : lattice_(lattice), cells_(cells) {}

  void find(const std::vector<CellValues>& blocks) {
    for (const Test test : {Test::own_points, Test::middles, Test::corners})
      for (const CellValues& block : blocks) {
        CellSampler work(block);
        for (vtkIdType id = 0; id < block.data->GetNumberOfCells(); ++id) {
          double b[6];
          block.data->GetCellBounds(id, b);
          if (!is_open(b) || !work.set_cell(id)) continue;
          if (test == Test::own_points)
            work.for_each_corner([&](const Vec3& p) { mark(p); });
          else
            each_open(b, [&](std::size_t at, const Vec3& lowest) { cells_[at] = overlaps(work, lowest, test) ? 1 : 0; });
        }
      }
  }

 private:
  enum class Test { own_points, middles, corners };

  void mark(const Vec3& p) {
    int base[3];
    double t[3];
    if (CellSamples::locate_voxel_cell(lattice_, p, base, t)) cells_[lattice_.linear_index(base[0], base[1], base[2])] = 1;
  }

  /// Calls visit(index, lowest corner) for the cells within bounds that are not marked.
  template <class Visit>
  void each_open(const double* b, const Visit& visit) const {
    const int n[3] = {lattice_.size.x, lattice_.size.y, lattice_.size.z};
    int lo[3], hi[3];
    for (int a = 0; a < 3; ++a) {
      lo[a] = std::clamp(static_cast<int>(std::floor((b[2 * a] - lattice_.origin[a]) / lattice_.spacing[a])), 0, n[a] - 2);
      hi[a] = std::clamp(static_cast<int>(std::floor((b[2 * a + 1] - lattice_.origin[a]) / lattice_.spacing[a])), 0, n[a] - 2);
    }
    for (int k = lo[2]; k <= hi[2]; ++k)
      for (int j = lo[1]; j <= hi[1]; ++j)
        for (int i = lo[0]; i <= hi[0]; ++i) {
          const std::size_t at = lattice_.linear_index(i, j, k);
          if (cells_[at] == 0) visit(at, lattice_.origin + lattice_.spacing * Vec3(i, j, k));
        }
  }
  bool is_open(const double* b) const {
    bool some = false;
    each_open(b, [&](std::size_t, const Vec3&) { some = true; });
    return some;
  }

  /// Returns whether a position of the data's cell lies within the grid's cell, not on its faces.
  bool overlaps(CellSampler& work, const Vec3& lowest, Test test) const {
    constexpr double kBeside = 0.01;  // fraction of a voxel
    const auto overlaps_at = [&](const Vec3& position) {
      double distance2 = 0;
      if (work.contains(lowest + position * lattice_.spacing, distance2)) return work.strictly_inside();
      bool in = true;
      for (int a = 0; a < 3; ++a) {
        const double at = (work.closest_point()[a] - lowest[a]) / lattice_.spacing[a];
        in = in && at > kBeside && at < 1 - kBeside;
      }
      return in;
    };
    if (test == Test::middles) return overlaps_at(Vec3(0.5));
    for (int c = 0; c < 8; ++c)
      if (overlaps_at({(c & 1) != 0 ? 1 - kBeside : kBeside, (c & 2) != 0 ? 1 - kBeside : kBeside, (c & 4) != 0 ? 1 - kBeside : kBeside}))
        return true;
    return false;
  }

  const ResampleGrid& lattice_;
  std::vector<std::uint8_t>& cells_;
};

/// Makes both masks consistent: a cell is valid only if all its voxels have values, and a voxel only if it is a corner of a valid cell.
void agree(const ResampleGrid& lattice, std::vector<std::uint8_t>& valid, std::vector<std::uint8_t>& cells) {
  std::vector<std::uint8_t> corners(valid.size(), 0);
  for (int k = 0; k < lattice.size.z; ++k)
    for (int j = 0; j < lattice.size.y; ++j)
      for (int i = 0; i < lattice.size.x; ++i) {
        std::uint8_t& cell = cells[lattice.linear_index(i, j, k)];
        if (i + 1 == lattice.size.x || j + 1 == lattice.size.y || k + 1 == lattice.size.z) {
          cell = 1;  // no cell is based at the last voxel
          continue;
        }
        const auto corner = [&](int c) { return lattice.linear_index(i + (c & 1), j + (c >> 1 & 1), k + (c >> 2)); };
        for (int c = 0; c < 8; ++c) cell = cell != 0 && valid[corner(c)] != 0 ? 1 : 0;
        for (int c = 0; c < 8 && cell != 0; ++c) corners[corner(c)] = 1;
      }
  valid = std::move(corners);
}

/// Samples the grid at the positions of the lowest and the highest value.
void find_extremes(const CellSamples& cell_samples, ResampleResult& made, std::size_t components) {
  std::vector<double> read;
  for (const CellSamples::Sample& sample : cell_samples.extremes()) {
    int base[3];
    double t[3], sum[3] = {0, 0, 0};
    if (!CellSamples::locate_voxel_cell(made.grid, sample.position, base, t)) continue;
    for (int k = 0; k < 8; ++k) {
      double weight = 1;
      for (int a = 0; a < 3; ++a) weight *= (k >> a & 1) != 0 ? t[a] : 1 - t[a];
      const std::size_t at = made.grid.linear_index(base[0] + (k & 1), base[1] + (k >> 1 & 1), base[2] + (k >> 2));
      for (std::size_t c = 0; c < components; ++c) sum[c] += weight * static_cast<double>(made.values[at * components + c]);
    }
    read.push_back(components == 1 ? sum[0] : std::hypot(sum[0], sum[1], sum[2]));
  }
  if (read.empty()) return;
  made.min_value = read.front();
  made.max_value = read.back();
}

ResampleError error_of(const CellSamples& cell_samples, const ResampleResult& made, std::size_t components) {
  const ResampleGrid& lattice = made.grid;
  return cell_samples.measure_error(
      lattice, cell_samples.samples(), 1, [&](const CellSamples::Sample&, const int(&base)[3], int k, double* value) {
        const std::size_t at = lattice.linear_index(base[0] + (k & 1), base[1] + (k >> 1 & 1), base[2] + (k >> 2));
        for (std::size_t c = 0; c < components; ++c) value[c] = static_cast<double>(made.values[at * components + c]);
        return made.valid[at] != 0;
      });
}

ResampleGrid finer_than(const ResampleGrid& lattice, double factor) {
  const Vec3 steps(lattice.size.x - 1, lattice.size.y - 1, lattice.size.z - 1);
  return make_resample_grid(lattice.origin, lattice.origin + lattice.spacing * steps, lattice.spacing, 1 / factor);
}

}  // namespace

Result<ResampleResult> resample(const std::vector<CellValues>& blocks, const ResamplePlan& plan, double max_voxels) {
  ResampleResult made;
  made.grid = plan.grid;
  const std::size_t components = component_count(blocks);
  const CellSamples cell_samples(blocks, 2);
  CellFinder within(blocks);
  const Vec3 steps(plan.grid.size.x - 1, plan.grid.size.y - 1, plan.grid.size.z - 1);
  const BoxSamples box(within, plan.grid.origin, plan.grid.origin + plan.grid.spacing * steps, 4);
  const auto finished = [&]() -> ResampleResult {
    made.cells.assign(made.grid.voxel_count(), 0);
    Overlap(made.grid, made.cells).find(blocks);
    agree(made.grid, made.valid, made.cells);
    made.range = cell_samples.range();
    made.shares = box.shares(made.grid, made.cells);
    find_extremes(cell_samples, made, components);
    return std::move(made);
  };
  constexpr int kMaxTimes = 6;
  double last_error = 1e300;
  for (int time = 0; time < kMaxTimes; ++time) {
    made.values.assign(made.grid.voxel_count() * components, 0.f);
    made.valid.assign(made.grid.voxel_count(), 0);
    fill(blocks, made.grid, made.values.data(), made.valid.data());
    made.error = error_of(cell_samples, made, components);
    if (made.error.p99 <= kTargetError) return finished();
    made.refinement_stalled = made.error.p99 > kUsefulErrorRatio * last_error || plan.refinement_stalled;
    if ((made.refinement_stalled || !plan.meets_target) && time > 0) return finished();
    last_error = made.error.p99;
    constexpr double kMinStep = 1.15, kMaxStep = 1.6;
    const double finer = std::clamp(std::sqrt(made.error.p99 / (0.8 * kTargetError)), kMinStep, kMaxStep);
    made.required_voxels = static_cast<double>(made.grid.voxel_count()) * std::pow(made.error.p99 / kTargetError, 1.5);
    ResampleGrid next = finer_than(made.grid, finer);
    if (static_cast<double>(next.voxel_count()) > max_voxels) {
      made.required_voxels = std::max(made.required_voxels, static_cast<double>(next.voxel_count()));
      break;
    }
    if (time + 1 < kMaxTimes) made.grid = next;
  }
  return finished();
}

}  // namespace catena::vtk
