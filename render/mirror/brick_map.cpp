#include "render/mirror/brick_map.h"

#include <algorithm>
#include <cstring>

#include "render/vk/upload.h"

namespace catena::render {

Result<BrickMap> make_word_map(vk::Device& device, const GridMirror& mirror, std::span<const std::uint8_t> high) {
  CATENA_ASSERT(mirror.drawable && high.size() == mirror.ranges.size());
  BrickMap map;
  map.total = map.active = high.size();
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
      words[i] = (mirror.atlas ? mirror.slots[brick] : 0u) | std::uint32_t(high[brick]) << 24;
    }
    std::memcpy(out, words.data(), words.size() * sizeof(std::uint32_t));
  }));
  return map;
}

Result<BrickMap> make_brick_map(vk::Device& device, const GridMirror& mirror, const std::function<bool(const BrickRange&)>& is_active) {
  std::vector<std::uint8_t> active(mirror.ranges.size());
  std::transform(mirror.ranges.begin(), mirror.ranges.end(), active.begin(),
                 [&](const BrickRange& r) { return !r.empty() && is_active(r); });
  CATENA_TRY(BrickMap map, make_word_map(device, mirror, brick_distances(mirror.bricks, active)));
  map.active = std::uint64_t(std::count(active.begin(), active.end(), 1));
  return map;
}

Result<BrickMap> make_leap_map(vk::Device& device, const GridMirror& mirror, const std::function<std::uint16_t(const BrickRange&)>& kind) {
  std::vector<std::uint16_t> kinds(mirror.ranges.size());
  std::transform(mirror.ranges.begin(), mirror.ranges.end(), kinds.begin(), [&](const BrickRange& r) -> std::uint16_t {
    const std::uint16_t k = r.empty() ? std::uint16_t(1) : kind(r);
    return mirror.masked && k > 1 ? 0 : k;
  });
  std::vector<std::uint8_t> high = plain_distances(mirror.bricks, kinds);
  for (std::size_t i = 0; i < high.size(); ++i) high[i] = std::uint8_t(std::min<int>(high[i], 127) | (kinds[i] > 1 ? 128 : 0));
  CATENA_TRY(BrickMap map, make_word_map(device, mirror, high));
  map.active = std::uint64_t(std::count(kinds.begin(), kinds.end(), 0));
  return map;
}

}  // namespace catena::render
