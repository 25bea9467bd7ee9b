// SPDX-License-Identifier: MIT
#include "render/residency/brick_map.h"

#include <algorithm>
#include <cstring>

#include "render/vk/commands.h"

namespace catena::render {

namespace {

/// Creates an image of one texel per brick.
Result<vk::Image> make_image(vk::Device& device, const std::array<std::int32_t, 3>& bricks, VkFormat format) {
  return vk::Image::create(device, vk::volume_image_info(format, std::size_t(bricks[0]), std::size_t(bricks[1]), std::size_t(bricks[2])));
}

}  // namespace

// Chebyshev distance to the nearest brick of another kind, for all kinds at once; kind 0: 0. Computed by two sweeps over the 13 neighbors
// before (after) a brick. Bricks outside the grid count as the same kind.
std::vector<std::uint8_t> homogeneous_distances(const std::array<std::int32_t, 3>& bricks, const std::vector<std::uint16_t>& kind) {
  const auto [nx, ny, nz] = bricks;
  std::vector<std::uint8_t> distance(kind.size());
  for (std::size_t i = 0; i < kind.size(); ++i) distance[i] = kind[i] ? 255 : 0;
  const auto relax = [&, nx = nx, ny = ny, nz = nz](int x, int y, int z, int sign) {
    const std::size_t at = (std::size_t(z) * ny + y) * nx + x;
    int here = distance[at];
    for (int k = 0; k < 13 && here > 1; ++k) {
      const int a = x + sign * (k % 3 - 1), b = y + sign * (k / 3 % 3 - 1), c = z + sign * (k / 9 - 1);
      if (a < 0 || b < 0 || c < 0 || a >= nx || b >= ny || c >= nz) continue;
      const std::size_t other = (std::size_t(c) * ny + b) * nx + a;
      here = std::min(here, kind[other] == kind[at] ? distance[other] + 1 : 1);
    }
    distance[at] = std::uint8_t(here);
  };
  for (int z = 0; z < nz; ++z)
    for (int y = 0; y < ny; ++y)
      for (int x = 0; x < nx; ++x) relax(x, y, z, 1);
  for (int z = nz - 1; z >= 0; --z)
    for (int y = ny - 1; y >= 0; --y)
      for (int x = nx - 1; x >= 0; --x) relax(x, y, z, -1);
  return distance;
}

std::vector<std::uint8_t> empty_distances(const std::array<std::int32_t, 3>& bricks, const std::vector<std::uint8_t>& active) {
  std::vector<std::uint16_t> kind(active.size());
  std::transform(active.begin(), active.end(), kind.begin(), [](std::uint8_t a) { return std::uint16_t(a ? 0 : 1); });
  return homogeneous_distances(bricks, kind);
}

Result<BrickMap> make_brick_word_map(vk::Device& device, const ResidentGrid& resident, std::span<const std::uint8_t> high) {
  CATENA_ASSERT(resident.is_drawable && high.size() == resident.brick_ranges.size());
  BrickMap map;
  map.total_count = map.active_count = high.size();
  CATENA_TRY(map.image, make_image(device, resident.bricks, VK_FORMAT_R32_UINT));
  const std::size_t plane = std::size_t(resident.bricks[0]) * resident.bricks[1];
  CATENA_CHECK(vk::upload_planes(device, map.image, 1, [&](std::uint32_t first, std::uint32_t count, std::byte* out) {
    std::vector<std::uint32_t> words(plane * count);
    for (std::size_t i = 0; i < words.size(); ++i) {
      const std::size_t brick = first * plane + i;
      words[i] = (resident.atlas ? resident.brick_slots[brick] : 0u) | std::uint32_t(high[brick]) << 24;
    }
    std::memcpy(out, words.data(), words.size() * sizeof(std::uint32_t));
  }));
  return map;
}

Result<BrickMap> make_brick_map(vk::Device& device, const ResidentGrid& resident, const std::function<bool(const BrickRange&)>& is_active) {
  std::vector<std::uint8_t> active(resident.brick_ranges.size());
  std::transform(resident.brick_ranges.begin(), resident.brick_ranges.end(), active.begin(),
                 [&](const BrickRange& r) { return !r.empty() && is_active(r); });
  CATENA_TRY(BrickMap map, make_brick_word_map(device, resident, empty_distances(resident.bricks, active)));
  map.active_count = std::uint64_t(std::count(active.begin(), active.end(), 1));
  return map;
}

Result<BrickMap> make_skip_map(vk::Device& device, const ResidentGrid& resident,
                               const std::function<std::uint16_t(const BrickRange&)>& kind) {
  std::vector<std::uint16_t> kinds(resident.brick_ranges.size());
  std::transform(resident.brick_ranges.begin(), resident.brick_ranges.end(), kinds.begin(), [&](const BrickRange& r) -> std::uint16_t {
    const std::uint16_t k = r.empty() ? std::uint16_t(1) : kind(r);
    return resident.masked && k > 1 ? 0 : k;
  });
  std::vector<std::uint8_t> high = homogeneous_distances(resident.bricks, kinds);
  for (std::size_t i = 0; i < high.size(); ++i) high[i] = std::uint8_t(std::min<int>(high[i], 127) | (kinds[i] > 1 ? 128 : 0));
  CATENA_TRY(BrickMap map, make_brick_word_map(device, resident, high));
  map.active_count = std::uint64_t(std::count(kinds.begin(), kinds.end(), 0));
  return map;
}

Result<HomogeneousMap> make_homogeneous_map(vk::Device& device, const PackedVolume& packed, const CodeAppearance& appearance) {
  std::vector<std::uint16_t> kind(packed.ranges.size());
  std::transform(packed.ranges.begin(), packed.ranges.end(), kind.begin(), [&](const CodeRange& r) { return appearance.classify(r); });
  const std::vector<std::uint8_t> distance = homogeneous_distances(packed.bricks, kind);
  HomogeneousMap map;
  map.skippable_share =
      double(std::count_if(distance.begin(), distance.end(), [](std::uint8_t d) { return d > 0; })) / double(distance.size());
  CATENA_TRY(map.image, make_image(device, packed.bricks, VK_FORMAT_R8_UINT));
  const std::size_t plane = std::size_t(packed.bricks[0]) * packed.bricks[1];
  CATENA_CHECK(vk::upload_planes(device, map.image, 1, [&](std::uint32_t first, std::uint32_t count, std::byte* out) {
    std::memcpy(out, distance.data() + first * plane, count * plane);
  }));
  return map;
}

}  // namespace catena::render
