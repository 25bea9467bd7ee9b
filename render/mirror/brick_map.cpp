#include "render/mirror/brick_map.h"

#include <algorithm>
#include <cstring>

#include "render/vk/upload.h"

namespace catena::render {

/// Chamfer distance of the largest coordinate: two sweeps over the 13 neighbours that come before (after) a brick.
std::vector<std::uint8_t> brick_distances(const std::array<std::int32_t, 3>& bricks, const std::vector<std::uint8_t>& active) {
  std::vector<std::uint8_t> distance(active.size());
  for (std::size_t i = 0; i < active.size(); ++i) distance[i] = active[i] ? 0 : 255;
  const auto [nx, ny, nz] = bricks;
  const auto index = [nx = nx, ny = ny](int x, int y, int z) { return (std::size_t(z) * ny + y) * nx + x; };
  const auto relax = [&, nx = nx, ny = ny, nz = nz](int x, int y, int z, int sign) {
    std::uint8_t& here = distance[index(x, y, z)];
    for (int k = 0; k < 13 && here > 0; ++k) {
      // neighbour k of the half space before (x, y, z), mirrored by sign
      const int dx = k % 3 - 1, dy = k / 3 % 3 - 1, dz = k / 9 - 1;
      const int a = x + sign * dx, b = y + sign * dy, c = z + sign * dz;
      if (a < 0 || b < 0 || c < 0 || a >= nx || b >= ny || c >= nz) continue;
      here = std::uint8_t(std::min<int>(here, std::min(255, distance[index(a, b, c)] + 1)));
    }
  };
  for (int z = 0; z < nz; ++z)
    for (int y = 0; y < ny; ++y)
      for (int x = 0; x < nx; ++x) relax(x, y, z, 1);
  for (int z = nz - 1; z >= 0; --z)
    for (int y = ny - 1; y >= 0; --y)
      for (int x = nx - 1; x >= 0; --x) relax(x, y, z, -1);
  return distance;
}

Result<BrickMap> make_brick_map(vk::Device& device, const GridMirror& mirror, const std::function<bool(const BrickRange&)>& is_active) {
  CATENA_ASSERT(mirror.drawable);
  std::vector<std::uint8_t> active(mirror.ranges.size());
  BrickMap map;
  map.total = active.size();
  for (std::size_t i = 0; i < active.size(); ++i) {
    active[i] = !mirror.ranges[i].empty() && is_active(mirror.ranges[i]);
    map.active += active[i];
  }
  const std::vector<std::uint8_t> distance = brick_distances(mirror.bricks, active);

  vk::ImageInfo info;
  info.type = VK_IMAGE_TYPE_3D;
  info.format = VK_FORMAT_R32_UINT;
  info.extent = {std::uint32_t(mirror.bricks[0]), std::uint32_t(mirror.bricks[1]), std::uint32_t(mirror.bricks[2])};
  info.usage = VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT;
  CATENA_TRY(map.image, vk::Image::create(device, info));
  const std::size_t plane = std::size_t(mirror.bricks[0]) * mirror.bricks[1];
  CATENA_CHECK(vk::upload_planes(device, map.image, 1, [&](std::uint32_t first, std::uint32_t count, std::byte* out) {
    std::vector<std::uint32_t> words(plane * count);
    for (std::size_t i = 0; i < words.size(); ++i) {
      const std::size_t brick = first * plane + i;
      words[i] = (mirror.atlas ? mirror.slots[brick] : 0u) | std::uint32_t(distance[brick]) << 24;
    }
    std::memcpy(out, words.data(), words.size() * sizeof(std::uint32_t));
  }));
  return map;
}

}  // namespace catena::render
