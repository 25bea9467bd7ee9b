// SPDX-License-Identifier: MIT
#include "engine/scene/auto_transfer.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <span>

#include "engine/base/symlog_scale.h"
#include "engine/scene/color_maps.h"

namespace catena::scene {
namespace {

constexpr std::size_t kMaxSamples = 1u << 21;
constexpr int kBins = 256;
constexpr double kLowEnd = 0.15, kLowShare = 0.1, kDominantShare = 0.3;  // location of the background, see transfer.h
constexpr double kMargin = 0.06, kOpticalDepth = 2.5;
constexpr int kRampPoints = 17;

struct Range {
  double lo = 0, hi = 0, background = 0;
};

using OptionalRange = std::optional<std::array<double, 2>>;

Range range_of(std::span<const float> values, bool masked, const OptionalRange& explicit_range) {
  const auto percentile = [&](double fraction) {
    return values[static_cast<std::size_t>(fraction * static_cast<double>(values.size() - 1))];
  };
  Range range{percentile(0.005), percentile(0.998), 0};
  if (!(range.lo < range.hi)) range = {values.front(), values.back(), 0};
  if (explicit_range) range = {(*explicit_range)[0], (*explicit_range)[1], 0};
  range.background = range.lo;
  if (!(range.lo < range.hi)) return range;

  // the fullest bin: of the low end if the low end is well filled, otherwise of the whole range if that bin dominates
  std::array<std::size_t, kBins> bins{};
  const double scale = kBins / (range.hi - range.lo);
  for (float v : values) ++bins[static_cast<std::size_t>(std::clamp((v - range.lo) * scale, 0.0, kBins - 1.0))];
  const auto low_end = bins.begin() + static_cast<int>(kLowEnd * kBins);
  const auto samples = static_cast<double>(values.size());
  const bool low = static_cast<double>(std::accumulate(bins.begin(), low_end, std::size_t{0})) > kLowShare * samples;
  const auto largest_bin = std::max_element(bins.begin(), low ? low_end : bins.end());
  if (low || (!masked && static_cast<double>(*largest_bin) > kDominantShare * samples))
    range.background = range.lo + (static_cast<double>(largest_bin - bins.begin()) + 0.5) / scale;
  return range;
}

double weight(const Range& range, double value) {
  const double max_distance = std::max(range.hi - range.background, range.background - range.lo);
  if (!(max_distance > 0)) return 1;
  const double x = std::clamp((std::fabs(value - range.background) / max_distance - kMargin) / (1 - kMargin), 0.0, 1.0);
  return x * x * (3 - 2 * x);
}

}  // namespace

std::shared_ptr<const std::vector<float>> sorted_values(const field::ScalarGrid& grid) {
  auto values = std::make_shared<std::vector<float>>(field::sample_values(grid, kMaxSamples));
  std::sort(values->begin(), values->end());
  return values;
}

bool is_complete(const TransferFunction& transfer) {
  return !transfer.colors.empty() && !(transfer.extinctions.empty() && transfer.opacities.empty());
}

void complete_transfer(TransferFunction& transfer, const field::ScalarGrid& grid) {
  if (!is_complete(transfer)) complete_transfer(transfer, grid, *sorted_values(grid));
}

void complete_transfer(TransferFunction& transfer, const field::ScalarGrid& grid, const std::vector<float>& sorted) {
  if (is_complete(transfer)) return;
  const bool opaque = transfer.extinctions.empty() && transfer.opacities.empty();
  const std::vector<float> none{0};
  const DisplayRange& all = display_range(grid);
  const auto first = std::ranges::lower_bound(sorted, static_cast<float>(all.lo)),
             end = std::ranges::upper_bound(sorted, static_cast<float>(all.hi));
  const std::span<const float> values = first < end ? std::span<const float>(first, end) : std::span<const float>(none);
  Range range = range_of(values, grid.has_mask(), transfer.named.range);
  const bool flat = !(range.lo < range.hi);

  if (transfer.colors.empty()) {
    const bool has_map = !transfer.named.map.empty();
    transfer.colors =
        make_color_points({}, transfer.named, has_map ? all.lo : range.lo, has_map ? all.hi : range.hi, kDefaultVolumeColorMap);
  }
  if (!opaque) return;

  // positions on the scale of the value mapping
  const double below = linear_below(transfer.named.mapping, range.lo, range.hi);
  std::vector<float> scaled(values.begin(), values.end());
  if (below > 0 && !flat) {
    for (float& v : scaled) v = static_cast<float>(symlog(v, below));
    range = range_of(scaled, grid.has_mask(), OptionalRange({symlog(range.lo, below), symlog(range.hi, below)}));
  }
  double mean = 0;
  for (float v : scaled) mean += weight(range, v);
  mean = std::max(mean / static_cast<double>(values.size()), 1e-3);
  const double k = kOpticalDepth / (mean * std::max(grid.domain_length(), 1e-300));
  if (flat) {
    transfer.extinctions.push_back({range.lo, k});
    return;
  }
  for (int i = 0; i < kRampPoints; ++i) {
    const double position = range.lo + (range.hi - range.lo) * i / (kRampPoints - 1);
    transfer.extinctions.push_back({symlog_inverse(position, flat ? 0 : below), k * weight(range, position)});
  }
}

}  // namespace catena::scene
