// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <deque>
#include <optional>

#include "engine/io/vtk/cell_samples.h"

namespace catena::vtk {
namespace {

/// Predicts the error of a grid without resampling to it: the grid's nodes are evaluated one by one, directly in the blocks.
class ErrorPredictor {
 public:
  ErrorPredictor(const std::vector<CellValues>& blocks, CellFinder& within) : blocks_(blocks), within_(within), places_(blocks, 1) {
    for (const CellValues& block : blocks) others_.emplace_back(block);
  }
  bool empty() const { return places_.samples().empty(); }
  const std::vector<CellSamples::Sample>& extremes() const { return places_.extremes(); }

  double p99(const ResampleGrid& lattice) { return on(lattice, places_.samples(), kEvery).p99; }
  /// Error at the lowest and the highest value.
  double at_extremes(const ResampleGrid& lattice) { return on(lattice, places_.extremes(), 1).max; }

 private:
  static constexpr std::size_t kEvery = 4;

  ResampleError on(const ResampleGrid& lattice, const std::vector<CellSamples::Sample>& samples, std::size_t every) {
    std::size_t last_block = blocks_.size();
    std::optional<CellSampler> sampler;
    vtkIdType own_cell = -1;
    const auto corner = [&](const CellSamples::Sample& sample, const int(&base)[3], int k, double* value) {
      if (sample.block != last_block) {
        sampler.emplace(blocks_[sample.block]);
        last_block = sample.block;
        own_cell = -1;
      }
      if (sample.cell != own_cell && !sampler->set_cell(sample.cell)) return false;
      own_cell = sample.cell;
      Vec3 p;
      for (int a = 0; a < 3; ++a) p[a] = lattice.origin[a] + lattice.spacing[a] * (base[a] + (k >> a & 1));
      double distance2 = 0;
      const auto [block, cell] = within_.find_cell(p);
      CellSampler& other = others_[block];
      if (cell >= 0 && other.set_cell(cell) && other.contains(p, distance2))
        other.interpolate(true, value);
      else
        sampler->interpolate(sampler->contains(p, distance2), value);
      return true;
    };
    return places_.measure_error(lattice, samples, every, corner);
  }

  const std::vector<CellValues>& blocks_;
  CellFinder& within_;
  CellSamples places_;
  std::deque<CellSampler> others_;  ///< by block
};

constexpr double kMinSteps = 72;    ///< along the longest axis
constexpr double kFewVoxels = 4e5;  ///< maximum number of voxels for reaching kMinSteps

double middle(std::vector<double>& values) {
  const auto at = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), at, values.end());
  return *at;
}

}  // namespace

ResampleGrid make_resample_grid(const Vec3& lo, const Vec3& hi, const Vec3& edges, double factor) {
  ResampleGrid lattice;
  int n[3];
  for (int a = 0; a < 3; ++a) {
    constexpr double kMaxAxis = 1 << 14;
    const double steps = std::clamp(std::ceil((hi[a] - lo[a]) / (edges[a] * factor) - 1e-9), 1.0, kMaxAxis);
    n[a] = static_cast<int>(steps) + 1;
    lattice.spacing[a] = hi[a] > lo[a] ? (hi[a] - lo[a]) / steps : edges[a];
  }
  lattice.size = {n[0], n[1], n[2]};
  lattice.origin = lo;
  return lattice;
}

Result<ResamplePlan> plan_resampling(const std::vector<CellValues>& blocks, double max_voxels) {
  if (blocks.empty()) return Error{"has no cells with a volume"};
  Vec3 lo(1e300), hi(-1e300);
  std::vector<double> extents[3];
  for (const CellValues& block : blocks) {
    CellSampler work(block);
    const vtkIdType cells = block.data->GetNumberOfCells();
    const vtkIdType every = std::max<vtkIdType>(1, cells / CellSamples::kSampleCount);
    for (vtkIdType i = 0; i < cells; ++i) {
      double b[6];
      block.data->GetCellBounds(i, b);
      for (int a = 0; a < 3; ++a) {
        lo[a] = std::min(lo[a], b[2 * a]);
        hi[a] = std::max(hi[a], b[2 * a + 1]);
      }
      if (i % every != 0 || !work.set_cell(i)) continue;
      for (int a = 0; a < 3; ++a) extents[a].push_back(b[2 * a + 1] - b[2 * a]);
    }
  }
  if (!is_finite(lo) || !is_finite(hi)) return Error{"has points that are not finite"};
  if (extents[0].empty()) return Error{"has no cells with a volume"};
  Vec3 edges;
  for (int a = 0; a < 3; ++a) edges[a] = middle(extents[a]);
  const double largest = max_abs(hi - lo);
  for (int a = 0; a < 3; ++a) edges[a] = std::clamp(edges[a], 1e-4 * largest, std::max(largest, 1e-300));
  // the finest grid that fits
  double factor = 1;
  const auto voxels = [&](double f) { return static_cast<double>(make_resample_grid(lo, hi, edges, f).voxel_count()); };
  while (voxels(factor) > max_voxels) factor *= 1.1;
  // a few cells may be represented exactly by a few voxels, but their mask would be a coarse staircase
  const auto steps = [&](double f) {
    const field::Index3 size = make_resample_grid(lo, hi, edges, f).size;
    return std::max({size.x, size.y, size.z}) - 1;
  };
  while (steps(factor) < kMinSteps && voxels(factor / 1.1) <= std::min(max_voxels, kFewVoxels)) factor /= 1.1;
  CellFinder within(blocks);
  ErrorPredictor predictor(blocks, within);
  if (predictor.empty()) return Error{"has no finite values inside the cells"};
  ResamplePlan plan;
  double last_error = 1e300;
  int idle = 0;
  for (;;) {
    plan.grid = make_resample_grid(lo, hi, edges, factor);
    plan.p99 = predictor.p99(plan.grid);
    plan.meets_target = plan.p99 <= kTargetError * 0.9;  // the final error is measured at other positions
    if (plan.meets_target) break;
    // the error decreases with the square of the voxel size, at worst linearly
    constexpr double kMinStep = 1.2, kMaxStep = 2;
    // values that jump from cell to cell do not improve with finer voxels
    idle = plan.p99 > kUsefulErrorRatio * last_error ? idle + 1 : 0;
    last_error = plan.p99;
    constexpr int kIdle = 2;
    if (idle >= kIdle) break;
    const double finer = factor / std::clamp(std::sqrt(plan.p99 / (0.8 * kTargetError)), kMinStep, kMaxStep);
    if (voxels(finer) > max_voxels) break;
    factor = finer;
  }
  if (!plan.meets_target && idle == 0) {  // the finest grid that fits
    while (voxels(factor / 1.1) <= max_voxels) factor /= 1.1;
    plan.grid = make_resample_grid(lo, hi, edges, factor);
    plan.p99 = predictor.p99(plan.grid);
  }
  // cells at the extremes that are small relative to voxels
  if (predictor.at_extremes(plan.grid) > kTargetError) {
    double smallest = 1e300;
    for (const CellSamples::Sample& sample : predictor.extremes()) {
      double b[6];
      blocks[sample.block].data->GetCellBounds(sample.cell, b);
      for (int a = 0; a < 3; ++a) smallest = std::min(smallest, (b[2 * a + 1] - b[2 * a]) / edges[a]);
    }
    for (const double part : {1.0, 2.0, 4.0}) {
      const double finer = smallest / part;
      if (!(finer < factor) || voxels(finer) > max_voxels) continue;
      factor = finer;
      if (predictor.at_extremes(make_resample_grid(lo, hi, edges, factor)) <= kTargetError) break;
    }
  }
  // gaps narrower than voxels
  const BoxSamples box(within, lo, hi, 3);
  constexpr double kFinerInGaps = 1.25;
  while (box.gap_fill_share(make_resample_grid(lo, hi, edges, factor)) > kMaxGapShare && voxels(factor / kFinerInGaps) <= max_voxels)
    factor /= kFinerInGaps;
  plan.grid = make_resample_grid(lo, hi, edges, factor);
  plan.meets_target = plan.meets_target || plan.p99 <= kTargetError;
  plan.refinement_stalled = !plan.meets_target && idle > 0;
  return plan;
}

}  // namespace catena::vtk
