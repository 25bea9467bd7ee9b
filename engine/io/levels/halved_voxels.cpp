// SPDX-License-Identifier: MIT
#include "engine/io/levels/halved_voxels.h"

#include <algorithm>
#include <array>
#include <map>
#include <memory>
#include <utility>

#include "engine/field/bricks/brick_range.h"
#include "engine/io/stores/store_voxels.h"
#include "engine/io/zarr/brick_values.h"

namespace catena::field {
namespace {

using Extents = std::array<int, 3>;
using BrickRanges = std::map<Extents, BrickRange>;

constexpr Extents kBrickEdges{kBrickEdge, kBrickEdge, kBrickEdge};

constexpr Index3 kBrickSize{kBrickEdge, kBrickEdge, kBrickEdge};
constexpr Index3 kHalvedSize{kBrickEdge / 2, kBrickEdge / 2, kBrickEdge / 2};

Index3 to_index(const Extents& n) { return {n[0], n[1], n[2]}; }

/// A box of voxels, `end` excluded.
struct VoxelRange {
  Extents lo{}, end{};
  Index3 size() const { return {end[0] - lo[0], end[1] - lo[1], end[2] - lo[2]}; }
};

/// Calls body(VoxelRange) for the pieces of a box between the multiples of `step`, until one fails.
template <class Body>
Outcome for_pieces(const VoxelRange& box, const Extents& step, const Body& body) {
  const auto next = [&](int at, int a) { return std::min(box.end[a], (at / step[a] + 1) * step[a]); };
  for (int z = box.lo[2]; z < box.end[2]; z = next(z, 2))
    for (int y = box.lo[1]; y < box.end[1]; y = next(y, 1))
      for (int x = box.lo[0]; x < box.end[0]; x = next(x, 0))
        CATENA_CHECK(body(VoxelRange{{x, y, z}, {next(x, 0), next(y, 1), next(z, 2)}}));
  return Done{};
}

/// Buffers of a thread.
struct HalvingBuffers {
  std::vector<std::byte> box, brick, halved;
};

/// Reads and halves boxes.
struct Halver {
  VoxelSource full;
  Index3 chunk;
  UseRange use_range;

  /// Returns the voxels that are read at once: a brick, or where chunks are shared by bricks, slabs along the axis of the thinnest chunks.
  Extents step_in(const VoxelRange& box) const {
    if (full.bricks_at_once == Index3{1, 1, 1}) return {kBrickEdge, kBrickEdge, kBrickEdge};
    constexpr double kWantedBytes = 16e6, kMaxBytes = 64e6;
    const Extents c{chunk.x, chunk.y, chunk.z};
    const auto thin = static_cast<std::size_t>(std::ranges::min_element(c) - c.begin());
    double layer = static_cast<double>(full.type.bytes);
    for (std::size_t a = 0; a < 3; ++a)
      if (a != thin) layer *= box.end[a] - box.lo[a];
    // powers of two: a slab has whole pairs of layers, and whole bricks or whole parts of one
    constexpr int kLargest = 1 << 24;
    int depth = 2;
    while (depth < kLargest && (depth < c[thin] || 2 * depth * layer <= kWantedBytes)) depth *= 2;
    while (depth > 2 && depth * layer > kMaxBytes) depth /= 2;
    Extents step{kLargest, kLargest, kLargest};
    step[thin] = depth;
    return step;
  }

  bool is_empty(const VoxelRange& brick) const {
    return full.is_empty && full.is_empty({brick.lo[0] / kBrickEdge, brick.lo[1] / kBrickEdge, brick.lo[2] / kBrickEdge});
  }

  /// Returns the box around the bricks of a slab that have data; empty: none has.
  VoxelRange with_data(const VoxelRange& slab) const {
    VoxelRange needed{slab.end, slab.lo};
    static_cast<void>(for_pieces(slab, kBrickEdges, [&](const VoxelRange& part) -> Outcome {
      if (is_empty(part)) return Done{};
      for (int a = 0; a < 3; ++a) {
        needed.lo[a] = std::min(needed.lo[a], part.lo[a]);
        needed.end[a] = std::max(needed.end[a], part.end[a]);
      }
      return Done{};
    }));
    return needed;
  }

  /// Reads and halves a slab into the box of `size` halved voxels from `lo` on; widens the ranges of its bricks.
  Outcome read_slab(const VoxelRange& slab, const Index3& lo, const Index3& size, std::span<std::byte> out, BrickRanges& ranges) const {
    const VoxelRange needed = with_data(slab);
    if (needed.lo[0] >= needed.end[0]) return Done{};
    const Index3 needed_size = needed.size();
    const std::size_t bytes = full.type.bytes;
    thread_local HalvingBuffers buffers;
    buffers.brick.resize(kBrickVoxels * bytes);
    buffers.halved.resize(kHalvedVoxels * bytes);
    buffers.box.resize(static_cast<std::size_t>(needed_size.x) * static_cast<std::size_t>(needed_size.y) *
                       static_cast<std::size_t>(needed_size.z) * bytes);
    CATENA_CHECK(full.read(to_index(needed.lo), needed_size, buffers.box));
    return for_pieces(needed, kBrickEdges, [&](const VoxelRange& part) -> Outcome {
      if (is_empty(part)) return Done{};
      const Index3 part_size = part.size();
      const Index3 in_box{part.lo[0] - needed.lo[0], part.lo[1] - needed.lo[1], part.lo[2] - needed.lo[2]};
      copy_box(bytes, buffers.box, needed_size, in_box, buffers.brick, kBrickSize, {0, 0, 0}, part_size);
      halve_brick(full.type, buffers.brick, part_size, full.units.is_label_map, buffers.halved);
      copy_box(bytes, buffers.halved, kHalvedSize, {0, 0, 0}, out, size,
               {part.lo[0] / 2 - lo.x, part.lo[1] / 2 - lo.y, part.lo[2] / 2 - lo.z},
               {(part_size.x + 1) / 2, (part_size.y + 1) / 2, (part_size.z + 1) / 2});
      const BrickRange range = find_range(full.type, buffers.brick, part_size, kBrickSize);
      const Extents brick{part.lo[0] / kBrickEdge, part.lo[1] / kBrickEdge, part.lo[2] / kBrickEdge};
      BrickRange& known = ranges.try_emplace(brick, range).first->second;
      known.min = std::min(known.min, range.min);
      known.max = std::max(known.max, range.max);
      return Done{};
    });
  }

  /// Writes a box of halved voxels from `lo` on.
  Outcome read(const Index3& lo, const Index3& size, std::span<std::byte> out) const {
    const Extents first{lo.x, lo.y, lo.z}, count{size.x, size.y, size.z}, all{full.size.x, full.size.y, full.size.z};
    VoxelRange box;
    for (int a = 0; a < 3; ++a) {
      box.lo[a] = 2 * first[a];
      box.end[a] = static_cast<int>(std::min<std::int64_t>(all[a], 2 * (std::int64_t{first[a]} + count[a])));
    }
    if (full.is_empty) fill_brick(full.type, full.fill_value, out);
    BrickRanges ranges;
    CATENA_CHECK(for_pieces(box, step_in(box), [&](const VoxelRange& slab) -> Outcome { return read_slab(slab, lo, size, out, ranges); }));
    for (const auto& [brick, range] : ranges) CATENA_CHECK(use_range(to_index(brick), range));
    return Done{};
  }
};

}  // namespace

VoxelSource halve_voxels(VoxelSource full, const Index3& chunk, double max_bytes, UseRange use_range) {
  const auto half = [](const Index3& n) { return Index3{(n.x + 1) / 2, (n.y + 1) / 2, (n.z + 1) / 2}; };
  VoxelSource source{full.name, full.type, half(full.size), Mapping::from_linear(Mat3(1.0), Vec3(0.0)), full.units, full.fill_value};
  source.identity = full.identity + "at half the resolution\n";
  source.bricks_at_once = bricks_that_share_chunks(source.size, half(chunk), source.type.bytes, max_bytes);
  if (full.is_empty) {
    const Index3 counts = brick_counts({full.size, {}});
    source.is_empty = [is_empty = full.is_empty, counts](const Index3& brick) {
      for (int z = 2 * brick.z; z < std::min(counts.z, 2 * brick.z + 2); ++z)
        for (int y = 2 * brick.y; y < std::min(counts.y, 2 * brick.y + 2); ++y)
          for (int x = 2 * brick.x; x < std::min(counts.x, 2 * brick.x + 2); ++x)
            if (!is_empty({x, y, z})) return false;
      return true;
    };
  }
  const auto halver = std::make_shared<const Halver>(Halver{std::move(full), chunk, std::move(use_range)});
  source.read = [halver](const Index3& lo, const Index3& size, std::span<std::byte> values) { return halver->read(lo, size, values); };
  return source;
}

}  // namespace catena::field
