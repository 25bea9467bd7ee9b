// SPDX-License-Identifier: MIT
#include "render/light/light_grid.h"

#include <array>
#include <cmath>
#include <cstring>
#include <limits>

#include "render/light/light_sweep.h"
#include "render/vk/commands.h"

namespace catena::render {
namespace {

constexpr VkFormat kFormat = VK_FORMAT_R8G8B8A8_UNORM;
using Texel = std::array<std::uint8_t, 4>;

std::uint8_t to_byte(float share) { return std::uint8_t(std::lround(255 * std::clamp(share, 0.0f, 1.0f))); }

/// Returns the shares of the lights (red, green, blue) and of the environment (alpha) that arrive in the cells.
std::vector<Texel> arriving_light(const LightCells& cells, const FramePacket& packet) {
  std::vector<Texel> texels(cells.count(), Texel{255, 255, 255, 255});
  for (std::size_t i = 0; packet.illumination.shadows && i < std::min(kMaxShadows, packet.lights.size()); ++i) {
    if (packet.lights[i].camera_relative) continue;
    const std::vector<float> share = sweep_light(cells, direction(packet.lights[i].direction), std::numeric_limits<double>::infinity());
    for (std::size_t k = 0; k < share.size(); ++k) texels[k][i] = to_byte(share[k]);
  }
  if (packet.illumination.occlusion_reach > 0) {
    const std::vector<float> share = sweep_environment(cells, packet.illumination.occlusion_reach);
    const auto strength = float(packet.illumination.occlusion_strength);
    for (std::size_t k = 0; k < share.size(); ++k) texels[k][3] = to_byte(1 - strength * (1 - share[k]));
  }
  return texels;
}

}  // namespace

Result<LightGrid> LightGrid::create(vk::Device& device) {
  LightGrid self;
  CATENA_TRY(self.linear_, vk::Sampler::create(device, vk::Filter::linear));
  CATENA_TRY(self.open_, vk::Image::create(device, vk::volume_image_info(kFormat, 1, 1, 1)));
  CATENA_CHECK(
      vk::upload_planes(device, self.open_, 1, [](std::uint32_t, std::uint32_t, std::byte* out) { std::memset(out, 255, sizeof(Texel)); }));
  return self;
}

Outcome LightGrid::update(vk::Device& device, const FramePacket& packet, bool is_only_view) {
  is_on_ = false;
  device.share(open_, linear_);
  if (!packet.illumination.is_cast()) {
    if (is_only_view) inputs_.reset(), image_ = {};
    return Done{};
  }
  Inputs inputs{packet.illumination, packet.lights, packet.clip_planes, packet.volumes, packet.isosurfaces,
                packet.meshes,       packet.tubes,  packet.arrows,      packet.glyphs,  packet.spheres};
  if (!inputs_ || !(*inputs_ == inputs)) {
    inputs_.reset();
    const LightCells cells = make_light_cells(packet);
    if (!(cells.edge > 0)) return Done{};
    CATENA_CHECK(upload(device, cells, packet));
    inputs_ = std::move(inputs);
  }
  device.share(image_, linear_);
  is_on_ = true;
  return Done{};
}

Outcome LightGrid::upload(vk::Device& device, const LightCells& cells, const FramePacket& packet) {
  const std::vector<Texel> texels = arriving_light(cells, packet);
  const auto [nx, ny, nz] = std::array{std::size_t(cells.size.x), std::size_t(cells.size.y), std::size_t(cells.size.z)};
  CATENA_TRY(image_, vk::Image::create(device, vk::volume_image_info(kFormat, nx, ny, nz)));
  CATENA_CHECK(vk::upload_planes(device, image_, 1, [&](std::uint32_t first, std::uint32_t count, std::byte* out) {
    std::memcpy(out, texels.data() + std::size_t(first) * nx * ny, std::size_t(count) * nx * ny * sizeof(Texel));
  }));
  ++version_;
  lo_ = cells.lo;
  constexpr double kOffsetCells = 1.5;
  surface_offset_ = kOffsetCells * cells.edge;
  const IlluminationItem& item = packet.illumination;
  open_share_ = item.occlusion_reach > 0 ? 1 - item.occlusion_strength * (1 - open_environment(surface_offset_, item.occlusion_reach)) : 1;
  size_ = cells.edge * Vec3(cells.size.x, cells.size.y, cells.size.z);
  return Done{};
}

}  // namespace catena::render
