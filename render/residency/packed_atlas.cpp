// SPDX-License-Identifier: MIT
#include "render/residency/packed_atlas.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <mutex>

#include "engine/base/threads.h"
#include "render/residency/brick_map.h"
#include "render/residency/brick_slots.h"
#include "render/residency/gradient_volume.h"
#include "render/vk/commands.h"

namespace catena::render {

namespace {

using field::Index3;

constexpr double kMaxBricks = 1 << 24;
constexpr std::size_t kWordsX = kBrickSize, kWordsY = kPaddedBrickSize, kWordsZ = kPaddedBrickSize;
constexpr double kRoughnessTolerance = 0.01;
constexpr std::uint32_t kWithoutSlot = 1u << 31;

/// The grid's voxels of a brick and of `margin` layers around it.
struct BrickBlock {
  VoxelBlock block;
  Index3 offset;  ///< index of the brick's first voxel in the block; negative if the grid begins within the brick

  void read(const field::ScalarGrid& grid, const BrickScan& scan, const Index3& brick, int margin) {
    const auto along = [&](int b, int lo, int hi, int& from, int& count, int& at) {
      const int first = kBrickSize * b;
      from = std::max(lo, first - margin);
      count = std::min(hi, first + kBrickSize + margin) - from + 1;
      at = first - from;
    };
    Index3 from, count;
    along(brick.x, scan.box_lo.x, scan.box_hi.x, from.x, count.x, offset.x);
    along(brick.y, scan.box_lo.y, scan.box_hi.y, from.y, count.y, offset.y);
    along(brick.z, scan.box_lo.z, scan.box_hi.z, from.z, count.z, offset.z);
    block.read(grid, {scan.origin.x + from.x, scan.origin.y + from.y, scan.origin.z + from.z}, count, false);
  }
  /// First and last voxel of the brick that the block contains, along an axis.
  static int first(int offset) { return std::max(0, -offset); }
  static int last(int offset, int size) { return std::min(kBrickSize, size - 1 - offset); }
};

Index3 brick_at(const std::array<std::int32_t, 3>& bricks, std::size_t i) {
  const auto bx = std::size_t(bricks[0]), by = std::size_t(bricks[1]);
  return {std::int32_t(i % bx), std::int32_t(i / bx % by), std::int32_t(i / bx / by)};
}

/// Finds bricks whose 9^3 voxels are one value without a leaf of the tree.
class ConstantBricks {
 public:
  ConstantBricks(const field::ScalarGrid& grid, const BrickScan& scan) : wide_{scan.bricks[0] + 1, scan.bricks[1] + 1, scan.bricks[2] + 1} {
    constant_.resize(std::size_t(wide_[0]) * std::size_t(wide_[1]) * std::size_t(wide_[2]));
    value_.resize(constant_.size());
    parallel_for(constant_.size(), 256, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) {
        const Index3 b = brick_at(wide_, i);
        constant_[i] = grid.is_constant_block(
            {scan.origin.x + kBrickSize * b.x, scan.origin.y + kBrickSize * b.y, scan.origin.z + kBrickSize * b.z}, value_[i]);
      }
    });
  }
  bool find(const Index3& brick, float& value) const {
    const auto at = [&](int c) {
      return (std::size_t(brick.z + (c >> 2)) * std::size_t(wide_[1]) + std::size_t(brick.y + (c >> 1 & 1))) * std::size_t(wide_[0]) +
             std::size_t(brick.x + (c & 1));
    };
    value = value_[at(0)];
    for (int c = 0; c < 8; ++c)
      if (!constant_[at(c)] || value_[at(c)] != value) return false;
    return true;
  }

 private:
  std::array<std::int32_t, 3> wide_;
  std::vector<std::uint8_t> constant_;
  std::vector<float> value_;
};

/// Error of interpolating each gradient from its neighbors, with gradients at every second voxel.
struct GradientSums {
  double errors = 0, pairs = 0;

  void add(const VoxelBlock& block, const Index3& o) {
    for (int z = BrickBlock::first(o.z); z <= BrickBlock::last(o.z, block.size.z); z += 2)
      for (int y = BrickBlock::first(o.y); y <= BrickBlock::last(o.y, block.size.y); y += 2)
        for (int x = BrickBlock::first(o.x); x <= BrickBlock::last(o.x, block.size.x); x += 2) {
          if (x + 2 > BrickBlock::last(o.x, block.size.x)) continue;
          const auto at = [&](int k) { return block_gradient(block, o.x + x + k, o.y + y, o.z + z); };
          const BlockGradient a = at(0), b = at(1), c = at(2),
                              error{b.x - 0.5f * (a.x + c.x), b.y - 0.5f * (a.y + c.y), b.z - 0.5f * (a.z + c.z)};
          errors += double(error.length()) * error.length();
          pairs += double(b.length()) * b.length();
        }
  }
  void add(const GradientSums& other) {
    errors += other.errors;
    pairs += other.pairs;
  }
};

}  // namespace

Error memory_limit_error(std::uint64_t needed, std::uint64_t limit) {
  return Error{fmt::format("it takes {} MiB on the device, at most {} are allowed", needed >> 20, limit >> 20)};
}

bool can_pack_as_bricks(const field::ScalarGrid& grid) {
  const Vec3 n = grid.index_box().hi - grid.index_box().lo + Vec3(1.0), bricks = n / double(kBrickSize) + Vec3(2.0);
  return grid.stats().active_voxels > 0 && std::min({n.x, n.y, n.z}) >= 2 && bricks.x * bricks.y * bricks.z <= kMaxBricks &&
         !has_invalid_cells(grid);
}

BrickScan scan_bricks(const field::ScalarGrid& grid, const ValueInterval& active, bool gradients) {
  CATENA_ASSERT(can_pack_as_bricks(grid));
  const VoxelExtent extent = voxel_extent(grid);
  const auto down = [](std::int32_t v) { return v & ~(kBrickSize - 1); };
  BrickScan scan;
  scan.origin = {down(extent.lo.x), down(extent.lo.y), down(extent.lo.z)};
  scan.box_lo = {extent.lo.x - scan.origin.x, extent.lo.y - scan.origin.y, extent.lo.z - scan.origin.z};
  scan.box_hi = {scan.box_lo.x + extent.size.x - 1, scan.box_lo.y + extent.size.y - 1, scan.box_lo.z + extent.size.z - 1};
  const auto bricks = [](std::int32_t hi) { return (hi + kBrickSize - 1) / kBrickSize; };
  scan.bricks = {bricks(scan.box_hi.x), bricks(scan.box_hi.y), bricks(scan.box_hi.z)};
  scan.values.resize(std::size_t(scan.bricks[0]) * std::size_t(scan.bricks[1]) * std::size_t(scan.bricks[2]));
  scan.range = active;

  const ConstantBricks constant(grid, scan);
  const std::size_t row = std::size_t(scan.bricks[0]);
  std::vector<GradientSums> means(scan.values.size() / row);
  std::mutex lock;
  parallel_for(means.size(), 4, [&](std::size_t begin, std::size_t end) {
    BrickBlock brick;
    ValueInterval range = active;
    for (std::size_t i = begin * row; i < end * row; ++i) {
      const Index3 at = brick_at(scan.bricks, i);
      float value = 0;
      if (constant.find(at, value)) {
        scan.values[i] = {value, value};
        continue;
      }
      brick.read(grid, scan, at, gradients && (at.x + at.y + at.z) % 3 == 0 ? 1 : 0);
      const VoxelBlock& block = brick.block;
      const Index3 o = brick.offset;
      BrickRange& r = scan.values[i];
      r = {HUGE_VALF, -HUGE_VALF};
      for (int z = BrickBlock::first(o.z); z <= BrickBlock::last(o.z, block.size.z); ++z)
        for (int y = BrickBlock::first(o.y); y <= BrickBlock::last(o.y, block.size.y); ++y)
          for (int x = BrickBlock::first(o.x); x <= BrickBlock::last(o.x, block.size.x); ++x) {
            const float v = block.values[block.voxel_index(o.x + x, o.y + y, o.z + z)];
            r.min = v < r.min ? v : r.min;
            r.max = v > r.max ? v : r.max;
          }
      if (r.max <= float(active.min) || r.min >= float(active.max)) continue;
      if (r.min < float(range.min) || r.max > float(range.max)) widen_to_cells(range, block, active);
      // a third of the bricks suffices for the estimate
      if (gradients && (at.x + at.y + at.z) % 3 == 0) means[i / row].add(block, o);
    }
    const std::scoped_lock held(lock);
    scan.range = {std::min(scan.range.min, range.min), std::max(scan.range.max, range.max)};
  });
  scan.range = clip_outliers(scan.range, grid, active);
  GradientSums sums;
  for (const GradientSums& part : means) sums.add(part);
  scan.with_gradients = gradients;
  scan.gradient_roughness = sums.pairs > 0 ? sums.errors / sums.pairs : 0;
  return scan;
}

namespace {

std::vector<CodeRange> code_ranges(const BrickScan& scan, const CodeScale& codes) {
  std::vector<CodeRange> ranges(scan.values.size());
  parallel_for(ranges.size(), 4096, [&](std::size_t begin, std::size_t end) {
    const auto encode = codes.encoder();
    for (std::size_t i = begin; i < end; ++i) ranges[i] = {encode(scan.values[i].min), encode(scan.values[i].max), false};
  });
  return ranges;
}

/// Returns which bricks must be stored.
std::vector<std::uint8_t> needed(const BrickScan& scan, const std::vector<CodeRange>& ranges, const std::vector<std::uint16_t>& kinds) {
  const auto [bx, by, bz] = scan.bricks;
  std::vector<std::uint8_t> retain(kinds.size());
  parallel_for(kinds.size(), 4096, [&, bx = bx, by = by, bz = bz](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const Index3 b = brick_at(scan.bricks, i);
      bool needs = kinds[i] != 1;
      // a ray samples the neighbors of a varying brick on its way into it
      for (int c = 0; c < 27 && !needs; ++c) {
        const int x = b.x + c % 3 - 1, y = b.y + c / 3 % 3 - 1, z = b.z + c / 9 - 1;
        if (x < 0 || y < 0 || z < 0 || x >= bx || y >= by || z >= bz) continue;
        needs = kinds[(std::size_t(z) * std::size_t(by) + std::size_t(y)) * std::size_t(bx) + std::size_t(x)] != 1;
      }
      retain[i] = needs && ranges[i].min != ranges[i].max;
    }
  });
  return retain;
}

Result<vk::Image> make_map(vk::Device& device, const BrickScan& scan, const PackedAtlas& atlas, const std::vector<CodeRange>& ranges,
                           const std::vector<std::uint16_t>& kinds) {
  const std::vector<std::uint8_t> distance = homogeneous_distances(scan.bricks, kinds);
  std::vector<std::uint32_t> words(kinds.size());
  for (std::size_t i = 0; i < words.size(); ++i) {
    const bool kept = atlas.slots[i] != PackedAtlas::kNotStored;
    words[i] = (kept ? atlas.slots[i] : kWithoutSlot | ranges[i].min) | std::uint32_t(std::min<int>(distance[i], 127)) << 24;
  }
  CATENA_TRY(vk::Image map, vk::Image::create(device, vk::volume_image_info(VK_FORMAT_R32_UINT, std::size_t(scan.bricks[0]),
                                                                            std::size_t(scan.bricks[1]), std::size_t(scan.bricks[2]))));
  const std::size_t plane = std::size_t(scan.bricks[0]) * std::size_t(scan.bricks[1]);
  CATENA_CHECK(vk::upload_planes(device, map, 1, [&](std::uint32_t first, std::uint32_t count, std::byte* out) {
    std::memcpy(out, words.data() + first * plane, count * plane * sizeof(words[0]));
  }));
  return map;
}

/// Requirements of a transfer function on the bricks of a scan.
struct BrickNeeds {
  std::vector<CodeRange> ranges;
  std::vector<std::uint16_t> kinds;  ///< CodeAppearance::kind
  std::vector<std::uint8_t> retain;

  BrickNeeds(const BrickScan& scan, const CodeScale& codes, const CodeAppearance& appearance)
      : ranges(code_ranges(scan, codes)), kinds(ranges.size()) {
    std::transform(ranges.begin(), ranges.end(), kinds.begin(), [&](const CodeRange& r) { return appearance.classify(r); });
    retain = needed(scan, ranges, kinds);
  }
};

struct BrickSource {
  const field::ScalarGrid& grid;
  const BrickScan& scan;
};

/// Assignment of the stored bricks to slots in three dimensions.
struct SlotPlan {
  std::vector<std::size_t> brick_of_slot;
  std::array<std::size_t, 3> slots{};

  /// Writes all slots of an image; a slot has n[0] x n[1] x n[2] texels of `texel` bytes. Calls write(the brick's voxels with `margin`
  /// layers around them, its first texel, bytes per row, bytes per plane).
  template <class Write>
  Outcome upload(vk::Device& device, vk::Image& image, std::array<std::size_t, 3> n, std::size_t texel, const BrickSource& source,
                 int margin, const Write& write) const {
    const std::size_t line = slots[0] * n[0] * texel, plane = line * slots[1] * n[1], a_layer = slots[0] * slots[1];
    return vk::upload_planes(device, image, std::uint32_t(n[2]), [&](std::uint32_t first, std::uint32_t count, std::byte* out) {
      const std::size_t begin_slot = first / n[2] * a_layer, end_slot = std::min(brick_of_slot.size(), begin_slot + count / n[2] * a_layer);
      std::memset(out, 0, plane * count);
      parallel_for(end_slot - begin_slot, 16, [&](std::size_t begin, std::size_t end) {
        BrickBlock block;
        for (std::size_t slot = begin_slot + begin; slot < begin_slot + end; ++slot) {
          const std::size_t x = slot % slots[0], y = slot / slots[0] % slots[1], z = (slot - begin_slot) / a_layer;
          block.read(source.grid, source.scan, brick_at(source.scan.bricks, brick_of_slot[slot]), margin);
          write(block, out + z * n[2] * plane + y * n[1] * line + x * n[0] * texel, line, plane);
        }
      });
    });
  }
};

Outcome upload_words(vk::Device& device, const BrickSource& source, const SlotPlan& plan, PackedAtlas& atlas) {
  CATENA_TRY(atlas.words, vk::Image::create(device, vk::volume_image_info(VK_FORMAT_R16_UINT, plan.slots[0] * kWordsX,
                                                                          plan.slots[1] * kWordsY, plan.slots[2] * kWordsZ)));
  return plan.upload(device, atlas.words, {kWordsX, kWordsY, kWordsZ}, 2, source, 0,
                     [&](const BrickBlock& brick, std::byte* out, std::size_t line, std::size_t plane) {
                       const VoxelBlock& block = brick.block;
                       const Index3 o = brick.offset;
                       std::array<std::uint8_t, kPaddedBrickSize> codes{};
                       for (int z = BrickBlock::first(o.z); z <= BrickBlock::last(o.z, block.size.z); ++z)
                         for (int y = BrickBlock::first(o.y); y <= BrickBlock::last(o.y, block.size.y); ++y) {
                           const int x0 = BrickBlock::first(o.x);
                           codes.fill(0);
                           atlas.codes.encode(block, block.voxel_index(0, o.y + y, o.z + z), std::size_t(block.size.x),
                                              &codes[std::size_t(x0)]);
                           std::array<std::uint16_t, kWordsX> words;
                           for (std::size_t x = 0; x < kWordsX; ++x) words[x] = std::uint16_t(codes[x] | codes[x + 1] << 8);
                           std::memcpy(out + std::size_t(z) * plane + std::size_t(y) * line, words.data(), sizeof(words));
                         }
                     });
}

Outcome upload_gradients(vk::Device& device, const BrickSource& source, const SlotPlan& plan, PackedAtlas& atlas) {
  const std::size_t nodes = atlas.gradient_nodes, apart = kBrickSize / (nodes - 1);
  CATENA_TRY(atlas.gradients, vk::Image::create(device, vk::volume_image_info(kGradientFormat, plan.slots[0] * nodes, plan.slots[1] * nodes,
                                                                              plan.slots[2] * nodes)));
  return plan.upload(
      device, atlas.gradients, {nodes, nodes, nodes}, kGradientBytes, source, 1,
      [&](const BrickBlock& brick, std::byte* out, std::size_t line, std::size_t plane) {
        const VoxelBlock& block = brick.block;
        const Index3 o = brick.offset;
        // beyond the grid's end the gradient at the end is repeated
        const auto voxel = [apart](std::size_t node, int offset, int size) {
          return offset + std::clamp(int(node * apart), BrickBlock::first(offset), BrickBlock::last(offset, size));
        };
        for (std::size_t z = 0; z < nodes; ++z)
          for (std::size_t y = 0; y < nodes; ++y)
            for (std::size_t x = 0; x < nodes; ++x)
              write_gradient(block_gradient(block, voxel(x, o.x, block.size.x), voxel(y, o.y, block.size.y), voxel(z, o.z, block.size.z)),
                             atlas.codes.per_code, out + z * plane + y * line + kGradientBytes * x);
      });
}

}  // namespace

Result<PackedAtlas> make_packed_atlas(vk::Device& device, const field::ScalarGrid& grid, const BrickScan& scan, const CodeScale& codes,
                                      const CodeAppearance& appearance, std::uint64_t max_bytes) {
  const BrickNeeds needs(scan, codes, appearance);
  const std::vector<std::uint8_t>& retain = needs.retain;
  PackedAtlas atlas;
  atlas.codes = codes;
  atlas.stored_count = std::uint64_t(std::count(retain.begin(), retain.end(), 1));
  const auto bytes_with = [&](std::uint64_t nodes) {
    return atlas.stored_count * (2 * kWordsX * kWordsY * kWordsZ + kGradientBytes * nodes * nodes * nodes);
  };
  if (scan.with_gradients)
    atlas.gradient_nodes =
        scan.gradient_roughness > kRoughnessTolerance && bytes_with(kPaddedBrickSize) <= max_bytes ? kPaddedBrickSize : kBrickSize / 2 + 1;
  const std::uint64_t bytes = bytes_with(atlas.gradient_nodes);
  if (bytes > max_bytes) return memory_limit_error(bytes, max_bytes);

  SlotPlan plan;
  const auto slots = assign_brick_slots(device, atlas.stored_count, kPaddedBrickSize);
  if (!slots) return Error{"it has to keep " + slots.error().message};
  std::copy(slots->slots_per_axis.begin(), slots->slots_per_axis.end(), plan.slots.begin());
  atlas.slots.assign(retain.size(), PackedAtlas::kNotStored);
  for (std::size_t i = 0; i < retain.size(); ++i) {
    if (!retain[i]) continue;
    atlas.slots[i] = slots->pack_slot(plan.brick_of_slot.size());
    plan.brick_of_slot.push_back(i);
  }
  CATENA_CHECK(upload_words(device, {grid, scan}, plan, atlas));
  if (scan.with_gradients) CATENA_CHECK(upload_gradients(device, {grid, scan}, plan, atlas));
  CATENA_TRY(atlas.map, make_map(device, scan, atlas, needs.ranges, needs.kinds));
  return atlas;
}

Result<bool> remap_atlas(vk::Device& device, PackedAtlas& atlas, const BrickScan& scan, const CodeAppearance& appearance) {
  const BrickNeeds needs(scan, atlas.codes, appearance);
  const std::vector<std::uint8_t>& retain = needs.retain;
  for (std::size_t i = 0; i < retain.size(); ++i)
    if (retain[i] && atlas.slots[i] == PackedAtlas::kNotStored) return false;
  CATENA_TRY(atlas.map, make_map(device, scan, atlas, needs.ranges, needs.kinds));
  return true;
}

}  // namespace catena::render
