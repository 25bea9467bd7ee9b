// SPDX-License-Identifier: MIT
#include "engine/io/stores/describe_store.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <memory>

#include "engine/base/text.h"
#include "engine/io/levels/level_cache.h"
#include "engine/io/stores/level_reader.h"

namespace catena::field {
namespace {

/// Reads the range of the coarsest level, if that is small.
Outcome describe_range(const std::shared_ptr<const StoredLevels>& stored, GridInfo& info) {
  constexpr double kMaxVoxels = 1 << 21;
  LevelPart part{stored, stored->count() - 1, StoreBox{}};
  part.box = {{0, 0, 0}, part.at().size};
  if (part.box.voxels() > kMaxVoxels) return Done{};
  const Index3 n = part.grid_size();
  std::vector<float> values(static_cast<std::size_t>(n.x) * static_cast<std::size_t>(n.y) * static_cast<std::size_t>(n.z));
  CATENA_CHECK(LevelReader(part).read(0, n.z, values));
  info.range_level = part.level;
  info.display_range = display_range(values);
  info.stats.min = info.display_range.data_min;
  info.stats.max = info.display_range.data_max;
  for (const float v : values) info.stats.nan_count += !std::isfinite(v);
  return Done{};
}

constexpr int kMostNotes = 8;

}  // namespace

Result<std::vector<GridInfo>> describe_stored(const std::string& path, int step) {
  CATENA_TRY(const std::shared_ptr<Store> store, find_store(path));
  std::vector<GridInfo> infos;
  constexpr std::size_t kMostRanges = 64;  // ranges of further grids are not read
  for (const StoreGrid& found : store->description().grids) {
    const int number = static_cast<int>(infos.size()), last_step = std::min(step, found.steps - 1);
    const auto stored = std::make_shared<const StoredLevels>(store, number, last_step, find_cached_levels(*store, number, last_step));
    const StoreGrid& grid = stored->description();
    GridInfo info;
    info.name = grid.name;
    info.type = grid.type;
    info.size = grid.levels.front().size;
    info.mapping = grid.levels.front().mapping;
    info.is_usable = true;
    info.range_level = -1;
    for (const StoreLevel& level : grid.levels) info.levels.push_back({level.size, level.chunk});
    info.stats.active_voxels =
        static_cast<std::uint64_t>(info.size.x) * static_cast<std::uint64_t>(info.size.y) * static_cast<std::uint64_t>(info.size.z);
    info.bytes = info.stats.active_voxels * sizeof(float);
    info.color = grid.color;
    if (grid.has_window) info.window = {grid.window[0], grid.window[1]};
    if (infos.size() < kMostRanges) {
      const Outcome described = describe_range(stored, info);
      if (!described && stored->cached() != nullptr && stored->cached()->is_damaged()) return describe_stored(path, step);
      if (!described) return described.error();
    }
    infos.push_back(std::move(info));
  }
  return infos;
}

Units stored_units(const std::string& path, const std::string& name) {
  const auto store = find_store(path);
  if (!store) return {};
  const auto grid = find_grid(**store, name);
  if (!grid) return {};
  const StoreGrid& found = (*store)->description().grids[static_cast<std::size_t>(*grid)];
  Units units;
  if (is_unit_name(found.length_unit)) units.length = found.length_unit;
  if (is_unit_name(found.value_unit)) units.value = found.value_unit;
  units.is_label_map = found.is_label_map;
  return units;
}

std::vector<double> stored_times(const std::string& path) {
  const auto store = find_store(path);
  return store ? (*store)->description().times : std::vector<double>();
}

std::vector<std::string> stored_notes(const std::string& path) {
  const auto store = find_store(path);
  if (!store) return {};
  std::vector<std::string> notes = (*store)->description().notes;
  const int grids = static_cast<int>((*store)->description().grids.size());
  for (int grid = 0; grid < std::min(grids, kMostNotes); ++grid)
    if (const auto cached = find_cached_levels(**store, grid, 0); cached && !cached->levels().empty())
      notes.push_back((grids > 1 ? in_quotes((*store)->description().grids[static_cast<std::size_t>(grid)].name) + ": " : "") +
                      fmt::format("{} coarser levels are in the cache: {} ({:.1f} MB), which can be deleted at any time",
                                  cached->levels().size(), cached->folder(), 1e-6 * static_cast<double>(folder_bytes(cached->folder()))));
  return notes;
}

std::vector<FileId> stored_files(const std::string& path) {
  namespace fs = std::filesystem;
  std::vector<FileId> files;
  if (const auto store = find_store(path)) files = (*store)->description().opened_files;
  constexpr std::size_t kMaxFiles = 1'000'000;
  std::error_code code;
  for (fs::recursive_directory_iterator at(path, code), end; !code && at != end && files.size() < kMaxFiles; at.increment(code))
    if (const auto id = find_file_id(at->path().string())) files.push_back(*id);
  return files;
}

}  // namespace catena::field
