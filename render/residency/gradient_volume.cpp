// SPDX-License-Identifier: MIT
#include "render/residency/gradient_volume.h"

#include <Imath/half.h>
#include <cmath>
#include <cstring>

#include "render/vk/commands.h"

namespace catena::render {

using field::Index3;

float BlockGradient::length() const { return std::sqrt(x * x + y * y + z * z); }

BlockGradient block_gradient(const VoxelBlock& block, int x, int y, int z) {
  const std::size_t row = std::size_t(block.size.x), plane = row * std::size_t(block.size.y), at = block.voxel_index(x, y, z);
  const auto along = [&](int i, int size, std::size_t stride) {
    const bool before = i > 0 && block.is_used(at - stride), after = i + 1 < size && block.is_used(at + stride);
    const float both = block.values[at + (after ? stride : 0)] - block.values[at - (before ? stride : 0)];
    return before && after ? 0.5f * both : both;
  };
  return {along(x, block.size.x, 1), along(y, block.size.y, row), along(z, block.size.z, plane)};
}

void write_gradient(const BlockGradient& g, double per_code, std::byte* out) {
  constexpr float kMaxGradient = 6e4f;  // maximum of a half float, with a margin for rounding
  const double codes = per_code > 0 ? 1 / per_code : 0, length = codes * double(g.length());
  const double scale = length > double(kMaxGradient) ? codes * (double(kMaxGradient) / length) : codes;
  const auto half = [scale](float a) { return imath_float_to_half(float(double(a) * scale)); };
  const std::uint16_t texel[4] = {half(g.x), half(g.y), half(g.z), 0};
  std::memcpy(out, texel, kGradientBytes);
}

Result<vk::Image> make_gradient_volume(vk::Device& device, const field::ScalarGrid& grid, double per_code) {
  const Index3 n = voxel_extent(grid).size;
  const std::size_t plane = std::size_t(n.x) * std::size_t(n.y);
  CATENA_TRY(vk::Image image,
             vk::Image::create(device, vk::volume_image_info(kGradientFormat, std::size_t(n.x), std::size_t(n.y), std::size_t(n.z))));
  CATENA_CHECK(vk::upload_planes(device, image, kSlabPlanes, [&](std::uint32_t first, std::uint32_t count, std::byte* out) {
    for_each_slab(grid, {int(first), int(count), 1, 1}, [&](const Slab& slab) {
      std::byte* at = out + kGradientBytes * plane * std::size_t(slab.first - int(first));
      for (int z = 0; z < slab.planes; ++z)
        for (int y = 0; y < n.y; ++y)
          for (int x = 0; x < n.x; ++x, at += kGradientBytes)
            write_gradient(block_gradient(slab.block, x, y, slab.offset + z), per_code, at);
    });
  }));
  return image;
}

}  // namespace catena::render
