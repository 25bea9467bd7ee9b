// SPDX-License-Identifier: MIT
#include "engine/scene/classify_vector.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>

#include "engine/base/numbers.h"
#include "engine/scene/auto_transfer.h"

namespace catena::scene {
namespace {

constexpr std::size_t kMaxVectors = 1u << 18;
constexpr std::size_t kParts = 3;  // parts of the domain along each axis; each contributes its fastest point
// neighbors are opposite below the cosine kOpposite; minimum fractions of such pairs in a line field
constexpr double kOpposite = -0.5, kOppositeShare = 0.001, kRandomSigns = 0.3;
constexpr double kUnitSpread = 0.02;  // relative spread of the lengths of unit vectors

double share_above(const std::vector<float>& values, double minimum) {
  const auto count_above = std::count_if(values.begin(), values.end(), [&](float v) { return v >= minimum; });
  return values.empty() ? 0 : static_cast<double>(count_above) / static_cast<double>(values.size());
}

}  // namespace

VectorStats compute_vector_stats(const field::VectorGrid& grid) {
  VectorStats facts;
  std::vector<float> speeds, block;
  std::size_t pairs = 0, opposite = 0;
  std::array<std::pair<double, Vec3>, kParts * kParts * kParts> fastest{};
  const field::Box& box = grid.index_box();
  field::Cursor cursor;
  const DisplayRange& range = display_range(grid);
  field::for_sampled_blocks(
      grid.index_box(), kMaxVectors, [&](const field::Index3& origin, const field::Index3& extent, std::size_t count) {
        block.resize(3 * count);
        grid.read_block(origin, extent, block);
        const auto vector = [&](std::size_t i) { return Vec3(block[3 * i], block[3 * i + 1], block[3 * i + 2]); };
        for (std::size_t i = 0; i < count; ++i) {
          const Vec3 v = vector(i);
          const double speed = norm(v);
          if (!range.contains(speed)) continue;
          const field::Index3 at{origin.x + static_cast<int>(i) % extent.x, origin.y + static_cast<int>(i) / extent.x % extent.y,
                                 origin.z + static_cast<int>(i) / (extent.x * extent.y)};
          if (grid.has_mask() && !grid.cell(at, cursor).valid) continue;
          speeds.push_back(static_cast<float>(speed));
          const Vec3 position(at.x, at.y, at.z);
          std::size_t part = 0;
          for (int a = 2; a >= 0; --a)
            part = kParts * part + static_cast<std::size_t>(kParts * (position[a] - box.lo[a]) / (box.hi[a] - box.lo[a] + 1));
          if (speed > fastest[part].first) fastest[part] = {speed, position};
          if (static_cast<int>(i) % extent.x + 1 == extent.x) continue;
          const Vec3 next = vector(i + 1);
          if (!(speed > 0) || !(norm(next) > 0) || !range.contains(norm(next))) continue;
          ++pairs;
          opposite += dot(v, next) < kOpposite * speed * norm(next);
        }
      });
  for (const auto& [speed, position] : fastest)
    if (speed > 0) facts.fastest_points.push_back(grid.mapping().world_from_index(position));
  std::vector<float> moving;  // lengths of the nonzero vectors
  std::copy_if(speeds.begin(), speeds.end(), std::back_inserter(moving), [](float v) { return v > 0; });
  facts.slow_speed = quantile(moving, 0.02);
  facts.median_speed = quantile(speeds, 0.5);
  facts.fast_speed = quantile(speeds, 0.99);
  if (!(facts.fast_speed > 0)) facts.fast_speed = quantile(speeds, 1);
  facts.moving_share = share_above(speeds, kStillSpeedRatio * facts.fast_speed);
  const double longest = moving.empty() ? 0 : quantile(moving, 0.99);
  facts.is_unit_length = longest > 0 && longest - facts.slow_speed < kUnitSpread * longest;
  facts.is_line_field = double(opposite) > (facts.is_unit_length ? kOppositeShare : kRandomSigns) * double(pairs);
  return facts;
}

}  // namespace catena::scene
