// SPDX-License-Identifier: MIT
#include "engine/scene/classify_scalar.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <numeric>
#include <unordered_set>

#include "engine/base/numbers.h"
#include "engine/scene/auto_transfer.h"

namespace catena::scene {
namespace {

constexpr std::size_t kMaxVoxels = 1u << 20;
constexpr int kKindBins = 256, kEdge = 8;
constexpr int kMaxLabels = 2048;
constexpr double kAsGood = 0.995;  // fraction of the best between-class variance
// background, see data_kind.h
constexpr double kBackgroundFull = 0.05, kBackgroundEnd = 0.2, kBackgroundWidth = 0.02;
// level sets
constexpr double kUnitSlope = 0.05, kUnitSlopes = 0.9;
// Hounsfield units
constexpr double kAirLo = -1100, kAirHi = -850, kSoftLo = -150, kSoftHi = 200, kTissueShare = 0.05, kMinHounsfield = -5000;
constexpr double kEqualNeighbours = 0.6;
constexpr double kRegions = 0.4;  // fraction of equal neighbors: 1/2 in regions one voxel thick, 1/3 in random labels
// solids: values on two plateaus
constexpr double kPlateau = 0.1, kPlateaus = 0.9, kMinPlateau = 0.02;
// scans
constexpr double kBrightFrom = 0.3, kBrightLeast = 0.0002, kBrightMost = 0.04, kRough = 0.6;
constexpr double kEmpty = 0.6;
constexpr double kEitherSign = 0.05, kStrongQuantile = 0.95;                           // statistics
constexpr double kDecadeSpread = std::numbers::e, kDecadeTail = 10;                    // decades
constexpr double kNoisy = 1.2, kSeparated = 0.7, kCorrelated = 0.3, kTwoLevels = 0.9;  // two phases

/// Sums over pairs of neighboring voxels in the sampled blocks.
struct Neighbours {
  double first = 0, second = 0;
  std::array<std::size_t, 3> pairs{}, equal{};  // by axis: pairs with both voxels in the foreground
  std::size_t touching = 0;                     // pairs with at least one voxel in the foreground
  std::size_t slopes = 0, unit_slopes = 0;
  double products = 0, squares = 0;  // of deviations from the mean: two voxels apart, and of a voxel with itself
};

double share(std::size_t part, std::size_t all) { return all == 0 ? 0 : static_cast<double>(part) / static_cast<double>(all); }

/// Histogram of the values over [lo, hi].
using Bins = std::array<std::size_t, kKindBins>;

int bin_of(double value, double lo, double hi) {
  return static_cast<int>(std::clamp((value - lo) / (hi - lo) * kKindBins, 0.0, kKindBins - 1.0));
}

/// Otsu's threshold: the last bin of the lower class where the between-class variance is largest. The middle of all bins within
/// kAsGood of that maximum, as in a gap between the classes.
struct OtsuThreshold {
  int bin;            // last bin of the lower class
  double separation;  // between-class variance / variance
};
OtsuThreshold find_otsu_threshold(const Bins& bins) {
  double all = 0, sum = 0, squares = 0;
  for (int i = 0; i < kKindBins; ++i) all += double(bins[i]), sum += i * double(bins[i]), squares += double(i) * i * double(bins[i]);
  double below = 0, below_sum = 0, best = -1;
  std::array<double, kKindBins> variance{};
  for (int i = 0; i + 1 < kKindBins; ++i) {
    below += double(bins[i]);
    below_sum += double(i) * double(bins[i]);
    if (!(below > 0) || !(below < all)) continue;
    const double mean_distance = below_sum / below - (sum - below_sum) / (all - below);
    variance[i] = below * (all - below) * mean_distance * mean_distance;
    best = std::max(best, variance[i]);
  }
  const auto is_best = [&](double between) { return between >= kAsGood * best; };
  const auto first = std::find_if(variance.begin(), variance.end(), is_best);
  const auto last = std::find_if(variance.rbegin(), variance.rend(), is_best).base() - 1;
  const double spread = all * squares - sum * sum;
  return {static_cast<int>((first - variance.begin() + (last - variance.begin())) / 2), spread > 0 ? best / spread : 0};
}

void measure_values(std::vector<float>& values, ScalarStats& facts) {
  const std::size_t n = values.size();
  std::unordered_set<float> distinct;
  facts.is_integral = true;
  facts.min_value = values.front();
  std::size_t air = 0, soft = 0, negative = 0;
  std::vector<float> magnitudes;
  for (const float v : values) {
    facts.min_value = std::min(facts.min_value, double(v));
    if (v != std::nearbyint(v)) facts.is_integral = false;
    if (distinct.size() <= kMaxLabels) distinct.insert(v);
    negative += v < 0;
    if (v != 0) magnitudes.push_back(std::fabs(v));
    air += v >= kAirLo && v <= kAirHi;
    soft += v >= kSoftLo && v <= kSoftHi;
  }
  facts.distinct_values = static_cast<int>(distinct.size());
  facts.air_share = share(air, n);
  facts.soft_share = share(soft, n);
  facts.empty_share = share(static_cast<std::size_t>(std::count(values.begin(), values.end(), static_cast<float>(facts.min_value))), n);
  facts.lo = quantile(values, 0.001);
  facts.hi = quantile(values, 0.999);
  facts.negative_share = share(negative, magnitudes.size());
  if (!magnitudes.empty()) facts.strong_magnitude = quantile(magnitudes, kStrongQuantile);
  facts.low = quantile(values, 0.16);
  facts.median = quantile(values, 0.5);
  facts.high = quantile(values, 0.84);
  facts.brightest = quantile(values, 0.9999);
  facts.background = facts.threshold = facts.lo;
  if (!(facts.lo < facts.hi)) return;

  Bins bins{};
  for (const float v : values) ++bins[bin_of(v, facts.lo, facts.hi)];
  const auto largest_bin = std::max_element(bins.begin(), bins.end()) - bins.begin();
  if (share(bins[largest_bin], n) > kBackgroundFull && double(largest_bin) < kBackgroundEnd * kKindBins)
    facts.background = facts.lo + (double(largest_bin) + 0.5) / kKindBins * (facts.hi - facts.lo);
  const OtsuThreshold otsu = find_otsu_threshold(bins);
  facts.threshold = facts.lo + (otsu.bin + 1.0) / kKindBins * (facts.hi - facts.lo);
  facts.separation = otsu.separation;

  for (const float v : values) facts.mean += std::clamp(double(v), facts.lo, facts.hi) / static_cast<double>(n);
  const double bright_threshold = facts.background + kBrightFrom * (facts.brightest - facts.background);
  if (bright_threshold > facts.lo) {
    Bins below{};
    for (const float v : values)
      if (v <= bright_threshold) ++below[bin_of(v, facts.lo, bright_threshold)];
    const OtsuThreshold body = find_otsu_threshold(below);
    facts.body_threshold = facts.lo + (body.bin + 1.0) / kKindBins * (bright_threshold - facts.lo);
    facts.body_separation = body.separation;
  }
  std::size_t near_background = 0, low = 0, high = 0, bright = 0;
  const double width = kBackgroundWidth * (facts.hi - facts.lo), tenth = kPlateau * (facts.hi - facts.lo);
  for (const float v : values) {
    near_background += std::fabs(v - facts.background) < width;
    low += v <= facts.lo + tenth;
    high += v >= facts.hi - tenth;
    bright += v > bright_threshold;
  }
  facts.background_share = share(near_background, n);
  facts.bright_share = share(bright, n);
  if (share(low, n) >= kMinPlateau && share(high, n) >= kMinPlateau) facts.plateau_share = share(low + high, n);
}

/// Adds the neighbor pairs of one block of 8^3 voxels to `sums`; invalid values are NaN.
void measure_neighbours(const std::vector<float>& block, const field::Mapping& mapping, const ScalarStats& facts, Neighbours& sums) {
  const double width = kBackgroundWidth * (facts.hi - facts.lo);
  const auto at = [&](int x, int y, int z) { return double(block[static_cast<std::size_t>((z * kEdge + y) * kEdge + x)]); };
  const auto is_foreground = [&](double v) { return std::fabs(v - facts.background) >= width; };
  for (int z = 0; z < kEdge; ++z)
    for (int y = 0; y < kEdge; ++y)
      for (int x = 0; x + 2 < kEdge; ++x) {
        const double a = at(x, y, z), b = at(x + 1, y, z), c = at(x + 2, y, z);
        if (!std::isfinite(a) || !std::isfinite(b) || !std::isfinite(c)) continue;
        sums.products += (a - facts.mean) * (c - facts.mean);
        sums.squares += 0.5 * ((a - facts.mean) * (a - facts.mean) + (c - facts.mean) * (c - facts.mean));
        if (!is_foreground(b)) continue;
        sums.first += 0.5 * (std::fabs(b - a) + std::fabs(c - b));
        sums.second += std::fabs(a - 2 * b + c);
      }
  const auto compare = [&](int axis, double a, double b) {
    if (!std::isfinite(a) || !std::isfinite(b)) return;
    sums.touching += is_foreground(a) || is_foreground(b);
    if (!is_foreground(a) || !is_foreground(b)) return;
    ++sums.pairs[axis];
    sums.equal[axis] += a == b;
  };
  for (int k = 0; k < kEdge; ++k)
    for (int j = 0; j < kEdge; ++j)
      for (int i = 0; i + 1 < kEdge; ++i) {
        compare(0, at(i, j, k), at(i + 1, j, k));
        compare(1, at(j, i, k), at(j, i + 1, k));
        compare(2, at(j, k, i), at(j, k, i + 1));
      }
  for (int z = 1; z + 1 < kEdge; z += 2)
    for (int y = 1; y + 1 < kEdge; y += 2)
      for (int x = 1; x + 1 < kEdge; x += 2) {
        const Vec3 slope(at(x + 1, y, z) - at(x - 1, y, z), at(x, y + 1, z) - at(x, y - 1, z), at(x, y, z + 1) - at(x, y, z - 1));
        const double length = norm(mapping.world_from_index_gradient(0.5 * slope));
        if (!std::isfinite(length) || length == 0) continue;
        ++sums.slopes;
        sums.unit_slopes += std::fabs(length - 1) <= kUnitSlope;
      }
}

}  // namespace

ScalarStats compute_scalar_stats(const field::ScalarGrid& grid, const field::Units& units) {
  ScalarStats facts;
  facts.is_level_set = units.is_level_set;
  facts.is_hounsfield = units.value == "HU";
  facts.is_patient_space = units.is_patient_space;
  facts.is_label_map = units.is_label_map;
  facts.has_mask = grid.has_mask();

  // complete blocks, distributed over the box; blocks that extend beyond the box are omitted
  std::vector<float> blocks, block(kEdge * kEdge * kEdge), values;
  std::vector<std::uint8_t> valid(block.size());
  const DisplayRange& range = display_range(grid);
  field::for_sampled_blocks(grid.index_box(), kMaxVoxels, [&](const field::Index3& origin, const field::Index3& extent, std::size_t count) {
    block.assign(block.size(), 0.f);
    const std::span<float> part(block.data(), count);
    grid.read_block(origin, extent, part);
    if (facts.has_mask) {
      grid.read_cell_validity(origin, extent, valid);
      for (std::size_t i = 0; i < count; ++i)
        if (valid[i] == 0) block[i] = NAN;
    }
    for (float& v : part) {
      if (!range.contains(v)) v = NAN;
      if (std::isfinite(v)) values.push_back(v);
    }
    if (count == block.size()) blocks.insert(blocks.end(), block.begin(), block.end());
  });
  if (values.empty()) return facts;
  measure_values(values, facts);

  Neighbours sums;
  for (std::size_t i = 0; i < blocks.size(); i += block.size()) {
    std::copy_n(blocks.begin() + static_cast<std::ptrdiff_t>(i), block.size(), block.begin());
    measure_neighbours(block, grid.mapping(), facts, sums);
  }
  facts.equal_share = 1;
  for (int axis = 0; axis < 3; ++axis) facts.equal_share = std::min(facts.equal_share, share(sums.equal[axis], sums.pairs[axis]));
  facts.region_share = share(std::accumulate(sums.equal.begin(), sums.equal.end(), std::size_t{0}), sums.touching);
  facts.roughness = sums.first > 0 ? sums.second / sums.first : 0;
  facts.correlation = sums.squares > 0 ? sums.products / sums.squares : 0;
  facts.distance_share = share(sums.unit_slopes, sums.slopes);
  return facts;
}

DataKind classify_scalar(const ScalarStats& f) {
  const bool is_rough = f.roughness >= kRough;
  const bool both_signs = f.lo < 0 && f.hi > 0;
  if (f.is_label_map && f.is_integral && f.distinct_values > 1) return DataKind::label_map;
  if (f.is_level_set || (both_signs && f.distance_share >= kUnitSlopes)) return DataKind::level_set;
  if (f.is_hounsfield) return DataKind::ct;
  if (f.min_value >= kMinHounsfield && f.air_share >= kTissueShare && f.soft_share >= kTissueShare) return DataKind::ct;
  if (f.is_integral && f.distinct_values > 1 && f.distinct_values <= kMaxLabels && f.equal_share >= kEqualNeighbours &&
      f.region_share >= kRegions)
    return DataKind::label_map;
  if (f.is_patient_space && !f.is_integral && f.negative_share >= kEitherSign && f.negative_share <= 1 - kEitherSign)
    return DataKind::statistic;
  if (f.plateau_share >= kPlateaus || (!f.is_integral && f.equal_share >= kEqualNeighbours)) return DataKind::solid;
  if (!f.is_patient_space && !f.has_mask && f.min_value >= 0 && f.min_value < f.hi && f.empty_share >= kEmpty) return DataKind::cloud;
  const bool has_decades =
      f.low > 0 && (f.high >= kDecadeSpread * f.median || f.median >= kDecadeSpread * f.low) && f.brightest >= kDecadeTail * f.median;
  if (!f.is_patient_space && is_rough && f.min_value >= 0 && has_decades) return DataKind::decades;
  const bool has_bright_parts = f.bright_share >= kBrightLeast && f.bright_share <= kBrightMost;
  if (!f.is_patient_space && is_rough && has_bright_parts && f.body_separation >= kTwoLevels) return DataKind::inclusions;
  if (is_rough && has_bright_parts) return DataKind::angiogram;
  if (f.is_patient_space && is_rough) return DataKind::mr;
  if (f.roughness >= kNoisy && f.separation >= kSeparated && f.correlation >= kCorrelated) return DataKind::two_phases;
  return DataKind::simulation;
}

std::string_view to_string(DataKind kind) {
  constexpr std::string_view words[] = {"a level set",
                                        "a CT",
                                        "a label map",
                                        "a statistic",
                                        "a solid body",
                                        "a quantity over several powers of ten",
                                        "a body with inclusions",
                                        "an angiogram",
                                        "an MR scan",
                                        "a cloud",
                                        "two phases",
                                        "a simulation"};
  return words[static_cast<int>(kind)];
}

std::string explain_kind(DataKind kind, const ScalarStats& f) {
  const auto percent = [](double part) { return fmt::format("{:.3g} %", 100 * part); };
  switch (kind) {
    case DataKind::level_set:
      return f.is_level_set
                 ? "the file declares it"
                 : "the values have both signs, and the gradient magnitude is 1 at " + percent(f.distance_share) + " of the positions";
    case DataKind::ct:
      return f.is_hounsfield
                 ? "the unit is HU"
                 : percent(f.air_share) + " of the values are near -1000 (air) and " + percent(f.soft_share) + " near 0 (soft tissue)";
    case DataKind::label_map:
      if (f.is_label_map) return "the file declares it";
      return fmt::format("the values are {} different integers, and {} of the neighbours outside the background are equal",
                         f.distinct_values, percent(f.region_share));
    case DataKind::solid:
      return f.plateau_share >= kPlateaus ? percent(f.plateau_share) + " of the values are near the ends of the range"
                                          : percent(f.equal_share) + " of all neighbours are equal";
    case DataKind::statistic:
      return "the values are in patient space, and " + percent(f.negative_share) + " of those other than 0 are negative";
    case DataKind::decades:
      return fmt::format("the median is {}, but a few values are above {}", format_readable(f.median), format_readable(f.brightest));
    case DataKind::inclusions:
      return percent(f.bright_share) + " of the values are bright, and the others are on both sides of " +
             format_readable(f.body_threshold);
    case DataKind::two_phases:
      return fmt::format("the data are noisy, and a threshold of {} explains {} of their variance", format_readable(f.threshold),
                         percent(f.separation));
    case DataKind::angiogram:
      return "only " + percent(f.bright_share) + " of the values are bright, and the data are rough";
    case DataKind::mr:
      return fmt::format("the data are in patient space, have no known value scale and are rough ({:.2f})", f.roughness);
    case DataKind::cloud:
      return percent(f.empty_share) + " of the box is empty";
    case DataKind::simulation:
      return fmt::format("the values fill the domain (roughness {:.2f})", f.roughness);
  }
  return {};
}

}  // namespace catena::scene
