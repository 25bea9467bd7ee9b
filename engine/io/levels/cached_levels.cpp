// SPDX-License-Identifier: MIT
#include "engine/io/levels/cached_levels.h"

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <optional>
#include <utility>

#include "engine/base/text.h"
#include "engine/io/levels/index_file.h"
#include "engine/io/zarr/brick_values.h"
#include "engine/io/zarr/zarr_metadata.h"

namespace catena::field {

std::shared_ptr<const CachedLevels> CachedLevels::open(const std::string& folder, const std::string& identity,
                                                       const std::vector<StoreLevel>& own) {
  std::optional<BrickIndex> index = read_index(folder + kIndexName, identity);
  if (!index) return nullptr;
  std::shared_ptr<CachedLevels> cached(new CachedLevels(folder, std::move(*index)));
  std::vector<BrickLevel> indexed;
  std::error_code code;
  if (std::filesystem::exists(folder + kStoreName, code)) {
    if (cached->index_.first_level + 1 != static_cast<int>(own.size())) return nullptr;
    indexed = halved_levels(own.back().size, own.back().mapping);
    if (!cached->open_store(indexed)) return nullptr;
  } else {
    if (cached->index_.first_level != 0) return nullptr;
    for (const StoreLevel& level : own) indexed.push_back({level.size, level.mapping});
  }
  const std::vector<LevelIndex>& known = cached->index_.levels;
  const auto has_counts = [](const LevelIndex& level, const BrickLevel& of) { return level.counts() == brick_counts(of); };
  return std::ranges::equal(known, indexed, has_counts) ? cached : nullptr;
}

/// Opens the store of the levels after the first one of `expected`; returns whether it has these.
bool CachedLevels::open_store(const std::vector<BrickLevel>& expected) {
  auto store = Store::open(folder_ + kStoreName, /*is_input=*/false);
  if (!store || (*store)->description().grids.size() != 1) return false;
  store_ = std::move(*store);
  const StoreGrid& grid = store_->description().grids.front();
  if (grid.levels.size() + 1 != expected.size()) return false;
  for (std::size_t level = 1; level < expected.size(); ++level) {
    const StoreLevel& stored = grid.levels[level - 1];
    if (!(stored.size == expected[level].size)) return false;
    levels_.push_back({stored.size, stored.chunk, expected[level].mapping});
  }
  type_ = *find_number_type(grid.type);
  fill_.resize(type_.bytes);
  fill_brick(type_, index_.fill_value, fill_);
  return true;
}

Outcome CachedLevels::read_brick(int level, const Index3& brick, std::span<std::byte> values) const {
  const BrickLevel at{levels_[static_cast<std::size_t>(level)].size, {}};
  const LevelIndex& index = index_.levels[static_cast<std::size_t>(level) + 1];
  const std::uint64_t number = brick_number(index.counts(), brick);
  if (!index.has_data(number)) {
    for (std::size_t i = 0; i < values.size(); i += fill_.size()) std::ranges::copy(fill_, values.begin() + static_cast<std::ptrdiff_t>(i));
    return Done{};
  }
  const Index3 size = brick_size(at, brick);
  const StoreBox box{{brick.x * kBrickEdge, brick.y * kBrickEdge, brick.z * kBrickEdge}, size};
  const Outcome read = store_->read(0, level, 0, box, values);
  if (read && brick_checksum(type_.bytes, values, size, size) == index.checksum(number)) return Done{};
  if (!read && read.error().system_failure) return read;
  is_damaged_ = true;
  std::remove((folder_ + kIndexName).c_str());
  return Error{one_line(folder_) +
               ": the levels in this folder of the cache were changed or are damaged; they are made again at the next "
               "start"};
}

Outcome CachedLevels::read(int level, const StoreBox& box, std::span<std::byte> values) const {
  const BrickLevel at{levels_[static_cast<std::size_t>(level)].size, {}};
  const auto first = [](int voxel) { return voxel / kBrickEdge; };
  const Index3 lo{first(box.lo.x), first(box.lo.y), first(box.lo.z)};
  const Index3 hi{first(box.lo.x + box.size.x - 1), first(box.lo.y + box.size.y - 1), first(box.lo.z + box.size.z - 1)};
  thread_local std::vector<std::byte> brick;
  for (int z = lo.z; z <= hi.z; ++z)
    for (int y = lo.y; y <= hi.y; ++y)
      for (int x = lo.x; x <= hi.x; ++x) {
        const Index3 size = brick_size(at, {x, y, z}), start{x * kBrickEdge, y * kBrickEdge, z * kBrickEdge};
        if (lo == hi && start == box.lo && size == box.size) return read_brick(level, lo, values);
        brick.resize(static_cast<std::size_t>(size.x) * static_cast<std::size_t>(size.y) * static_cast<std::size_t>(size.z) * type_.bytes);
        CATENA_CHECK(read_brick(level, {x, y, z}, brick));
        const auto later = [](int a, int b) { return std::max(a, b); };
        const Index3 from{later(start.x, box.lo.x), later(start.y, box.lo.y), later(start.z, box.lo.z)};
        const Index3 part{std::min(start.x + size.x, box.lo.x + box.size.x) - from.x,
                          std::min(start.y + size.y, box.lo.y + box.size.y) - from.y,
                          std::min(start.z + size.z, box.lo.z + box.size.z) - from.z};
        copy_box(type_.bytes, brick, size, {from.x - start.x, from.y - start.y, from.z - start.z}, values, box.size,
                 {from.x - box.lo.x, from.y - box.lo.y, from.z - box.lo.z}, part);
      }
  return Done{};
}

}  // namespace catena::field
