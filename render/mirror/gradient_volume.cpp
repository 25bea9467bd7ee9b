#include "render/mirror/gradient_volume.h"

#include <algorithm>
#include <cmath>

#include "render/vk/commands.h"

namespace catena::render {

using field::Index3;

float BlockGradient::length() const { return std::sqrt(x * x + y * y + z * z); }

BlockGradient gradient_in(const VoxelBlock& block, int x, int y, int z) {
  const std::size_t row = std::size_t(block.size.x), plane = row * std::size_t(block.size.y), at = block.at(x, y, z);
  const auto along = [&](int i, int size, std::size_t stride) {
    const bool before = i > 0 && block.is_used(at - stride), after = i + 1 < size && block.is_used(at + stride);
    const float both = block.values[at + (after ? stride : 0)] - block.values[at - (before ? stride : 0)];
    return before && after ? 0.5f * both : both;
  };
  return {along(x, block.size.x, 1), along(y, block.size.y, row), along(z, block.size.z, plane)};
}

void GradientMean::add(const VoxelBlock& block, const ValueInterval& active, int x, int y, int z) {
  const std::size_t at = block.at(x, y, z);
  const float v = block.values[at];
  if (!(v >= float(active.least) && v <= float(active.greatest)) || !block.is_used(at)) return;
  const double l = gradient_in(block, x, y, z).length();
  squares += l * l;
  count += l > 0 ? 1 : 0;
}

void GradientMean::add(const GradientMean& other) {
  squares += other.squares;
  count += other.count;
}

float GradientMean::longest() const { return count > 0 ? float(3 * std::sqrt(squares / count)) : 3; }

void write_gradient(const BlockGradient& g, float longest, std::byte* out) {
  const float length = g.length(), scale = 1 / std::max(longest, length);
  const auto code = [scale](float a) { return std::byte(std::lround(128 + 127 * a * scale)); };
  out[0] = code(g.x);
  out[1] = code(g.y);
  out[2] = code(g.z);
  out[3] = std::byte(length > longest ? 255 : 0);
}

Result<GradientVolume> make_gradient_volume(vk::Device& device, const field::ScalarGrid& grid, const ValueInterval& active) {
  const VoxelExtent extent = voxel_extent(grid);
  const Index3 n = extent.size;
  const std::size_t plane = std::size_t(n.x) * std::size_t(n.y);

  // of every second voxel an axis
  std::vector<GradientMean> parts(std::size_t((n.z + kSlab - 1) / kSlab));
  for_slabs(grid, {.count = n.z, .before = 1, .behind = 1}, [&](const Slab& slab) {
    for (int z = 0; z < slab.planes; z += 2)
      for (int y = 0; y < n.y; y += 2)
        for (int x = 0; x < n.x; x += 2) parts[std::size_t(slab.first / kSlab)].add(slab.block, active, x, y, slab.offset + z);
  });
  GradientMean mean;
  for (const GradientMean& part : parts) mean.add(part);
  const float longest = mean.longest();
  GradientVolume volume;
  volume.unit = longest / 127;

  const vk::ImageInfo info = vk::volume_info(VK_FORMAT_R8G8B8A8_UNORM, std::size_t(n.x), std::size_t(n.y), std::size_t(n.z));
  CATENA_TRY(volume.image, vk::Image::create(device, info));
  CATENA_CHECK(vk::upload_planes(device, volume.image, kSlab, [&](std::uint32_t first, std::uint32_t count, std::byte* out) {
    for_slabs(grid, {int(first), int(count), 1, 1}, [&](const Slab& slab) {
      std::byte* at = out + 4 * plane * std::size_t(slab.first - int(first));
      for (int z = 0; z < slab.planes; ++z)
        for (int y = 0; y < n.y; ++y)
          for (int x = 0; x < n.x; ++x, at += 4) write_gradient(gradient_in(slab.block, x, y, slab.offset + z), longest, at);
    });
  }));
  return volume;
}

}  // namespace catena::render
