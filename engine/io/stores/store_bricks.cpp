// SPDX-License-Identifier: MIT
#include "engine/io/stores/store_bricks.h"

#include <cmath>
#include <cstring>
#include <limits>
#include <type_traits>

namespace catena::field {
namespace {

std::vector<BrickLevel> levels_of(const StoreGrid& grid) {
  std::vector<BrickLevel> levels;
  for (const StoreLevel& level : grid.levels) levels.push_back({level.size, level.mapping});
  return levels;
}

/// Returns the range of the finite numbers of one type.
template <class T>
BrickRange range_of(std::span<const std::byte> values) {
  T lo = std::numeric_limits<T>::max(), hi = std::numeric_limits<T>::lowest();
  for (std::size_t at = 0; at + sizeof(T) <= values.size(); at += sizeof(T)) {
    T value;
    std::memcpy(&value, values.data() + at, sizeof value);
    if constexpr (std::is_floating_point_v<T>)
      if (!std::isfinite(value)) continue;
    lo = value < lo ? value : lo;
    hi = value > hi ? value : hi;
  }
  if (lo > hi) return {true, true, std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity()};
  return {true, true, static_cast<double>(lo), static_cast<double>(hi)};
}

BrickRange range_of(std::string_view type, std::span<const std::byte> values) {
  if (type == "float32") return range_of<float>(values);
  if (type == "float64") return range_of<double>(values);
  if (type == "uint8") return range_of<std::uint8_t>(values);
  if (type == "int8") return range_of<std::int8_t>(values);
  if (type == "uint16") return range_of<std::uint16_t>(values);
  if (type == "int16") return range_of<std::int16_t>(values);
  if (type == "uint32") return range_of<std::uint32_t>(values);
  if (type == "int32") return range_of<std::int32_t>(values);
  if (type == "uint64") return range_of<std::uint64_t>(values);
  return range_of<std::int64_t>(values);
}

}  // namespace

StoreBricks::StoreBricks(std::shared_ptr<Store> store, int grid, int step)
    : BrickSource(*find_number_type(store->description().grids[static_cast<std::size_t>(grid)].type),
                  levels_of(store->description().grids[static_cast<std::size_t>(grid)])),
      store_(std::move(store)),
      grid_(grid),
      step_(step),
      fill_value_(store_->description().grids[static_cast<std::size_t>(grid)].fill_value) {
  for (std::size_t level = 0; level < levels().size(); ++level) ranges_.push_back(std::make_unique<Ranges>());
}

std::uint64_t StoreBricks::number_of(const BrickLevel& level, const Index3& brick) {
  const Index3 n = brick_counts(level);
  return (static_cast<std::uint64_t>(brick.z) * static_cast<std::uint64_t>(n.y) + static_cast<std::uint64_t>(brick.y)) *
             static_cast<std::uint64_t>(n.x) +
         static_cast<std::uint64_t>(brick.x);
}

BrickRange StoreBricks::range(int level, const Index3& brick) const noexcept {
  Ranges& ranges = *ranges_[static_cast<std::size_t>(level)];
  const std::uint64_t number = number_of(levels()[static_cast<std::size_t>(level)], brick);
  const std::scoped_lock lock(ranges.mutex);
  if (!ranges.present.empty() && ranges.present[number] == 0) return {true, false, fill_value_, fill_value_};
  const auto found = ranges.known.find(number);
  return found == ranges.known.end() ? BrickRange{} : found->second;
}

Outcome StoreBricks::read(int level, const Index3& brick, std::span<std::byte> values) const {
  const BrickLevel& at = levels()[static_cast<std::size_t>(level)];
  const StoreBox box{{brick.x * kBrickEdge, brick.y * kBrickEdge, brick.z * kBrickEdge}, brick_size(at, brick)};
  CATENA_CHECK(store_->read(grid_, level, step_, box, values));
  if (this->range(level, brick).is_known) return Done{};
  const BrickRange range = range_of(type().name, values);
  Ranges& ranges = *ranges_[static_cast<std::size_t>(level)];
  const std::scoped_lock lock(ranges.mutex);
  ranges.known.insert_or_assign(number_of(at, brick), range);
  return Done{};
}

Outcome StoreBricks::find_empty_bricks(int level) const {
  CATENA_TRY(std::vector<std::uint8_t> present, store_->list(grid_, level, step_));
  Ranges& ranges = *ranges_[static_cast<std::size_t>(level)];
  const std::scoped_lock lock(ranges.mutex);
  ranges.present = std::move(present);
  return Done{};
}

}  // namespace catena::field
