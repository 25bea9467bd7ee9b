// SPDX-License-Identifier: MIT
#include "render/passes/hand_shadow.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "engine/base/result.h"
#include "render/passes/cursor_parts.h"

namespace catena::render {
namespace {

constexpr std::size_t kCastingLights = 3;  // as in shaders/lib/lighting.glsl
constexpr std::uint32_t kSpacing = 4;      // pixels between the rays that find the depths of volumes
constexpr double kFaintest = 1.0 / 500;    // share of a light: shadows of less are not seen
constexpr double kSharpPixels = 0.5;       // least half width of a penumbra

std::vector<CursorPart> casting_parts(const FramePacket& packet) {
  std::vector<CursorPart> casting;
  for (const CursorItem& cursor : packet.cursors)
    std::ranges::copy_if(cursor_parts(cursor), std::back_inserter(casting), &CursorPart::casts);
  if (casting.size() > MAX_HAND_PARTS) casting.resize(MAX_HAND_PARTS);
  return casting;
}

Bounds bounds_of(const std::vector<CursorPart>& parts) {
  Bounds bounds;
  for (const CursorPart& part : parts) {
    bounds.extend(part.from, part.radius);
    bounds.extend(part.to, part.radius);
  }
  return bounds;
}

/// Adds the corners of the region in which the shadow of a sphere may lie: from the sphere along the light, up to `reach`.
void add_region(const Vec3& center, double radius, const Vec3& to_light, double tangent, double reach, std::vector<Vec3>& corners) {
  const double length = tangent > 0 ? std::min(reach, radius / (tangent * std::sqrt(kFaintest))) : reach;
  for (const double place : {0.0, std::max(0.0, length)}) {
    Bounds box;
    box.extend(center - place * to_light, radius + place * tangent);
    for (int i = 0; i < 8; ++i) corners.push_back(box.corner(i));
  }
}

}  // namespace

std::vector<vk::LayoutBinding> HandShadow::layout() {
  return {{6, vk::DescriptorKind::uniform},
          {7, vk::DescriptorKind::uniform},
          {8, vk::DescriptorKind::texture},
          {vk::kSharedBinding, vk::DescriptorKind::sampled}};
}

std::vector<vk::Binding> HandShadow::bindings(Targets& targets) const {
  return {{6, vk::DescriptorKind::uniform, &frame_, nullptr, nullptr},
          {7, vk::DescriptorKind::uniform, &hand_, nullptr, nullptr},
          {8, vk::DescriptorKind::texture, nullptr, has_depths_ ? &depths_ : &targets.placeholder, nullptr}};
}

Outcome HandShadow::update(Frame& frame, RaySampler* volumes) {
  area_ = {};
  has_depths_ = false;
  const FramePacket& packet = frame.packet;
  if (packet.cursors.empty() || !packet.illumination.shadows || packet.illumination.bounds.empty()) return Done{};
  const std::vector<CursorPart> parts = casting_parts(packet);
  if (parts.empty()) return Done{};
  const CameraRays& rays = frame.rays;
  const Camera& camera = rays.camera;
  const auto in_view = [&](const Vec3& p, double radius) {
    const Vec3 d = p - camera.position;
    return glm::vec4(dot(d, camera.right), dot(d, camera.up), dot(d, rays.forward), radius);
  };
  shared::HandShadowData data{};
  data.part_count = std::uint32_t(parts.size());
  for (std::size_t i = 0; i < parts.size(); ++i) {
    const CursorPart& part = parts[i];
    data.from[i] = in_view(part.from, part.radius);
    data.to[i] = in_view(part.to, part.kind == CursorPart::Kind::cone ? 0 : part.radius);
  }
  const Bounds hand = bounds_of(parts);
  data.whole = in_view(hand.center(), 0.5 * hand.diagonal());
  data.pixel = float(kSharpPixels * 2 * camera.half_height / camera.height);
  data.volume_spacing = kSpacing;
  data.depth_limit = -NO_DEPTH;

  std::vector<Vec3> corners;
  for (std::size_t i = 0; i < kCastingLights; ++i) {
    data.light_tangents[int(i)] = -1;
    if (i >= packet.lights.size() || packet.lights[i].camera_relative) continue;
    const double tangent = std::tan(0.5 * packet.lights[i].angular_size_deg * std::numbers::pi / 180);
    const Vec3 to_light = direction(packet.lights[i].direction);
    if (max_abs(to_light) == 0) continue;
    data.light_tangents[int(i)] = float(tangent);
    double reach = 0;
    for (int k = 0; k < 8; ++k) reach = std::max(reach, dot(hand.center() - packet.illumination.bounds.corner(k), to_light));
    for (const CursorPart& part : parts)
      for (const Vec3& end : {part.from, part.to}) add_region(end, part.radius, to_light, tangent, reach + hand.diagonal(), corners);
  }
  if (corners.empty()) return Done{};
  area_ = covered_area(corners, camera);
  if (area_.extent.width == 0 || area_.extent.height == 0) return Done{};
  if (volumes && volumes->has_half_opacity_depth() && frame.layers.empty()) CATENA_CHECK(draw_depths(frame, *volumes, data));
  CATENA_CHECK(vk::write_uniform(frame.device, frame_, rays.mesh_frame_data(camera.position)));
  return vk::write_uniform(frame.device, hand_, data);
}

Outcome HandShadow::draw_depths(Frame& frame, RaySampler& volumes, shared::HandShadowData& data) {
  const auto texels = [](std::uint32_t pixels) { return (pixels + kSpacing - 1) / kSpacing; };
  CATENA_CHECK(vk::ensure_image(frame.device, depths_, kVolumeFormat, texels(frame.packet.width), texels(frame.packet.height)));
  const VkExtent3D& size = depths_.info().extent;
  data.first_x = std::uint32_t(area_.offset.x) / kSpacing;
  data.first_y = std::uint32_t(area_.offset.y) / kSpacing;
  data.last_x = std::min(size.width - 1, (std::uint32_t(area_.offset.x) + area_.extent.width) / kSpacing + 1);
  data.last_y = std::min(size.height - 1, (std::uint32_t(area_.offset.y) + area_.extent.height) / kSpacing + 1);
  data.depth_limit = NO_DEPTH;
  const VkRect2D area{{std::int32_t(data.first_x), std::int32_t(data.first_y)},
                      {data.last_x - data.first_x + 1, data.last_y - data.first_y + 1}};
  CATENA_TRY(vk::Commands commands, vk::Commands::begin(frame.device));
  CATENA_CHECK(volumes.record_half_opacity_depth(commands, frame, kSpacing, depths_, area));
  commands.transition(depths_, vk::kFragmentRead);
  has_depths_ = true;
  return commands.finish();
}

}  // namespace catena::render
