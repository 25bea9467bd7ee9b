// SPDX-License-Identifier: MIT
#include "render/passes/hand_shadow.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "engine/base/result.h"
#include "render/passes/cursor_parts.h"

namespace catena::render {
namespace {

constexpr std::uint32_t kHandMaskVertexShader[] = {
#include "spirv/fullscreen.vert.inc"
};
constexpr std::uint32_t kHandMaskFragmentShader[] = {
#include "spirv/hand_mask.frag.inc"
};
constexpr std::uint32_t kHandTilesShader[] = {
#include "spirv/hand_tiles.vert.inc"
};

constexpr std::size_t kCastingLights = 3;  // as in shaders/lib/lighting.glsl
constexpr double kFaintest = 1.0 / 500;    // share of a light: shadows of less are not seen
constexpr double kSharpPixels = 0.5;       // least half width of a penumbra

std::vector<CursorPart> casting_parts(const FramePacket& packet) {
  std::vector<CursorPart> casting;
  for (const CursorItem& cursor : packet.cursors)
    std::ranges::copy_if(cursor_parts(cursor), std::back_inserter(casting), &CursorPart::casts);
  if (casting.size() > MAX_HAND_PARTS) casting.resize(MAX_HAND_PARTS);
  return casting;
}

std::uint32_t divide_up(std::uint32_t count, std::uint32_t by) { return (count + by - 1) / by; }

/// Returns the texels of an image of every `spacing`-th pixel that an area of pixels needs.
VkRect2D texels_of(const VkRect2D& area, std::uint32_t width, std::uint32_t height, std::uint32_t spacing) {
  const std::uint32_t x = std::uint32_t(area.offset.x) / spacing, y = std::uint32_t(area.offset.y) / spacing;
  const std::uint32_t last_x = std::min(width - 1, (std::uint32_t(area.offset.x) + area.extent.width) / spacing + 1);
  const std::uint32_t last_y = std::min(height - 1, (std::uint32_t(area.offset.y) + area.extent.height) / spacing + 1);
  return {{std::int32_t(x), std::int32_t(y)}, {last_x - x + 1, last_y - y + 1}};
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

vk::Spirv HandShadow::vertex_shader() { return kHandTilesShader; }

std::vector<vk::LayoutBinding> HandShadow::layout() {
  return {{6, vk::DescriptorKind::uniform},
          {7, vk::DescriptorKind::uniform},
          {8, vk::DescriptorKind::texture},
          {9, vk::DescriptorKind::texture},
          {vk::kSharedBinding, vk::DescriptorKind::sampled}};
}

std::vector<vk::Binding> HandShadow::bindings(Targets& targets) const {
  return {{6, vk::DescriptorKind::uniform, &frame_, nullptr, nullptr},
          {7, vk::DescriptorKind::uniform, &hand_, nullptr, nullptr},
          {8, vk::DescriptorKind::texture, nullptr, has_depths_ ? &depths_ : &targets.placeholder, nullptr},
          {9, vk::DescriptorKind::texture, nullptr, &mask_, nullptr}};
}

/// Finds the lights that cast, and the pixels in which their shadows may lie.
void HandShadow::find_area(const std::vector<CursorPart>& parts, const FramePacket& packet, const Camera& camera,
                           shared::HandShadowData& data) {
  const Bounds hand = bounds_of(parts);
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
  area_ = corners.empty() ? VkRect2D{} : covered_area(corners, camera);
}

Outcome HandShadow::update(Frame& frame, bool has_opaque, RaySampler* volumes) {
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
  find_area(parts, packet, camera, data);
  if (area_.extent.width == 0 || area_.extent.height == 0) return Done{};
  data.part_count = std::uint32_t(parts.size());
  for (std::size_t i = 0; i < parts.size(); ++i) {
    const CursorPart& part = parts[i];
    data.from[i] = in_view(part.from, part.radius);
    data.to[i] = in_view(part.to, part.kind == CursorPart::Kind::cone ? 0 : part.radius);
  }
  data.pixel = float(kSharpPixels * 2 * camera.half_height / camera.height);
  data.half_width = float(0.5 * camera.width);
  data.half_height = float(0.5 * camera.height);
  data.least_opaque = has_opaque ? -NO_DEPTH : NO_DEPTH;
  const std::uint32_t width = divide_up(packet.width, HAND_SPACING), height = divide_up(packet.height, HAND_SPACING);
  mask_area_ = texels_of(area_, width, height, HAND_SPACING);
  data.mask_x = std::uint32_t(mask_area_.offset.x);
  data.mask_y = std::uint32_t(mask_area_.offset.y);
  data.mask_last_x = data.mask_x + mask_area_.extent.width - 1;
  data.mask_last_y = data.mask_y + mask_area_.extent.height - 1;
  data.tiles_across = divide_up(mask_area_.extent.width, HAND_TILE);
  tile_count_ = data.tiles_across * divide_up(mask_area_.extent.height, HAND_TILE);
  CATENA_CHECK(vk::ensure_image(frame.device, mask_, VK_FORMAT_R8_UINT, width, height));
  has_depths_ = volumes && volumes->has_half_opacity_depth() && frame.layers.empty();
  data.depth_limit = has_depths_ ? NO_DEPTH : -NO_DEPTH;
  if (has_depths_) {
    const std::uint32_t across = divide_up(packet.width, DEPTH_SPACING), down = divide_up(packet.height, DEPTH_SPACING);
    const VkRect2D rays_area = texels_of(area_, across, down, DEPTH_SPACING);
    data.depth_x = std::uint32_t(rays_area.offset.x);
    data.depth_y = std::uint32_t(rays_area.offset.y);
    data.depth_last_x = data.depth_x + rays_area.extent.width - 1;
    data.depth_last_y = data.depth_y + rays_area.extent.height - 1;
    CATENA_CHECK(vk::ensure_image(frame.device, depths_, kVolumeFormat, across, down));
    CATENA_TRY(vk::Commands commands, vk::Commands::begin(frame.device));
    CATENA_CHECK(volumes->record_half_opacity_depth(commands, frame, DEPTH_SPACING, depths_, rays_area));
    commands.transition(depths_, vk::kFragmentRead);
    CATENA_CHECK(commands.finish());
  }
  CATENA_CHECK(vk::write_uniform(frame.device, frame_, rays.mesh_frame_data(camera.position)));
  return vk::write_uniform(frame.device, hand_, data);
}

Outcome HandShadow::record_mask(vk::Commands& commands, Frame& frame) {
  if (!mask_pipeline_) {
    vk::GraphicsInfo info;
    info.vertex = kHandMaskVertexShader;
    info.fragment = kHandMaskFragmentShader;
    info.layout_bindings = {{4, vk::DescriptorKind::texture},
                            {6, vk::DescriptorKind::uniform},
                            {7, vk::DescriptorKind::uniform},
                            {8, vk::DescriptorKind::texture}};
    info.colors = {VK_FORMAT_R8_UINT};
    CATENA_TRY(mask_pipeline_, vk::Pipeline::create(frame.device, info));
  }
  const vk::Image& opaque = frame.has(target::opaque_depth) ? frame.targets.opaque_depth : frame.targets.placeholder;
  const vk::ColorTarget target{&mask_, std::array<float, 4>{0, 0, 0, 0}};
  commands.begin_pass({&target, 1}, {});
  commands.set_scissor(mask_area_);
  const std::vector<vk::Binding> all = bindings(frame.targets);
  const vk::Binding used[] = {{4, vk::DescriptorKind::texture, nullptr, &opaque, nullptr}, all[0], all[1], all[2]};
  commands.bind(mask_pipeline_, used);
  commands.draw_triangle();
  commands.end_pass();
  commands.transition(mask_, vk::kShaderRead);
  return Done{};
}

}  // namespace catena::render
