#include "render/mirror/plain_map.h"

#include <algorithm>
#include <cstring>

#include "render/vk/upload.h"

namespace catena::render {

Result<PlainMap> make_plain_map(vk::Device& device, const PackedVolume& packed, std::span<const std::uint16_t, 256> look) {
  std::vector<std::uint16_t> kind(packed.ranges.size());
  for (std::size_t i = 0; i < kind.size(); ++i) {
    const CodeRange& r = packed.ranges[i];
    kind[i] = look[r.least] == look[r.greatest] ? std::uint16_t(look[r.least] + 1) : 0;
  }
  const std::vector<std::uint8_t> distance = plain_distances(packed.bricks, kind);
  PlainMap map;
  map.leaping = double(std::count_if(distance.begin(), distance.end(), [](std::uint8_t d) { return d > 0; })) / double(distance.size());
  vk::ImageInfo info;
  info.type = VK_IMAGE_TYPE_3D;
  info.format = VK_FORMAT_R8_UINT;
  info.extent = {std::uint32_t(packed.bricks[0]), std::uint32_t(packed.bricks[1]), std::uint32_t(packed.bricks[2])};
  info.usage = VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT;
  CATENA_TRY(map.image, vk::Image::create(device, info));
  const std::size_t plane = std::size_t(packed.bricks[0]) * packed.bricks[1];
  CATENA_CHECK(vk::upload_planes(device, map.image, 1, [&](std::uint32_t first, std::uint32_t count, std::byte* out) {
    std::memcpy(out, distance.data() + first * plane, count * plane);
  }));
  return map;
}

}  // namespace catena::render
