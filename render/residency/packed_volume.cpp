// SPDX-License-Identifier: MIT
#include "render/residency/packed_volume.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <mutex>

#include "engine/base/threads.h"
#include "render/residency/gradient_volume.h"
#include "render/vk/commands.h"

namespace catena::render {

namespace {

using field::Index3;
constexpr double kMaxVoxels = 64.0 * 1024 * 1024;  // 256 MiB of words; larger grids are packed as bricks

ValueInterval range_to_encode(const field::ScalarGrid& grid, const ValueInterval& active) {
  ValueInterval range = active;
  const field::GridStats& stats = grid.stats();
  const double background = grid.background();
  const bool whole = active.min <= std::min(stats.min, background) && active.max >= std::max(stats.max, background);
  if (whole) return range;
  std::mutex lock;
  for_each_slab(grid, {.count = voxel_extent(grid).size.z, .margin_after = 1}, [&](const Slab& slab) {
    ValueInterval part = active;
    widen_to_cells(part, slab.block, active);
    const std::scoped_lock held(lock);
    range = {std::min(range.min, part.min), std::max(range.max, part.max)};
  });
  return clip_outliers(range, grid, active);
}

std::vector<std::uint8_t> all_codes(const field::ScalarGrid& grid, const CodeScale& scale) {
  const Index3 n = voxel_extent(grid).size;
  const std::size_t plane = std::size_t(n.x) * std::size_t(n.y);
  std::vector<std::uint8_t> codes(plane * std::size_t(n.z));
  for_each_slab(grid, {.count = n.z}, [&](const Slab& slab) {
    scale.encode(slab.block, 0, plane * std::size_t(slab.planes), &codes[plane * std::size_t(slab.first)]);
  });
  return codes;
}

Outcome upload_words(vk::Device& device, vk::Image& image, const Index3& n, const std::vector<std::uint8_t>& codes) {
  const std::size_t row = std::size_t(n.x), plane = row * std::size_t(n.y);
  return vk::upload_planes(device, image, 1, [&](std::uint32_t first, std::uint32_t count, std::byte* out) {
    parallel_for(std::size_t(count) * std::size_t(n.y), 64, [&](std::size_t begin, std::size_t end) {
      std::vector<std::uint32_t> words(row);
      for (std::size_t line = begin; line < end; ++line) {
        const std::uint8_t* a = &codes[first * plane + line * row];
        const std::uint8_t* b = line % std::size_t(n.y) + 1 < std::size_t(n.y) ? a + row : a;
        for (std::size_t x = 0; x + 1 < row; ++x)
          words[x] = a[x] | std::uint32_t(a[x + 1]) << 8 | std::uint32_t(b[x]) << 16 | std::uint32_t(b[x + 1]) << 24;
        words[row - 1] = (a[row - 1] | std::uint32_t(b[row - 1]) << 16) * 0x101u;
        std::memcpy(out + line * row * 4, words.data(), row * 4);
      }
    });
  });
}

void find_ranges(PackedVolume& packed, const std::vector<std::uint8_t>& codes) {
  const Index3 n = packed.size;
  const std::size_t row = std::size_t(n.x), plane = row * std::size_t(n.y);
  const auto bricks = [](int voxels) { return (voxels - 1 + kSmallBrickSize - 1) / kSmallBrickSize; };
  packed.bricks = {bricks(n.x), bricks(n.y), bricks(n.z)};
  const std::size_t bx = std::size_t(packed.bricks[0]), by = std::size_t(packed.bricks[1]), bz = std::size_t(packed.bricks[2]);
  packed.ranges.assign(bx * by * bz, CodeRange{});
  const bool masked = packed.codes.has_mask;
  parallel_for(by * bz, 16, [&](std::size_t begin, std::size_t end) {
    std::vector<std::uint8_t> min_codes(row), max_codes(row), holes(row);
    for (std::size_t line = begin; line < end; ++line) {
      const int y0 = kSmallBrickSize * int(line % by), z0 = kSmallBrickSize * int(line / by);
      std::fill(min_codes.begin(), min_codes.end(), std::uint8_t(255));
      std::fill(max_codes.begin(), max_codes.end(), std::uint8_t(0));
      std::fill(holes.begin(), holes.end(), std::uint8_t(0));
      for (int z = z0; z <= std::min(z0 + kSmallBrickSize, n.z - 1); ++z)
        for (int y = y0; y <= std::min(y0 + kSmallBrickSize, n.y - 1); ++y) {
          const std::uint8_t* from = &codes[std::size_t(z) * plane + std::size_t(y) * row];
          for (std::size_t x = 0; x < row; ++x) {
            const std::uint8_t none = masked && from[x] == CodeScale::kInvalidCode ? 255 : 0;
            min_codes[x] = std::min(min_codes[x], std::uint8_t(from[x] | none));
            max_codes[x] = std::max(max_codes[x], from[x]);
            holes[x] = std::uint8_t(holes[x] | none);
          }
        }
      for (std::size_t x = 0; x < bx; ++x) {
        CodeRange& range = packed.ranges[line * bx + x];
        for (std::size_t k = kSmallBrickSize * x; k <= std::min(kSmallBrickSize * (x + 1), row - 1); ++k)
          range = {std::min(range.min, min_codes[k]), std::max(range.max, max_codes[k]), range.has_unused || holes[k]};
      }
    }
  });
}

}  // namespace

bool can_pack_dense(const vk::Device& device, const field::ScalarGrid& grid) {
  const field::Box& box = grid.index_box();
  const Vec3 n = box.hi - box.lo + Vec3(1.0);
  const double limit = device.info().limits.maxImageDimension3D;
  return !grid.has_cell_mask() && grid.stats().active_voxels > 0 && std::min({n.x, n.y, n.z}) >= 2 && std::max({n.x, n.y, n.z}) <= limit &&
         n.x * n.y * n.z <= kMaxVoxels;
}

std::uint64_t packed_bytes(const field::ScalarGrid& grid, bool gradients) {
  const Index3 n = voxel_extent(grid).size;
  return (sizeof(std::uint32_t) + (gradients ? kGradientBytes : 0)) * std::uint64_t(n.x) * std::uint64_t(n.y) * std::uint64_t(n.z);
}

Result<PackedVolume> make_packed_volume(vk::Device& device, const field::ScalarGrid& grid, const ValueInterval& active) {
  CATENA_ASSERT(can_pack_dense(device, grid));
  const VoxelExtent extent = voxel_extent(grid);
  const Index3 n = extent.size;
  PackedVolume packed;
  packed.origin = extent.lo;
  packed.size = n;
  packed.codes = CodeScale(range_to_encode(grid, active), has_invalid_cells(grid));
  const std::vector<std::uint8_t> codes = all_codes(grid, packed.codes);

  const vk::ImageInfo info = vk::volume_image_info(VK_FORMAT_R32_UINT, std::size_t(n.x), std::size_t(n.y), std::size_t(n.z));
  auto image = vk::Image::create(device, info);
  if (!image) return Error{fmt::format("the grid \"{}\" cannot be packed: {}", grid.name(), image.error().message)};
  packed.words = std::move(*image);
  CATENA_CHECK(upload_words(device, packed.words, n, codes));
  find_ranges(packed, codes);
  return packed;
}

}  // namespace catena::render
