// SPDX-License-Identifier: MIT
// Stores of Zarr, version 2. Chunks are files of their own, which are read and decoded here.
#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <cstring>
#include <filesystem>

#include "engine/base/text.h"
#include "engine/field/bricks/brick_source.h"
#include "engine/io/chunks/chunk_cache.h"
#include "engine/io/chunks/copy_part.h"
#include "engine/io/chunks/open_store.h"
#include "engine/io/chunks/pyramid.h"
#include "engine/io/chunks/zarr_tree.h"

namespace catena::chunks {
namespace {

using field::Index3;
using field::StoreBox;
using field::StoreGrid;
using field::StoreRequest;

Index3 to_index(std::int64_t x, std::int64_t y, std::int64_t z) { return {static_cast<int>(x), static_cast<int>(y), static_cast<int>(z)}; }

/// A grid of the description: one channel of an image.
struct Channel {
  std::size_t image = 0;
  std::int64_t index = 0;
};

class ZarrStore final : public OpenStore {
 public:
  explicit ZarrStore(StorePath path) : path_(std::move(path)) {}

  Outcome open() {
    CATENA_TRY(images_, find_zarr_images(
                            path_, [this](const struct stat& about) { record_file(about); }, description_.notes));
    for (std::size_t image = 0; image < images_.size(); ++image) CATENA_CHECK(describe(image));
    return Done{};
  }

  Outcome read(const StoreRequest& request, std::span<std::byte> values) override {
    const Channel& channel = channels_[static_cast<std::size_t>(request.grid)];
    const ZarrImage& image = images_[channel.image];
    const auto level = static_cast<std::size_t>(request.level);
    const StoreBox& box = request.box;
    const std::int64_t edge[3] = {image.chunk(level, kAxisX), image.chunk(level, kAxisY), image.chunk(level, kAxisZ)};
    const std::int64_t lo[3] = {box.lo.x, box.lo.y, box.lo.z}, size[3] = {box.size.x, box.size.y, box.size.z};
    const auto last = [&](int a) { return (lo[a] + size[a] - 1) / edge[a]; };
    for (std::int64_t z = lo[2] / edge[2]; z <= last(2); ++z)
      for (std::int64_t y = lo[1] / edge[1]; y <= last(1); ++y)
        for (std::int64_t x = lo[0] / edge[0]; x <= last(0); ++x)
          CATENA_CHECK(read_chunk(image, level, request, channel, {x, y, z}, values));
    return Done{};
  }

  Outcome list(const StoreRequest& request, std::span<std::uint8_t> present) override;

 private:
  struct Position {
    std::int64_t x, y, z;
  };

  Outcome describe(std::size_t index);
  void describe_times(const ZarrImage& image);
  Outcome read_chunk(const ZarrImage& image, std::size_t level, const StoreRequest& request, const Channel& channel, Position at,
                     std::span<std::byte> values);
  Result<ChunkBytes> load_chunk(const ZarrArray& array, const std::vector<std::int64_t>& at);

  /// Returns the number of a chunk along each dimension of the array.
  static std::vector<std::int64_t> chunk_number(const ZarrImage& image, std::size_t level, std::int64_t channel, std::int64_t step,
                                                Position at) {
    std::vector<std::int64_t> number(image.levels[level].shape.size());
    const std::int64_t values[5] = {at.x, at.y, at.z, channel / image.chunk(level, kAxisC), step / image.chunk(level, kAxisT)};
    for (const ZarrAxis axis : {kAxisX, kAxisY, kAxisZ, kAxisC, kAxisT})
      if (image.axis[axis] >= 0) number[image.axis[axis]] = values[axis];
    return number;
  }

  StorePath path_;
  std::vector<ZarrImage> images_;
  std::vector<Channel> channels_;
  ChunkCache cache_;
};

Outcome ZarrStore::describe(std::size_t index) {
  const ZarrImage& image = images_[index];
  const OmeMetadata& meta = image.meta;
  constexpr std::int64_t kMaxGrids = 4096;
  const std::int64_t count = image.size(0, kAxisC);
  if (count + static_cast<std::int64_t>(channels_.size()) > kMaxGrids)
    return Error{fmt::format("{}: the store has {} channels, expected at most {}", path_.shown, count, kMaxGrids)};
  LengthUnit unit;
  if (image.axis[kAxisX] >= 0) unit = find_length_unit(meta.axes[image.axis[kAxisX]].unit);
  // spacing and origin of a level, in the unit of x
  const auto number_of = [&](const std::vector<double>& numbers, ZarrAxis axis) {
    const int dimension = image.axis[axis];
    if (dimension < 0 || numbers.empty()) return 0.0;
    const LengthUnit own = find_length_unit(meta.axes[dimension].unit);
    return numbers[dimension] * (own.meters > 0 && unit.meters > 0 ? own.meters / unit.meters : 1);
  };
  for (std::int64_t c = 0; c < count; ++c) {
    StoreGrid grid;
    const auto* channel = static_cast<std::size_t>(c) < meta.channels.size() ? &meta.channels[static_cast<std::size_t>(c)] : nullptr;
    std::string name = channel != nullptr ? channel->label : "";
    if (name.empty() && count > 1) name = fmt::format("channel {}", c);
    if (!image.name.empty()) name = image.name + (name.empty() ? "" : "/" + name);
    if (name.empty()) name = meta.name;
    if (name.empty()) name = "data";
    grid.name = unique_name(description_, name);
    const ZarrArray& finest = image.levels.front();
    grid.type = finest.type.name;
    grid.length_unit = unit.name;
    grid.is_label_map = image.is_label;
    grid.fill_value = to_double(finest.type, finest.fill.data());
    grid.steps = static_cast<std::int32_t>(image.size(0, kAxisT));
    if (channel != nullptr) {
      grid.has_window = channel->lo && channel->hi && *channel->lo < *channel->hi;
      if (grid.has_window) grid.window[0] = *channel->lo, grid.window[1] = *channel->hi;
      grid.color = channel->color;
    }
    for (std::size_t level = 0; level < image.levels.size(); ++level) {
      const OmeDataset& dataset = meta.datasets[level];
      Vec3 spacing(number_of(dataset.scale, kAxisX), number_of(dataset.scale, kAxisY), number_of(dataset.scale, kAxisZ));
      const Vec3 origin(number_of(dataset.translation, kAxisX), number_of(dataset.translation, kAxisY),
                        number_of(dataset.translation, kAxisZ));
      if (image.axis[kAxisZ] < 0) spacing.z = spacing.x;
      grid.levels.push_back(make_level(grid, to_index(image.size(level, kAxisX), image.size(level, kAxisY), image.size(level, kAxisZ)),
                                       to_index(image.chunk(level, kAxisX), image.chunk(level, kAxisY), image.chunk(level, kAxisZ)),
                                       spacing, origin));
    }
    if (const std::string note = remove_misplaced_levels(grid); !note.empty() && c == 0) description_.notes.push_back(note);
    description_.grids.push_back(std::move(grid));
    channels_.push_back({index, c});
  }
  describe_times(image);
  return Done{};
}

void ZarrStore::describe_times(const ZarrImage& image) {
  const std::int64_t steps = image.size(0, kAxisT);
  constexpr std::int64_t kMaxSteps = 1'000'000;
  if (steps < 2 || steps > kMaxSteps || static_cast<std::size_t>(steps) <= description_.times.size()) return;
  const int dimension = image.axis[kAxisT];
  const OmeDataset& dataset = image.meta.datasets.front();
  const double scale = dataset.scale.empty() ? 1 : dataset.scale[dimension];
  const double first = dataset.translation.empty() ? 0 : dataset.translation[dimension];
  description_.times.clear();
  for (std::int64_t i = 0; i < steps; ++i) description_.times.push_back(first + scale * static_cast<double>(i));
  const std::string& unit = image.meta.axes[dimension].unit;
  description_.time_unit = unit == "second" ? "s" : unit == "millisecond" ? "ms" : unit == "minute" ? "min" : unit == "hour" ? "h" : unit;
}

Result<ChunkBytes> ZarrStore::load_chunk(const ZarrArray& array, const std::vector<std::int64_t>& at) {
  std::string name = array.folder.empty() ? "" : array.folder + "/";
  for (std::size_t i = 0; i < at.size(); ++i) name += (i > 0 ? std::string(1, array.separator) : "") + std::to_string(at[i]);
  if (ChunkBytes cached = cache_.find(name)) return cached;
  const auto problem = [&](const Error& error) {
    return Error{fmt::format("{}: the chunk {} {}", path_.shown, name, error.message), error.system_failure};
  };
  constexpr std::size_t kMoreBytes = 1 << 16;  // incompressible data grow a little
  const auto file = read_chunk_file((path_.real + "/" + name).c_str(), array.chunk_bytes() + array.chunk_bytes() / 8 + kMoreBytes);
  if (!file) return problem(file.error());
  if (!*file) return ChunkBytes();
  auto numbers = array.decode(**file);
  if (!numbers) return problem(numbers.error());
  return cache_.add(name, std::move(*numbers));
}

Outcome ZarrStore::read_chunk(const ZarrImage& image, std::size_t level, const StoreRequest& request, const Channel& channel, Position at,
                              std::span<std::byte> values) {
  const ZarrArray& array = image.levels[level];
  const std::int64_t step = std::min<std::int64_t>(request.step, image.size(level, kAxisT) - 1);
  CATENA_TRY(const ChunkBytes bytes, load_chunk(array, chunk_number(image, level, channel.index, step, at)));
  ChunkView view;
  const std::int64_t edge[3] = {image.chunk(level, kAxisX), image.chunk(level, kAxisY), image.chunk(level, kAxisZ)};
  view.box = {to_index(at.x * edge[0], at.y * edge[1], at.z * edge[2]), to_index(edge[0], edge[1], edge[2])};
  view.first = array.fill.data();
  if (bytes != nullptr) {
    // strides of the array's dimensions
    const std::size_t axes = array.chunk.size();
    std::vector<std::ptrdiff_t> stride(axes, static_cast<std::ptrdiff_t>(array.type.bytes));
    for (std::size_t i = 1; i < axes; ++i) {
      if (array.is_fortran)
        stride[i] = stride[i - 1] * array.chunk[i - 1];
      else
        stride[axes - 1 - i] = stride[axes - i] * array.chunk[axes - i];
    }
    view.first = bytes->data();
    for (int a = 0; a < 3; ++a)
      if (image.axis[a] >= 0) view.stride[a] = stride[image.axis[a]];
    if (image.axis[kAxisC] >= 0) view.first += stride[image.axis[kAxisC]] * (channel.index % image.chunk(level, kAxisC));
    if (image.axis[kAxisT] >= 0) view.first += stride[image.axis[kAxisT]] * (step % image.chunk(level, kAxisT));
  }
  copy_part(view, request.box, array.type.bytes, values);
  return Done{};
}

Outcome ZarrStore::list(const StoreRequest& request, std::span<std::uint8_t> present) {
  const Channel& channel = channels_[static_cast<std::size_t>(request.grid)];
  const ZarrImage& image = images_[channel.image];
  const auto level = static_cast<std::size_t>(request.level);
  const ZarrArray& array = image.levels[level];
  const Index3 size = description_.grids[static_cast<std::size_t>(request.grid)].levels[level].size;
  constexpr std::int64_t kEdge = field::kBrickEdge;
  const std::int64_t extent[3] = {size.x, size.y, size.z};
  std::int64_t bricks[3];
  for (int a = 0; a < 3; ++a) bricks[a] = (extent[a] - 1) / kEdge + 1;
  const std::int64_t step = std::min<std::int64_t>(request.step, image.size(level, kAxisT) - 1);
  const std::vector<std::int64_t> wanted = chunk_number(image, level, channel.index, step, {0, 0, 0});
  // marks the bricks that a chunk touches
  const auto mark = [&](const std::vector<std::int64_t>& number) {
    for (const ZarrAxis axis : {kAxisC, kAxisT})
      if (image.axis[axis] >= 0 && number[image.axis[axis]] != wanted[image.axis[axis]]) return;
    std::int64_t lo[3], hi[3];
    for (int a = 0; a < 3; ++a) {
      const std::int64_t edge = image.chunk(level, static_cast<ZarrAxis>(a)), at = image.axis[a] < 0 ? 0 : number[image.axis[a]];
      if (at * edge >= extent[a]) return;
      lo[a] = at * edge / kEdge;
      hi[a] = std::min(bricks[a] - 1, ((at + 1) * edge - 1) / kEdge);
    }
    for (std::int64_t z = lo[2]; z <= hi[2]; ++z)
      for (std::int64_t y = lo[1]; y <= hi[1]; ++y)
        for (std::int64_t x = lo[0]; x <= hi[0]; ++x) present[static_cast<std::size_t>((z * bricks[1] + y) * bricks[0] + x)] = 1;
  };
  const std::size_t axes = array.shape.size();
  const auto parse = [&](const std::string& name, std::vector<std::int64_t>& number) {
    const char* at = name.data();
    const char* const end = at + name.size();
    while (at < end) {
      std::int64_t value = 0;
      const auto [stop, code] = std::from_chars(at, end, value);
      if (code != std::errc() || value < 0 || value > field::kMaxStoreAxis || number.size() >= axes) return false;
      number.push_back(value);
      at = stop;
      if (at < end && *at++ != array.separator) return false;
    }
    return true;
  };
  const std::string folder = path_.real + (array.folder.empty() ? "" : "/" + array.folder);
  std::error_code code;
  namespace fs = std::filesystem;
  for (fs::recursive_directory_iterator at(folder, code), end; !code && at != end; at.increment(code)) {
    std::vector<std::int64_t> number;
    const std::string name = at->path().string().substr(folder.size() + 1);
    const bool is_chunk = parse(name, number);
    if (is_chunk && number.size() == axes) mark(number);
    if (!is_chunk || number.size() == axes) at.disable_recursion_pending();
  }
  if (code) return Error{fmt::format("{}: the folder {} cannot be listed ({})", path_.shown, array.folder, code.message())};
  return Done{};
}

}  // namespace

Result<std::unique_ptr<OpenStore>> open_zarr(const StorePath& path) {
  auto store = std::make_unique<ZarrStore>(path);
  CATENA_CHECK(store->open());
  return std::unique_ptr<OpenStore>(std::move(store));
}

}  // namespace catena::chunks
