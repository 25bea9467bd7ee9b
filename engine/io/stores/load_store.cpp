// SPDX-License-Identifier: MIT
// Loads grids of stores of chunks: the finest level that fits into the memory budget, of it the box that is asked for.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "engine/base/memory_limit.h"
#include "engine/base/text.h"
#include "engine/field/bricks/paged_grid.h"
#include "engine/field/grid/dense.h"
#include "engine/io/formats.h"
#include "engine/io/stores/level_reader.h"
#include "engine/io/stores/store.h"
#include "engine/io/stores/store_bricks.h"
#include "engine/io/stores/store_voxels.h"
#include "engine/io/volume/crop.h"
#include "engine/io/volume/downsample.h"
#include "engine/io/zarr/write_zarr.h"

namespace catena::field {
namespace {

std::string size_text(const Index3& n) { return fmt::format("{} x {} x {}", n.x, n.y, n.z); }

/// Returns the voxels of a level that a request needs.
Result<StoreBox> needed_box(const std::string& path, const StoreGrid& grid, const StoreLevel& level, const std::optional<Box>& crop) {
  if (!crop) return StoreBox{{0, 0, 0}, level.size};
  const ActiveBox needed = voxels_in_box(*crop, level.mapping);
  const int n[3] = {level.size.x, level.size.y, level.size.z};
  int lo[3], size[3];
  for (int a = 0; a < 3; ++a) {
    lo[a] = std::max(0, needed.lo[a]);
    size[a] = std::min(n[a] - 1, needed.hi[a]) - lo[a] + 1;
    if (size[a] < std::min(2, n[a]))
      return Error{
          one_line(fmt::format("{}: \"crop\" contains no voxels of the grid \"{}\" along {}; a box that overlaps the data was expected",
                               path, grid.name, "xyz"[a]))};
  }
  return StoreBox{{lo[0], lo[1], lo[2]}, {size[0], size[1], size[2]}};
}

/// Returns how often a level halves the resolution of level 0, along the axis that it reduces most.
int halvings(const StoreGrid& grid, std::size_t level) {
  const auto edge = [&](std::size_t l, int a) { return norm(grid.levels[l].mapping.world_from_index_linear[a]); };
  double ratio = 1;
  for (int a = 0; a < 3; ++a) ratio = std::max(ratio, edge(level, a) / edge(0, a));
  return static_cast<int>(std::lround(std::log2(ratio)));
}

/// Returns the coarsest stored level that is not coarser than requested.
std::size_t level_for(const StoreGrid& grid, int requested) {
  std::size_t level = 0;
  while (level + 1 < grid.levels.size() && halvings(grid, level + 1) <= requested) ++level;
  return level;
}

/// Finds the finest level, from `level` on, whose part fits into memory.
Result<LevelPart> find_part(const LoadRequest& request, LevelPart part) {
  const StoreGrid& grid = part.description();
  for (;; ++part.level) {
    CATENA_TRY(part.box, needed_box(request.path, grid, part.at(), request.crop));
    const std::string what = one_line(fmt::format("{}: {}", request.path, size_text(part.grid_size()) + " voxels"));
    const MemoryReservation slab(LevelReader(part).slab_bytes());
    const Outcome fits = check_dense_memory(what, part.grid_size(), 1, false);
    if (fits) return part;
    if (part.level + 1 == static_cast<int>(grid.levels.size()))
      return Error{fits.error().message + "; the store has no coarser level, \"crop\" in a scene loads a part",
                   fits.error().system_failure};
  }
}

/// Adds the finest level of a part to the field, which was loaded from a coarser one. A level of one voxel along an axis is left out.
Outcome add_paged_grid(const LevelPart& part, const LoadRequest& request, AnyField& field) {
  const StoreGrid& grid = part.description();
  CATENA_TRY(const StoreBox box, needed_box(request.path, grid, grid.levels.front(), request.crop));
  if (std::min({box.size.x, box.size.y, box.size.z}) < 2) return Done{};
  const Mapping& mapping = grid.levels.front().mapping;
  const Mapping of_part =
      Mapping::from_linear(mapping.world_from_index_linear, mapping.world_from_index(Vec3(box.lo.x, box.lo.y, box.lo.z)));
  field.paged = std::make_shared<const PagedGrid>(std::make_shared<const StoreBricks>(part.store, part.grid, part.step),
                                                  PagedGrid::Part{box.lo, box.size, of_part},
                                                  std::static_pointer_cast<const ScalarGrid>(field.scalar));
  return Done{};
}

Result<AnyField> load_stored(const LoadRequest& request) {
  CATENA_TRY(const std::shared_ptr<Store> store, find_store(request.path));
  CATENA_TRY(const int chosen, find_grid(*store, request.grid));
  const StoreDescription& all = store->description();
  const StoreGrid& grid = all.grids[static_cast<std::size_t>(chosen)];
  if (request.mask_required) return Error{request.path + ": a store of chunks has no mask"};
  CATENA_TRY(const int step, find_step(*store, chosen, request.step));
  const int finest = static_cast<int>(level_for(grid, request.level));
  CATENA_TRY(const LevelPart part, find_part(request, {store, chosen, finest, step, StoreBox{}}));
  const auto reader = std::make_shared<LevelReader>(part);
  const MemoryReservation slab(reader->slab_bytes());
  DenseFile file{grid.name, grid.type, one_line(fmt::format("{}: the grid {} ", request.path, in_quotes(grid.name))), {}, 1, {}};
  const Mapping& mapping = part.at().mapping;
  file.mapping =
      Mapping::from_linear(mapping.world_from_index_linear, mapping.world_from_index(Vec3(part.box.lo.x, part.box.lo.y, part.box.lo.z)));
  file.source.size = part.grid_size();
  file.source.read = [reader](int z, int layers, std::span<float> values, std::span<std::uint8_t>) {
    return reader->read(z, layers, values);
  };
  file.rounding = reader->rounding();
  file.times = all.times;
  file.time_unit = all.time_unit;
  file.newest_mtime_ns = all.newest_mtime_ns;
  if (part.level != finest || part.level > 0) {
    CATENA_TRY(const StoreBox full, needed_box(request.path, grid, grid.levels.front(), request.crop));
    file.notes.push_back(fmt::format("level {} of {}, {} of {} voxels{}", part.level, grid.levels.size(), size_text(part.box.size),
                                     size_text(full.size),
                                     part.level != finest ? ": the memory limit allows no finer one (--memory MB allows more)" : ""));
  }
  if (!(part.grid_size() == part.box.size)) file.notes.push_back("flat data get a thickness of one voxel");
  CATENA_TRY(AnyField field, load_dense(file));
  if (part.level > 0 && request.level == 0) CATENA_CHECK(add_paged_grid(part, request, field));
  const int remaining = std::min(request.level - halvings(grid, static_cast<std::size_t>(part.level)), kMaxLevels);
  if (remaining <= 0) return field;
  if (request.interpolation == Interpolation::nearest) field = with_interpolation(std::move(field), Interpolation::nearest);
  return downsample_to_level(request.path, std::move(field), remaining);
}

/// Reads the range of the coarsest level, if that is small.
Outcome describe_range(Store& store, int index, int step, GridInfo& info) {
  constexpr double kMaxVoxels = 1 << 21;
  const StoreGrid& grid = store.description().grids[static_cast<std::size_t>(index)];
  LevelPart part{std::shared_ptr<Store>(std::shared_ptr<Store>(), &store), index, static_cast<int>(grid.levels.size()) - 1,
                 std::min(step, grid.steps - 1), StoreBox{}};
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

Result<std::vector<GridInfo>> describe_stored(const std::string& path, int step) {
  CATENA_TRY(const std::shared_ptr<Store> store, find_store(path));
  std::vector<GridInfo> infos;
  constexpr std::size_t kMostRanges = 64;  // ranges of further grids are not read
  for (const StoreGrid& grid : store->description().grids) {
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
    if (infos.size() < kMostRanges) CATENA_CHECK(describe_range(*store, static_cast<int>(infos.size()), step, info));
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
  return store ? (*store)->description().notes : std::vector<std::string>();
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

constexpr VolumeReader kStoredVolume{.load = load_stored,
                                     .describe = describe_stored,
                                     .units = stored_units,
                                     .times = stored_times,
                                     .notes = stored_notes,
                                     .files = stored_files,
                                     .open_voxels = open_stored_voxels,
                                     .reads_parts = true};

bool is_zarr_folder(const std::string& path) {
  std::error_code code;
  return std::ranges::any_of(std::initializer_list<const char*>{"/.zgroup", "/.zarray", "/.zattrs", "/zarr.json"},
                             [&](const char* name) { return std::filesystem::exists(path + name, code); });
}

/// Returns whether most of a folder's first entries are TIFF files.
bool is_tiff_folder(const std::string& path) {
  constexpr int kMaxEntries = 1000;
  int entries = 0, images = 0;
  std::error_code code;
  for (std::filesystem::directory_iterator at(path, code), end; !code && at != end && entries < kMaxEntries; at.increment(code), ++entries)
    images += has_extension(at->path().native(), ".tif") || has_extension(at->path().native(), ".tiff");
  return 2 * images > entries;
}

}  // namespace
}  // namespace catena::field

namespace catena::io {

std::vector<Format> store_formats() {
  field::VolumeReader zarr = field::kStoredVolume, tiff = field::kStoredVolume;
  zarr.recognizes_folder = field::is_zarr_folder;
  tiff.recognizes_folder = field::is_tiff_folder;
  return {
      {.name = "OME-Zarr, Zarr 2",
       .extensions = {".zarr"},
       .volume = zarr,
       .write_volume = field::write_field_as_zarr,
       .layout = FileLayout::companions},
      {.name = "TIFF, BigTIFF, OME-TIFF",
       .extensions = {".tif", ".tiff", ".btf", ".tf8", ".tf2"},
       .volume = tiff,
       .layout = FileLayout::companions},
      {.name = "HDF5: BigDataViewer, Imaris, NeXus, VTKHDF images, data sets with three axes",
       .extensions = {".h5", ".hdf5", ".hdf", ".he5", ".nxs", ".ims", ".vtkhdf"},
       .volume = field::kStoredVolume,
       .layout = FileLayout::companions},
      {.name = "BigDataViewer XML", .extensions = {".xml"}, .volume = field::kStoredVolume, .layout = FileLayout::companions},
  };
}

}  // namespace catena::io
