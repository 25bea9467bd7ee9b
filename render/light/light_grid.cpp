// SPDX-License-Identifier: MIT
#include "render/light/light_grid.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <utility>

#include "engine/base/threads.h"
#include "render/light/light_sweep.h"
#include "render/vk/commands.h"

namespace catena::render {
namespace {

constexpr VkFormat kFormat = VK_FORMAT_R8G8B8A8_UNORM;
constexpr std::size_t kTexelBytes = 4;

constexpr double kOffsetCells = 1;  // of the lookup at a surface, whose cells do not count

std::uint8_t to_byte(float share) { return std::uint8_t(std::lround(255 * std::clamp(share, 0.0f, 1.0f))); }
/// From -1 to 1; 0 is exact.
std::uint8_t signed_to_byte(float value) { return std::uint8_t(128 + std::lround(127 * std::clamp(value, -1.0f, 1.0f))); }

}  // namespace

bool LightGrid::Casters::operator==(const Casters& other) const {
  return bounds.lo == other.bounds.lo && bounds.hi == other.bounds.hi && clip_planes == other.clip_planes && volumes == other.volumes &&
         isosurfaces == other.isosurfaces && meshes == other.meshes && tubes == other.tubes && arrows == other.arrows &&
         glyphs == other.glyphs && spheres == other.spheres;
}

/// Computes the texels that differ from the last ones. Returns whether any may.
bool LightGrid::cast(const FramePacket& packet) {
  const IlluminationItem& next = packet.illumination;
  const std::size_t count = cells_.count();
  const auto open = [&](std::size_t k) { return cells_.open.empty() ? 1.0f : std::max(cells_.open[k], 1.0f / 255); };
  const bool is_new = texels_.size() != 2 * count;
  if (is_new) {
    texels_.resize(2 * count);
    for (std::size_t k = 0; k < count; ++k) texels_[count + k] = {128, 128, 128, to_byte(open(k))};
  }
  bool is_changed = is_new;
  const auto set = [&](std::size_t channel, const auto& share_of_cell) {
    is_changed = true;
    parallel_for(count, std::size_t{1} << 16, [&](std::size_t begin, std::size_t end) {
      for (std::size_t k = begin; k < end; ++k) texels_[k][channel] = to_byte(open(k) * share_of_cell(k));
    });
  };
  // lights that are not cast arrive everywhere
  const auto cast_of = [](const IlluminationItem& item, const std::vector<LightItem>& lights, std::size_t i) {
    const bool is_cast = item.shadows && i < lights.size() && !lights[i].camera_relative;
    return is_cast ? std::pair(lights[i].direction, lights[i].angular_size_deg) : std::pair(Vec3(0.0), 0.0);
  };
  for (std::size_t i = 0; i < kMaxShadows; ++i) {
    const auto own = cast_of(next, packet.lights, i);
    if (!is_new && own == cast_of(illumination_, lights_, i)) continue;
    if (own.first == Vec3(0.0)) {
      set(i, [](std::size_t) { return 1.0f; });
      continue;
    }
    const std::vector<float> share = sweep_light(cells_, direction(own.first), own.second);
    set(i, [&](std::size_t k) { return share[k]; });
  }
  if (is_new || next.occlusion_reach != illumination_.occlusion_reach || next.occlusion_strength != illumination_.occlusion_strength) {
    const auto strength = float(next.occlusion_reach > 0 ? next.occlusion_strength : 0);
    std::array<std::vector<float>, 4> share;
    if (strength > 0) share = sweep_environment(cells_, next.occlusion_reach);
    set(3, [&](std::size_t k) { return strength > 0 ? 1 - strength * (1 - share[0][k]) : 1.0f; });
    for (std::size_t k = 0; k < count; ++k)
      for (std::size_t a = 0; a < 3; ++a)
        texels_[count + k][a] = signed_to_byte(strength > 0 ? strength * open(k) * share[a + 1][k] : 0.0f);
  }
  illumination_ = next;
  lights_ = packet.lights;
  return is_changed;
}

Outcome LightGrid::update(vk::Device& device, const FramePacket& packet, bool is_only_view) {
  is_on_ = false;
  if (!open_) {
    CATENA_TRY(linear_, vk::Sampler::create(device, vk::Filter::linear));
    CATENA_TRY(open_, vk::Image::create(device, vk::volume_image_info(kFormat, 1, 1, 1)));
    CATENA_CHECK(
        vk::upload_planes(device, open_, 1, [](std::uint32_t, std::uint32_t, std::byte* out) { std::memset(out, 255, kTexelBytes); }));
  }
  device.share(open_, linear_);
  const IlluminationItem& item = packet.illumination;
  if (!item.is_cast()) {
    if (is_only_view) casters_.reset(), cells_ = {}, texels_ = {}, image_ = {};
    return Done{};
  }
  Casters casters{item.bounds,  packet.clip_planes, packet.volumes, packet.isosurfaces, packet.meshes,
                  packet.tubes, packet.arrows,      packet.glyphs,  packet.spheres};
  const bool is_same = casters_ && *casters_ == casters;
  if (!is_same) {
    casters_.reset();
    texels_.clear();
    cells_ = make_light_cells(packet);
    if (!(cells_.edge > 0)) return Done{};
  }
  if (!is_same || !(item == illumination_) || packet.lights != lights_) {
    if (cast(packet)) CATENA_CHECK(upload(device));
    casters_ = std::move(casters);
  }
  device.share(image_, linear_);
  is_on_ = true;
  return Done{};
}

Outcome LightGrid::upload(vk::Device& device) {
  const std::size_t nx = std::size_t(cells_.size.x), ny = std::size_t(cells_.size.y), nz = std::size_t(cells_.size.z);
  CATENA_TRY(image_, vk::Image::create(device, vk::volume_image_info(kFormat, nx, ny, 2 * nz)));
  CATENA_CHECK(vk::upload_planes(device, image_, 1, [&](std::uint32_t first, std::uint32_t count, std::byte* out) {
    std::memcpy(out, texels_.data() + std::size_t(first) * nx * ny, std::size_t(count) * nx * ny * kTexelBytes);
  }));
  place_.lo = cells_.lo;
  place_.size = cells_.edge * Vec3(cells_.size.x, cells_.size.y, cells_.size.z);
  place_.cell = cells_.edge;
  place_.planes = cells_.size.z;
  place_.surface_offset = kOffsetCells * cells_.edge;
  ++place_.version;
  return Done{};
}

}  // namespace catena::render
