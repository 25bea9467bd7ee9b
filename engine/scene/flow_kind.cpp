#include "engine/scene/flow_kind.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>

#include "engine/base/numbers.h"
#include "engine/scene/transfer.h"

namespace catena::scene {
namespace {

constexpr std::size_t kMostVectors = 1u << 18;
constexpr std::size_t kParts = 3;                                               // an axis: each gives a start
constexpr double kOpposite = -0.5, kOppositeShare = 0.001, kRandomSigns = 0.3;  // of neighbours: the cosine, and how many
constexpr double kUnitSpread = 0.02;                                            // of unit vectors' lengths

double share_above(const std::vector<float>& values, double least) {
  const auto many = std::count_if(values.begin(), values.end(), [&](float v) { return v >= least; });
  return values.empty() ? 0 : static_cast<double>(many) / static_cast<double>(values.size());
}

}  // namespace

FlowFacts flow_facts(const field::VectorGrid& grid) {
  FlowFacts facts;
  std::vector<float> speeds, block;
  std::size_t pairs = 0, opposite = 0;
  std::array<std::pair<double, Vec3>, kParts * kParts * kParts> fastest{};
  const field::Box& box = grid.index_box();
  field::Cursor cursor;
  const DisplayRange& range = display_range(grid);
  field::each_block(grid.index_box(), kMostVectors, [&](const field::Index3& origin, const field::Index3& extent, std::size_t count) {
    block.resize(3 * count);
    grid.read_block(origin, extent, block);
    const auto vector = [&](std::size_t i) { return Vec3(block[3 * i], block[3 * i + 1], block[3 * i + 2]); };
    for (std::size_t i = 0; i < count; ++i) {
      const Vec3 v = vector(i);
      const double speed = norm(v);
      if (!range.shows(speed)) continue;
      const field::Index3 at{origin.x + static_cast<int>(i) % extent.x, origin.y + static_cast<int>(i) / extent.x % extent.y,
                             origin.z + static_cast<int>(i) / (extent.x * extent.y)};
      if (grid.has_mask() && !grid.cell(at, cursor).valid) continue;
      speeds.push_back(static_cast<float>(speed));
      const Vec3 place(at.x, at.y, at.z);
      std::size_t part = 0;
      for (int a = 2; a >= 0; --a)
        part = kParts * part + static_cast<std::size_t>(kParts * (place[a] - box.lo[a]) / (box.hi[a] - box.lo[a] + 1));
      if (speed > fastest[part].first) fastest[part] = {speed, place};
      if (static_cast<int>(i) % extent.x + 1 == extent.x) continue;
      const Vec3 next = vector(i + 1);
      if (!(speed > 0) || !(norm(next) > 0) || !range.shows(norm(next))) continue;
      ++pairs;
      opposite += dot(v, next) < kOpposite * speed * norm(next);
    }
  });
  for (const auto& [speed, place] : fastest)
    if (speed > 0) facts.fastest.push_back(grid.mapping().world_from_index(place));
  std::vector<float> moving;  // what is empty has no length to compare
  std::copy_if(speeds.begin(), speeds.end(), std::back_inserter(moving), [](float v) { return v > 0; });
  facts.slow = quantile(moving, 0.02);
  facts.middle = quantile(speeds, 0.5);
  facts.fast = quantile(speeds, 0.99);
  if (!(facts.fast > 0)) facts.fast = quantile(speeds, 1);
  facts.moving = share_above(speeds, kStill * facts.fast);
  const double longest = moving.empty() ? 0 : quantile(moving, 0.99);
  facts.unit = longest > 0 && longest - facts.slow < kUnitSpread * longest;
  facts.axes = double(opposite) > (facts.unit ? kOppositeShare : kRandomSigns) * double(pairs);
  return facts;
}

}  // namespace catena::scene
