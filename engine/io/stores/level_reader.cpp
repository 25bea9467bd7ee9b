// SPDX-License-Identifier: MIT
#include "engine/io/stores/level_reader.h"

#include <algorithm>
#include <atomic>
#include <cstring>
#include <mutex>
#include <thread>

#include "engine/base/memory_limit.h"
#include "engine/base/threads.h"

namespace catena::field {
namespace {

/// Returns the slices of a slab: those of a chunk, several chunks if these are thin, fewer if the slab would be too large.
int slab_depth(const LevelPart& part, std::size_t number_bytes) {
  constexpr int kMinDepth = 8;
  constexpr double kMaxBytes = 256e6, kShare = 0.125;
  const int chunk = part.at().chunk.z;
  int depth = chunk >= kMinDepth ? chunk : (kMinDepth + chunk - 1) / chunk * chunk;
  const double layer = static_cast<double>(part.box.size.x) * part.box.size.y * static_cast<double>(number_bytes);
  const double bytes = std::min(kMaxBytes, kShare * static_cast<double>(available_memory()));
  depth = std::min(depth, std::max(kMinDepth, static_cast<int>(bytes / layer)));
  return std::min(depth, part.box.size.z);
}

/// Cuts an interval at multiples of `edge` into pieces of at most `max` voxels.
struct Interval {
  int lo, size;
};
std::vector<Interval> cut(int lo, int size, int edge, int max) {
  const int step = max >= edge ? max / edge * edge : max;
  std::vector<Interval> pieces;
  for (int at = lo; at < lo + size;) {
    const int end = std::min(lo + size, (at / step + 1) * step);
    pieces.push_back({at, end - at});
    at = end;
  }
  return pieces;
}

}  // namespace

Index3 LevelPart::grid_size() const {
  const auto thick = [](int voxels) { return std::max(voxels, 2); };
  return {thick(box.size.x), thick(box.size.y), thick(box.size.z)};
}

LevelReader::LevelReader(LevelPart part)
    : part_(std::move(part)), type_(*find_number_type(part_.description().type)), depth_(slab_depth(part_, type_.bytes)) {}

std::uint64_t LevelReader::slab_bytes() const {
  return static_cast<std::uint64_t>(part_.box.size.x) * static_cast<std::uint64_t>(part_.box.size.y) * static_cast<std::uint64_t>(depth_) *
         type_.bytes;
}

Outcome LevelReader::read(int z, int layers, std::span<float> values) {
  const Index3 out = part_.grid_size(), in = part_.box.size;
  const auto row = static_cast<std::size_t>(out.x);
  for (int layer = z; layer < z + layers; ++layer) {
    const int from_z = std::min(layer, in.z - 1);
    if (from_z < first_ || from_z >= first_ + layers_) CATENA_CHECK(read_slab(from_z));
    for (int y = 0; y < out.y; ++y) {
      const std::size_t voxel =
          (static_cast<std::size_t>(from_z - first_) * static_cast<std::size_t>(in.y) + static_cast<std::size_t>(std::min(y, in.y - 1))) *
          static_cast<std::size_t>(in.x);
      const std::span<float> to =
          values.subspan((static_cast<std::size_t>(layer - z) * static_cast<std::size_t>(out.y) + static_cast<std::size_t>(y)) * row, row);
      type_.decode(slab_.data() + voxel * type_.bytes, static_cast<std::size_t>(in.x), 1, 0, to.data(), *rounding_);
      if (out.x != in.x) to[1] = to[0];
    }
  }
  return Done{};
}

/// Reads the slab that contains a slice of the part.
Outcome LevelReader::read_slab(int z) {
  const StoreBox& box = part_.box;
  const Index3 chunk = part_.at().chunk;
  // slabs begin at multiples of their depth in the level
  const int end = std::min(box.size.z, ((box.lo.z + z) / depth_ + 1) * depth_ - box.lo.z);
  first_ = z;
  layers_ = end - z;
  const std::size_t row = static_cast<std::size_t>(box.size.x) * type_.bytes, layer = row * static_cast<std::size_t>(box.size.y);
  slab_.resize(layer * static_cast<std::size_t>(layers_));
  // tiles of whole chunks where these fit into an answer, several for each reader
  constexpr double kTileBytes = 8e6, kMaxTileBytes = static_cast<double>(kStoreMemoryBytes);
  const auto numbers = static_cast<double>(type_.bytes) * layers_;
  const auto limit = [&](double other, int edge, int size) {
    const double max = kMaxTileBytes / (numbers * other), wanted = std::max(static_cast<double>(edge), kTileBytes / (numbers * other));
    return std::max(1, static_cast<int>(std::min({static_cast<double>(size), max, wanted})));
  };
  const int tile_y = limit(std::min(box.size.x, chunk.x), chunk.y, box.size.y);
  const int tile_x = limit(tile_y, chunk.x, box.size.x);
  std::vector<StoreBox> tiles;
  for (const Interval& y : cut(box.lo.y, box.size.y, chunk.y, tile_y))
    for (const Interval& x : cut(box.lo.x, box.size.x, chunk.x, tile_x))
      tiles.push_back({{x.lo, y.lo, box.lo.z + first_}, {x.size, y.size, layers_}});
  std::atomic<std::size_t> next{0};
  std::mutex mutex;
  Outcome result = Done{};
  const auto work = [&] {
    std::vector<std::byte> values;
    for (std::size_t i = next++; i < tiles.size(); i = next++) {
      const StoreBox& tile = tiles[i];
      values.resize(static_cast<std::size_t>(tile.voxels()) * type_.bytes);
      if (const Outcome got = part_.stored->read(part_.level, tile, values); !got) {
        const std::scoped_lock lock(mutex);
        if (result) result = got;
        next = tiles.size();
        return;
      }
      const std::size_t tile_row = static_cast<std::size_t>(tile.size.x) * type_.bytes;
      const std::byte* from = values.data();
      for (int k = 0; k < tile.size.z; ++k)
        for (int j = 0; j < tile.size.y; ++j, from += tile_row)
          std::memcpy(slab_.data() + static_cast<std::size_t>(k) * layer + static_cast<std::size_t>(tile.lo.y - box.lo.y + j) * row +
                          static_cast<std::size_t>(tile.lo.x - box.lo.x) * type_.bytes,
                      from, tile_row);
    }
  };
  std::vector<std::thread> helpers;
  for (std::size_t i = 1; i < std::min<std::size_t>(Store::kReaders, tiles.size()); ++i)
    if (auto thread = start_thread("a store", work)) helpers.push_back(std::move(*thread));
  work();
  for (std::thread& helper : helpers) helper.join();
  return result;
}

}  // namespace catena::field
