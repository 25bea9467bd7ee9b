// SPDX-License-Identifier: MIT
#include "engine/io/stores/store_voxels.h"

#include <fmt/format.h>
#include <sys/stat.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <memory>

#include "engine/base/hash.h"
#include "engine/base/input_files.h"
#include "engine/base/memory_limit.h"
#include "engine/io/stores/store.h"
#include "engine/io/stores/store_bricks.h"

namespace catena::field {
namespace {

using Axes = std::array<int, 3>;

/// Largest box of one request, bytes: less than the shared memory, for less memory in total.
constexpr double kMaxRequestBytes = 8 << 20;

/// Reads a box in pieces of at most kMaxRequestBytes, cut between chunks where possible.
struct PieceReader {
  std::shared_ptr<Store> store;
  int grid = 0, level = 0, step = 0;
  Axes chunk{1, 1, 1};
  std::size_t voxel_bytes = 1;

  Outcome read(const Axes& lo, const Axes& size, const Axes& box_lo, const Axes& box_size, std::span<std::byte> box) const {
    const StoreBox piece{{lo[0], lo[1], lo[2]}, {size[0], size[1], size[2]}};
    const double bytes = piece.voxels() * static_cast<double>(voxel_bytes);
    if (bytes > kMaxRequestBytes) {
      // halves along the axis with the most chunks; inside of a chunk along the slowest axis
      int axis = 2;
      for (const int a : {1, 0})
        if (size[a] > chunk[a] && size[a] / chunk[a] > size[axis] / chunk[axis]) axis = a;
      if (size[axis] <= chunk[axis]) axis = size[2] > 1 ? 2 : size[1] > 1 ? 1 : 0;
      int cut = lo[axis] + size[axis] / 2;
      if (size[axis] > chunk[axis]) {
        cut = (cut + chunk[axis] / 2) / chunk[axis] * chunk[axis];
        if (cut <= lo[axis]) cut += chunk[axis];
        if (cut >= lo[axis] + size[axis]) cut = lo[axis] + size[axis] / 2;
      }
      Axes upper_lo = lo, upper_size = size, lower_size = size;
      upper_lo[axis] = cut;
      lower_size[axis] = cut - lo[axis];
      upper_size[axis] -= lower_size[axis];
      CATENA_CHECK(read(lo, lower_size, box_lo, box_size, box));
      return read(upper_lo, upper_size, box_lo, box_size, box);
    }
    if (lo == box_lo && size == box_size) return store->read(grid, level, step, piece, box);
    std::vector<std::byte> values(static_cast<std::size_t>(bytes));
    CATENA_CHECK(store->read(grid, level, step, piece, values));
    const std::size_t row = static_cast<std::size_t>(size[0]) * voxel_bytes;
    const std::byte* from = values.data();
    for (int z = 0; z < size[2]; ++z)
      for (int y = 0; y < size[1]; ++y, from += row) {
        const std::size_t voxel = (static_cast<std::size_t>(lo[2] - box_lo[2] + z) * static_cast<std::size_t>(box_size[1]) +
                                   static_cast<std::size_t>(lo[1] - box_lo[1] + y)) *
                                      static_cast<std::size_t>(box_size[0]) +
                                  static_cast<std::size_t>(lo[0] - box_lo[0]);
        std::memcpy(&box[voxel * voxel_bytes], from, row);
      }
    return Done{};
  }
};

/// Returns a line that changes with every file of a folder: their names, sizes and times. A folder with more than kMaxFiles is too large
/// for that, and has the times of its metadata only.
std::string state_of_files(const std::string& path) {
  namespace fs = std::filesystem;
  constexpr std::uint64_t kMaxFiles = 4'000'000;
  std::error_code code;
  std::uint64_t count = 0, sum = 0;  // the order of the files is not defined
  for (fs::recursive_directory_iterator at(path, code), end; !code && at != end && count < kMaxFiles; at.increment(code), ++count) {
    struct stat about {};
    if (::lstat(at->path().c_str(), &about) != 0 || S_ISDIR(about.st_mode)) continue;
    Fnv1a file;
    const std::string name = at->path().lexically_relative(path).string();
    file.add_bytes(name.data(), name.size());
    file.add(static_cast<std::uint64_t>(about.st_size));
    file.add(static_cast<std::uint64_t>(modified_ns(about)));
    sum += file.value;
  }
  return count == 0 || count == kMaxFiles ? std::string() : fmt::format("{} entries, {:016x}\n", count, sum);
}

/// Returns a line that changes with the layout of an array; empty: a store that describes itself.
std::string layout_text(const ArrayLayout& layout) {
  if (layout == ArrayLayout{}) return {};
  return fmt::format("{} {} {} {} {} {:a} {:a}\n", layout.axes_xyz, layout.shape.x, layout.shape.y, layout.shape.z, layout.type,
                     fmt::join(layout.spacing, " "), fmt::join(layout.origin, " "));
}

}  // namespace

Index3 bricks_that_share_chunks(const Index3& size, const Index3& chunk, std::size_t voxel_bytes, double max_bytes) {
  const Axes n{size.x, size.y, size.z}, c{chunk.x, chunk.y, chunk.z};
  Axes most{}, group{};
  bool is_shared = false;
  for (int a = 0; a < 3; ++a) {
    most[a] = (n[a] - 1) / kBrickEdge + 1;
    group[a] = std::min(most[a], (c[a] - 1) / kBrickEdge + 1);
    is_shared = is_shared || (most[a] > 1 && kBrickEdge % c[a] != 0);
  }
  if (!is_shared) return {1, 1, 1};
  const auto bytes = [&] {
    const double brick = static_cast<double>(kBrickEdge) * kBrickEdge * kBrickEdge * static_cast<double>(voxel_bytes);
    return brick * group[0] * group[1] * group[2];
  };
  const auto longest = [&] { return group[2] >= group[1] && group[2] >= group[0] ? 2 : group[1] >= group[0] ? 1 : 0; };
  while (bytes() > max_bytes && group[longest()] > 1) group[longest()] = (group[longest()] + 1) / 2;
  // chunks that lie in several groups are decoded several times: fewer in larger groups
  for (;;) {
    int axis = -1;
    for (int a = 0; a < 3; ++a)
      if (group[a] < most[a] && group[a] * kBrickEdge % c[a] != 0 && (axis < 0 || group[a] < group[axis])) axis = a;
    if (axis < 0 || 2 * bytes() > max_bytes) return {group[0], group[1], group[2]};
    group[axis] = std::min(most[axis], 2 * group[axis]);
  }
}

std::string path_of_store(const Store& store) {
  std::string path = store.path();
  while (path.size() > 1 && path.ends_with('/')) path.pop_back();
  return path;
}

std::string identify_stored_grid(const Store& store, int grid, int step) {
  const StoreDescription& all = store.description();
  return identify_file(path_of_store(store)) +
         fmt::format("grid {}, step {}, newest file {}, {} files\n", all.grids[static_cast<std::size_t>(grid)].name, step,
                     all.newest_mtime_ns, all.opened_files.size()) +
         layout_text(store.layout()) + state_of_files(store.path());
}

VoxelSource voxels_of_level(const std::shared_ptr<Store>& store, int chosen, int at, int step) {
  const StoreGrid& grid = store->description().grids[static_cast<std::size_t>(chosen)];
  const StoreLevel& level = grid.levels[static_cast<std::size_t>(at)];
  VoxelSource source{grid.name, *find_number_type(grid.type), level.size, level.mapping, read_units(store->path(), grid.name)};
  if (grid.has_window) source.window = {grid.window[0], grid.window[1]};
  source.color = grid.color;
  source.identity = identify_stored_grid(*store, chosen, step);
  // a share of the memory for each of two threads, of what is read at once
  constexpr double kMaxGroupBytes = 256e6, kShare = 0.25;
  const double max_bytes = std::min(kMaxGroupBytes, kShare * static_cast<double>(available_memory()));
  source.bricks_at_once = bricks_that_share_chunks(level.size, level.chunk, source.type.bytes, max_bytes);
  const PieceReader reader{store, chosen, at, step, {level.chunk.x, level.chunk.y, level.chunk.z}, source.type.bytes};
  source.read = [reader](const Index3& lo, const Index3& size, std::span<std::byte> values) {
    const Axes from{lo.x, lo.y, lo.z}, count{size.x, size.y, size.z};
    return reader.read(from, count, from, count, values);
  };
  // the fill value, where a double holds it exactly and a mean of it is itself
  constexpr double kExact = 1LL << 53;
  if (std::isinf(grid.fill_value) || std::fabs(grid.fill_value) > kExact) return source;
  source.fill_value = grid.fill_value;
  const auto bricks = std::make_shared<const StoreBricks>(store, chosen, step);
  if (bricks->find_empty_bricks(at)) source.is_empty = [bricks, at](const Index3& brick) { return !bricks->range(at, brick).has_data; };
  return source;
}

Result<VoxelSource> open_stored_voxels(const LoadRequest& request) {
  CATENA_TRY(const std::shared_ptr<Store> store, find_store(request));
  CATENA_TRY(const int grid, find_grid(*store, request.grid));
  CATENA_TRY(const int step, find_step(*store, grid, request.step));
  return voxels_of_level(store, grid, 0, step);
}

}  // namespace catena::field
