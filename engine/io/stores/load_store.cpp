// SPDX-License-Identifier: MIT
// Loads grids of stores of chunks: the finest level that fits into the memory budget, of it the box that is asked for.
#include "engine/io/stores/load_store.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "engine/base/memory_limit.h"
#include "engine/base/text.h"
#include "engine/field/bricks/paged_grid.h"
#include "engine/field/grid/dense.h"
#include "engine/io/formats.h"
#include "engine/io/levels/level_cache.h"
#include "engine/io/stores/describe_store.h"
#include "engine/io/stores/level_reader.h"
#include "engine/io/stores/store.h"
#include "engine/io/stores/store_bricks.h"
#include "engine/io/stores/store_voxels.h"
#include "engine/io/volume/crop.h"
#include "engine/io/volume/downsample.h"
#include "engine/io/zarr/write_zarr.h"

namespace catena::field {
namespace {

double max_whole_level = kNoMaxWholeLevel;

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

/// The finest level that fits into memory, or why none does.
struct FittingPart {
  LevelPart part;
  Outcome fits = Done{};
  bool is_small = true;  ///< it leaves memory for channels or bricks
};

/// Returns the number of channels that are likely to be loaded together with a grid: those of its size, at most kMaxTogether.
int channels_of(const StoreDescription& store, int grid) {
  constexpr int kMaxTogether = 4;
  const auto is_channel = [&](const StoreGrid& other) {
    const StoreGrid& own = store.grids[static_cast<std::size_t>(grid)];
    return other.levels.front().size == own.levels.front().size && (other.color >= 0 || other.name.starts_with("channel "));
  };
  return is_channel(store.grids[static_cast<std::size_t>(grid)])
             ? std::min(kMaxTogether, static_cast<int>(std::ranges::count_if(store.grids, is_channel)))
             : 1;
}

/// Finds the finest level, from the requested one on, whose part fits into memory. All `channels` must fit into most of the limit together,
/// so that either all or none are drawn from their finest level by bricks. A coarser level than the requested one takes at most a part of
/// the memory: the rest is for bricks of the finest level. If bricks are preferred to a large level, it has at most half of the voxels.
Result<FittingPart> find_part(const LoadRequest& request, const std::shared_ptr<const StoredLevels>& stored, int channels) {
  constexpr double kPart = 0.25, kMost = 0.75, kPartOfLimit = 0.5;
  FittingPart found{{stored, static_cast<int>(level_for(stored->description(), request.level)), StoreBox{}}};
  const int requested = found.part.level;
  const double available = static_cast<double>(available_memory());
  for (LevelPart& part = found.part;; ++part.level) {
    CATENA_TRY(part.box, needed_box(request.path, stored->description(), part.at(), request.crop));
    const double bytes = part.box.voxels() * sizeof(float);
    const double most = kMost * static_cast<double>(memory_limit().value_or(available_memory()));
    const bool is_requested = part.level == requested;
    found.is_small = is_requested ? channels == 1 || channels * bytes <= most : bytes <= kPart * available;
    if (request.level == 0 && part.box.voxels() > (is_requested ? 1 : kPartOfLimit) * max_whole_level) found.is_small = false;
    const std::string what = one_line(fmt::format("{}: {}", request.path, size_text(part.grid_size()) + " voxels"));
    const MemoryReservation slab(LevelReader(part).slab_bytes());
    found.fits = check_dense_memory(what, part.grid_size(), 1, false);
    if ((found.fits && found.is_small) || part.level + 1 == stored->count()) return found;
  }
}

/// Finds a level that fits into memory; makes coarser levels in the cache if none does.
Result<LevelPart> find_or_make_part(const LoadRequest& request, const std::shared_ptr<Store>& store, int grid, int step) {
  const auto open = [&](std::shared_ptr<const CachedLevels> cached) {
    return std::make_shared<const StoredLevels>(store, grid, step, std::move(cached));
  };
  const int channels = channels_of(store->description(), grid);
  CATENA_TRY(FittingPart found, find_part(request, open(find_cached_levels(*store, grid, step)), channels));
  if (found.fits && (found.is_small || found.part.level > 0)) return found.part;
  const int own_levels = static_cast<int>(store->description().grids[static_cast<std::size_t>(grid)].levels.size());
  const Index3& size = found.part.at().size;
  std::optional<Error> failure;
  if (found.part.stored->count() == own_levels && std::max({size.x, size.y, size.z}) > kBrickEdge) {
    if (auto made = make_cached_levels(store, grid, step)) {
      CATENA_TRY(found, find_part(request, open(std::move(*made)), channels));
    } else {
      failure = made.error();
    }
  }
  if (found.fits) return found.part;
  Error error = found.fits.error();
  error.message += "; the store has no coarser level, \"crop\" in a scene loads a part";
  if (failure) {
    error.message += "; coarser levels could not be made in the cache: " + failure->message;
    error.system_failure = error.system_failure || failure->system_failure;
  }
  return error;
}

/// Adds the finest level of a part to the field, which was loaded from a coarser one. A level of one voxel along an axis is left out.
Outcome add_paged_grid(const LevelPart& part, const LoadRequest& request, AnyField& field) {
  const StoreGrid& grid = part.description();
  CATENA_TRY(const StoreBox box, needed_box(request.path, grid, grid.levels.front(), request.crop));
  if (std::min({box.size.x, box.size.y, box.size.z}) < 2) return Done{};
  const Mapping& mapping = grid.levels.front().mapping;
  const Mapping of_part =
      Mapping::from_linear(mapping.world_from_index_linear, mapping.world_from_index(Vec3(box.lo.x, box.lo.y, box.lo.z)));
  field.paged =
      std::make_shared<const PagedGrid>(std::make_shared<const StoreBricks>(part.stored), PagedGrid::Part{box.lo, box.size, of_part},
                                        std::static_pointer_cast<const ScalarGrid>(field.scalar));
  return Done{};
}

/// Loads a part of a store into a field.
Result<AnyField> load_part(const LoadRequest& request, const StoreDescription& all, const LevelPart& part) {
  const StoreGrid& grid = part.description();
  const int finest = static_cast<int>(level_for(grid, request.level));
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
    const char* const reason = part.level == finest                 ? ""
                               : request.level > 0                  ? ": the memory limit allows no finer one (--memory MB allows more)"
                               : max_whole_level < kNoMaxWholeLevel ? ": volumes, isosurfaces, slices and links read the finest in bricks "
                                                                      "(--memory MB loads a finer one whole)"
                                                                    : ": the memory limit allows no finer one (--memory MB); volumes, "
                                                                      "isosurfaces, slices and links read the finest";
    file.notes.push_back(fmt::format("level {} of {}, {} of {} voxels{}", part.level, grid.levels.size(), size_text(part.box.size),
                                     size_text(full.size), reason));
  }
  if (!(part.grid_size() == part.box.size)) file.notes.push_back("flat data get a thickness of one voxel");
  CATENA_TRY(AnyField field, load_dense(file));
  if (part.level > 0 && request.level == 0) CATENA_CHECK(add_paged_grid(part, request, field));
  const int remaining = std::min(request.level - halvings(grid, static_cast<std::size_t>(part.level)), kMaxLevels);
  if (remaining <= 0) return field;
  if (request.interpolation == Interpolation::nearest) field = with_interpolation(std::move(field), Interpolation::nearest);
  return downsample_to_level(request.path, std::move(field), remaining);
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

void set_max_whole_level(double voxels) { max_whole_level = voxels; }

Result<AnyField> load_stored(const LoadRequest& request) {
  CATENA_TRY(const std::shared_ptr<Store> store, find_store(request));
  CATENA_TRY(const int grid, find_grid(*store, request.grid));
  if (request.mask_required) return Error{request.path + ": a store of chunks has no mask"};
  CATENA_TRY(const int step, find_step(*store, grid, request.step));
  constexpr int kTries = 2;  // damaged levels in the cache are made again
  for (int attempt = 1;; ++attempt) {
    CATENA_TRY(const LevelPart part, find_or_make_part(request, store, grid, step));
    Result<AnyField> field = load_part(request, store->description(), part);
    const CachedLevels* cached = part.stored->cached();
    if (field || cached == nullptr || !cached->is_damaged() || attempt == kTries) return field;
  }
}

bool is_read_in_bricks(const LoadRequest& request) {
  constexpr double kCopies = 2;  // the values that are read, and the grid
  const double available = static_cast<double>(available_memory());
  const auto bytes = readable_file_size(request.path);
  const auto is_large = [&](double voxels) {
    return (request.level == 0 && voxels > max_whole_level) || kCopies * sizeof(float) * voxels > available;
  };
  if (!bytes || request.mask_required || !is_large(static_cast<double>(*bytes))) return false;
  const auto store = find_store(request);
  return store && is_large(StoreBox{{}, (*store)->description().grids.front().levels.front().size}.voxels());
}

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
