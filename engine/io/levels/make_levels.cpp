// SPDX-License-Identifier: MIT
#include "engine/io/levels/make_levels.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "engine/base/memory_limit.h"
#include "engine/base/text.h"
#include "engine/io/levels/cached_levels.h"
#include "engine/io/levels/halved_voxels.h"
#include "engine/io/levels/index_file.h"
#include "engine/io/stores/store_voxels.h"
#include "engine/io/zarr/brick_log.h"

namespace catena::field {

Outcome make_levels(const CachePlace& place, const std::shared_ptr<Store>& store, int grid, int step, const WriteProgress& progress) {
  const std::vector<StoreLevel>& own = store->description().grids[static_cast<std::size_t>(grid)].levels;
  const int base = static_cast<int>(own.size()) - 1;
  const StoreLevel& level = own.back();
  VoxelSource full = voxels_of_level(store, grid, base, step);
  CATENA_TRY(BrickLog opened_log, BrickLog::open(place.ranges(), {{level.size, level.mapping}}));
  const auto log = std::make_shared<BrickLog>(std::move(opened_log));
  constexpr double kMaxGroupBytes = 256e6, kShare = 0.2;
  const double max_bytes = std::min(kMaxGroupBytes, kShare * static_cast<double>(available_memory()));
  const auto is_empty = full.is_empty;
  VoxelSource halved = halve_voxels(std::move(full), level.chunk, max_bytes, [log](const Index3& brick, const BrickRange& range) {
    return log->record(0, brick, BrickState::stored, range, 0);
  });
  const auto keep_index = [&](BrickIndex index) -> Outcome {
    CATENA_TRY(const BrickIndex finest, log->read_index(index.fill_value));
    const LevelIndex& read = finest.levels.front();
    LevelIndex all(read.counts(),
                   [&](std::uint64_t number) { return read.has_data(number) || !is_empty || !is_empty(brick_at(read.counts(), number)); });
    for (std::uint64_t number = 0; number < 64 * read.bits().size(); ++number)
      if (read.has_data(number)) all.set(number, {true, true, read.entry(number).min, read.entry(number).max}, 0);
    if (std::ranges::any_of(all.entries(), [](const LevelIndex::Entry& entry) { return std::isnan(entry.min); }))
      return Error{one_line(place.ranges()) + ": ranges are missing"};
    index.first_level = base;
    index.levels.insert(index.levels.begin(), std::move(all));
    return write_index(place.folder + CachedLevels::kIndexName, place.identity, index);
  };
  return write_zarr(place.folder + CachedLevels::kStoreName, std::move(halved), progress, keep_index);
}

}  // namespace catena::field
