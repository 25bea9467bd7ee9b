#include "render/mirror/brick_map.h"

#include <algorithm>
#include <cstring>

#include "render/vk/upload.h"

namespace catena::render {

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
