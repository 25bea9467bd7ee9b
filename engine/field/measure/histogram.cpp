// SPDX-License-Identifier: MIT
#include "engine/field/measure/histogram.h"

#include <algorithm>
#include <cmath>
#include <functional>

#include "engine/field/measure/slabs.h"

namespace catena::field {
namespace {

struct HistogramPart {
  std::vector<std::uint64_t> counts;
  std::uint64_t below = 0, above = 0;
  Moments values;
};

/// Returns the bin of a value within the range.
std::size_t bin_of(double value, const std::vector<double>& edges) {
  const auto bins = static_cast<double>(edges.size() - 1);
  const double position = (value - edges.front()) / (edges.back() - edges.front()) * bins;
  auto bin = static_cast<std::size_t>(std::min(position, bins - 1));
  // rounding may have moved the value across an edge
  if (value < edges[bin])
    --bin;
  else if (bin + 2 < edges.size() && value >= edges[bin + 1])
    ++bin;
  return bin;
}

}  // namespace

Result<Histogram> make_histogram(const ScalarGrid& grid, int bins, std::optional<std::pair<double, double>> range) {
  CATENA_ASSERT(bins >= 1 && bins <= kMaxHistogramBins);
  CATENA_TRY(const VoxelBox box, measurable_box(grid));
  auto [lo, hi] = range.value_or(std::pair{grid.stats().min, grid.stats().max});
  if (lo == hi) lo -= 0.5, hi += 0.5;
  if (!std::isfinite(hi - lo) || !(lo < hi)) return Error{"the range is too wide or too narrow for a histogram"};
  Histogram made;
  made.left_out = left_out(grid, box);
  for (int n = 0; n <= bins; ++n) made.edges.push_back(n == bins ? hi : lo + n * ((hi - lo) / bins));
  if (std::ranges::adjacent_find(made.edges, std::greater_equal<>()) != made.edges.end())
    return Error{"the range is too narrow for so many bins"};
  made.counts.assign(static_cast<std::size_t>(bins), 0);
  const SlabReader reader(grid, box, nullptr);
  for_slabs<HistogramPart>(
      box.size.z,
      [&](int z, int layers) {
        HistogramPart part{std::vector<std::uint64_t>(made.counts.size(), 0), 0, 0, {}};
        const VoxelSlab slab = reader.read(z, layers);
        for (std::size_t i = 0; i < slab.voxels.size(); ++i) {
          if (slab.counted[i] == 0) continue;
          const double value = slab.voxels[i];
          part.values.add(value);
          if (value < lo)
            ++part.below;
          else if (value > hi)
            ++part.above;
          else
            ++part.counts[bin_of(value, made.edges)];
        }
        return part;
      },
      [&](HistogramPart&& part) {
        for (std::size_t n = 0; n < part.counts.size(); ++n) made.counts[n] += part.counts[n];
        made.below += part.below;
        made.above += part.above;
        made.values.merge(part.values);
      });
  return made;
}

}  // namespace catena::field
