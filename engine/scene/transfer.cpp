#include "engine/scene/transfer.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include "engine/scene/color_maps.h"

namespace catena::scene {
namespace {

constexpr std::size_t kMaxSamples = 1u << 21;
constexpr int kBins = 256;
constexpr double kLowEnd = 0.15, kLowShare = 0.1, kDominantShare = 0.3;  // where the background lies, see transfer.h
constexpr double kMargin = 0.06, kOpticalDepth = 2.5;
constexpr int kRampPoints = 17;

struct Range {
  double lo = 0, hi = 0, background = 0;
};

using Given = std::optional<std::array<double, 2>>;

Range range_of(const std::vector<float>& values, bool masked, const Given& given) {
  const auto percentile = [&](double share) { return values[static_cast<std::size_t>(share * static_cast<double>(values.size() - 1))]; };
  Range range{percentile(0.005), percentile(0.998), 0};
  if (!(range.lo < range.hi)) range = {values.front(), values.back(), 0};
  if (given) range = {(*given)[0], (*given)[1], 0};
  range.background = range.lo;
  if (!(range.lo < range.hi)) return range;

  // the fullest bin: of the low end if that end is well filled, else of all if it dominates
  std::array<std::size_t, kBins> bins{};
  const double scale = kBins / (range.hi - range.lo);
  for (float v : values) ++bins[static_cast<std::size_t>(std::clamp((v - range.lo) * scale, 0.0, kBins - 1.0))];
  const auto low_end = bins.begin() + static_cast<int>(kLowEnd * kBins);
  const auto samples = static_cast<double>(values.size());
  const bool low = static_cast<double>(std::accumulate(bins.begin(), low_end, std::size_t{0})) > kLowShare * samples;
  const auto fullest = std::max_element(bins.begin(), low ? low_end : bins.end());
  if (low || (!masked && static_cast<double>(*fullest) > kDominantShare * samples))
    range.background = range.lo + (static_cast<double>(fullest - bins.begin()) + 0.5) / scale;
  return range;
}

double weight(const Range& range, double value) {
  const double far = std::max(range.hi - range.background, range.background - range.lo);
  if (!(far > 0)) return 1;
  const double x = std::clamp((std::fabs(value - range.background) / far - kMargin) / (1 - kMargin), 0.0, 1.0);
  return x * x * (3 - 2 * x);
}

}  // namespace

void each_block(const field::Box& box, std::size_t most, const TakeBlock& take) {
  const field::Index3 lo{static_cast<int>(box.lo.x), static_cast<int>(box.lo.y), static_cast<int>(box.lo.z)};
  const field::Index3 size{static_cast<int>(box.hi.x - box.lo.x) + 1, static_cast<int>(box.hi.y - box.lo.y) + 1,
                           static_cast<int>(box.hi.z - box.lo.z) + 1};
  const double voxels = static_cast<double>(size.x) * size.y * size.z;
  const int every = std::max(1, static_cast<int>(std::ceil(std::cbrt(voxels / static_cast<double>(most)))));

  for (int z = 0; z < size.z; z += 8 * every)
    for (int y = 0; y < size.y; y += 8 * every)
      for (int x = 0; x < size.x; x += 8 * every) {
        const field::Index3 origin{lo.x + x, lo.y + y, lo.z + z};
        const field::Index3 extent{std::min(8, size.x - x), std::min(8, size.y - y), std::min(8, size.z - z)};
        take(origin, extent, static_cast<std::size_t>(extent.x * extent.y * extent.z));
      }
}

std::vector<float> sample_values(const field::ScalarGrid& grid, std::size_t most) {
  std::vector<float> values, block;
  std::vector<std::uint8_t> valid;
  each_block(grid.index_box(), most, [&](const field::Index3& origin, const field::Index3& extent, std::size_t count) {
    block.resize(count);
    valid.assign(count, 1);
    grid.read_block(origin, extent, block);
    if (grid.has_mask()) grid.read_cell_valid(origin, extent, valid);
    for (std::size_t i = 0; i < count; ++i)
      if (valid[i] != 0 && std::isfinite(block[i])) values.push_back(block[i]);
  });
  return values;
}

std::vector<float> sample_magnitudes(const field::VectorGrid& grid, std::size_t most) {
  std::vector<float> values, block;
  each_block(grid.index_box(), most, [&](const field::Index3& origin, const field::Index3& extent, std::size_t count) {
    block.resize(3 * count);
    grid.read_block(origin, extent, block);
    for (std::size_t i = 0; i < 3 * count; i += 3) {
      const float length = std::hypot(block[i], block[i + 1], block[i + 2]);
      if (std::isfinite(length)) values.push_back(length);
    }
  });
  return values;
}

std::shared_ptr<const std::vector<float>> sorted_values(const field::ScalarGrid& grid) {
  auto values = std::make_shared<std::vector<float>>(sample_values(grid, kMaxSamples));
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
  const std::vector<float>& values = sorted.empty() ? none : sorted;
  const Range range = range_of(values, grid.has_mask(), transfer.named.range);
  const bool flat = !(range.lo < range.hi);

  if (transfer.colors.empty()) {
    const bool all = !transfer.named.map.empty();
    transfer.colors =
        color_table({}, transfer.named, all ? grid.min_value() : range.lo, all ? grid.max_value() : range.hi, kDefaultVolumeMap);
  }
  if (!opaque) return;

  double mean = 0;
  for (float v : values) mean += weight(range, v);
  mean = std::max(mean / static_cast<double>(values.size()), 1e-3);
  const double k = kOpticalDepth / (mean * std::max(grid.length(), 1e-300));
  if (flat) {
    transfer.extinctions.push_back({range.lo, k});
    return;
  }
  for (int i = 0; i < kRampPoints; ++i) {
    const double value = range.lo + (range.hi - range.lo) * i / (kRampPoints - 1);
    transfer.extinctions.push_back({value, k * weight(range, value)});
  }
}

}  // namespace catena::scene
