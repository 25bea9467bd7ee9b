// SPDX-License-Identifier: MIT
#include "render/passes/ui.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstring>

#include "render/vk/commands.h"
#include "shaders/shared/ui.h"

namespace catena::render {
namespace {

constexpr std::uint32_t kUiVertexShader[] = {
#include "spirv/ui.vert.inc"
};
constexpr std::uint32_t kUiFragmentShader[] = {
#include "spirv/ui.frag.inc"
};
constexpr VkFormat kWindowFormat = VK_FORMAT_R8G8B8A8_UNORM;

/// Returns the first pixel whose center lies at or beyond `edge`, at most `count`; 0 for NaN.
std::uint32_t first_beyond(float edge, std::uint32_t count) {
  const double first = std::ceil(double(edge) - 0.5);
  return first > 0 ? std::uint32_t(std::min(first, double(count))) : 0;
}

VkRect2D clip_of(const UiDraw& draw, const VkExtent3D& window) {
  const std::uint32_t x0 = first_beyond(draw.clip[0], window.width), x1 = first_beyond(draw.clip[2], window.width);
  const std::uint32_t y0 = first_beyond(draw.clip[1], window.height), y1 = first_beyond(draw.clip[3], window.height);
  return {{std::int32_t(x0), std::int32_t(y0)}, {x1 > x0 ? x1 - x0 : 0, y1 > y0 ? y1 - y0 : 0}};
}

/// Scales the whole image to `area` of the window.
void blit_image(vk::Commands& commands, const vk::Image& rendered, const vk::Image& window, const std::array<std::uint32_t, 4>& area) {
  const auto side = [](std::uint32_t v) { return std::int32_t(v); };
  VkImageBlit region{};
  region.srcSubresource = region.dstSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1};
  region.srcOffsets[1] = {side(rendered.info().extent.width), side(rendered.info().extent.height), 1};
  region.dstOffsets[0] = {side(area[0]), side(area[1]), 0};
  region.dstOffsets[1] = {side(area[2]), side(area[3]), 1};
  vkCmdBlitImage(commands.handle(), rendered.handle(), VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, window.handle(),
                 VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, 1, &region, VK_FILTER_LINEAR);
}

bool indices_lead_inside(const UiItems& items) {
  return std::ranges::all_of(items.draws, [&](const UiDraw& draw) {
    if (draw.first_index > items.indices.size() || draw.index_count > items.indices.size() - draw.first_index) return false;
    const auto first = items.indices.begin() + std::ptrdiff_t(draw.first_index);
    return std::all_of(first, first + std::ptrdiff_t(draw.index_count),
                       [&](std::uint16_t index) { return std::size_t(draw.first_vertex) + index < items.vertices.size(); });
  });
}

}  // namespace

/// Creates the window's image of this size and the resources that do not depend on the items.
Outcome WindowPainter::ensure_window(std::uint32_t width, std::uint32_t height) {
  const std::uint32_t max_size = device_->info().limits.maxImageDimension2D;
  if (width == 0 || height == 0 || width > max_size || height > max_size)
    return Error{fmt::format("a window of {} x {} pixels cannot be rendered, expected 1 to {} in each direction", width, height, max_size)};
  const VkExtent3D& have = window_.info().extent;
  if (!window_ || have.width != width || have.height != height) {
    vk::ImageInfo info;
    info.format = kWindowFormat;
    info.extent = {width, height, 1};
    info.usage = VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT;
    window_ = vk::Image();  // frees the old image first
    CATENA_TRY(window_, vk::Image::create(*device_, info));
  }
  return vk::write_uniform(*device_, uniform_, shared::UiData{{0.5f * float(width), 0.5f * float(height)}});
}

Outcome WindowPainter::retain_texture(const std::shared_ptr<const UiTexture>& texture) {
  Texture& reused = textures_[texture];
  reused.last_used = paint_count_;
  if (reused.image) return Done{};
  CATENA_ASSERT(texture->width > 0 && texture->height > 0 && texture->rgba.size() == std::size_t(4) * texture->width * texture->height);
  vk::ImageInfo info;
  info.format = VK_FORMAT_R8G8B8A8_UNORM;
  info.extent = {texture->width, texture->height, 1};
  info.usage = VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT;
  CATENA_TRY(reused.image, vk::Image::create(*device_, info));
  return vk::upload_planes(*device_, reused.image, 1, [&](std::uint32_t, std::uint32_t, std::byte* out) {
    std::memcpy(out, texture->rgba.data(), texture->rgba.size());
  });
}

Outcome WindowPainter::upload(const UiItems& items) {
  CATENA_ASSERT(indices_lead_inside(items));
  if (!pipeline_) {
    vk::GraphicsInfo info;
    info.vertex = kUiVertexShader;
    info.fragment = kUiFragmentShader;
    info.layout_bindings = {{0, vk::DescriptorKind::uniform}, {1, vk::DescriptorKind::sampled}};
    info.colors = {kWindowFormat};
    info.blends = {vk::Blend::over_straight};
    info.vertex_stride = sizeof(UiVertex);
    info.attributes = {{0, VK_FORMAT_R32G32_SFLOAT, offsetof(UiVertex, x)},
                       {1, VK_FORMAT_R32G32_SFLOAT, offsetof(UiVertex, u)},
                       {2, VK_FORMAT_R8G8B8A8_UNORM, offsetof(UiVertex, rgba)}};
    CATENA_TRY(pipeline_, vk::Pipeline::create(*device_, info));
    CATENA_TRY(linear_, vk::Sampler::create(*device_, vk::Filter::linear));
    white_ = std::make_shared<const UiTexture>(UiTexture{1, 1, {255, 255, 255, 255}});
  }
  CATENA_CHECK(vk::write_items(*device_, vertices_, items.vertices, VK_BUFFER_USAGE_VERTEX_BUFFER_BIT));
  CATENA_CHECK(vk::write_items(*device_, indices_, items.indices, VK_BUFFER_USAGE_INDEX_BUFFER_BIT));
  for (const UiDraw& draw : items.draws) CATENA_CHECK(retain_texture(draw.texture ? draw.texture : white_));
  std::erase_if(textures_, [&](const auto& entry) { return entry.second.last_used + kTextureIdlePaints < paint_count_; });
  return Done{};
}

void WindowPainter::record(vk::Commands& commands, const UiItems& items) {
  const vk::ColorTarget into{&window_, std::nullopt};
  commands.begin_pass({&into, 1}, {});
  const Texture* bound = nullptr;
  for (const UiDraw& draw : items.draws) {
    const VkRect2D clip = clip_of(draw, window_.info().extent);
    if (draw.index_count == 0 || clip.extent.width == 0 || clip.extent.height == 0) continue;
    const Texture& texture = textures_.at(draw.texture ? draw.texture : white_);
    if (bound == nullptr) commands.bind_mesh(vertices_, indices_, VK_INDEX_TYPE_UINT16);
    if (bound != &texture) {
      const vk::Binding bindings[] = {{0, vk::DescriptorKind::uniform, &uniform_, nullptr, nullptr},
                                      {1, vk::DescriptorKind::sampled, nullptr, &texture.image, &linear_}};
      commands.bind(pipeline_, bindings);
      bound = &texture;
    }
    commands.set_scissor(clip);
    commands.draw_mesh(draw.first_index, draw.index_count, draw.first_vertex);
  }
  commands.end_pass();
}

Outcome WindowPainter::paint(vk::Image& rendered, std::uint32_t width, std::uint32_t height, const UiItems& items) {
  ++paint_count_;
  CATENA_CHECK(ensure_window(width, height));
  CATENA_CHECK(upload(items));
  CATENA_TRY(vk::Commands commands, vk::Commands::begin(*device_));
  commands.transition(rendered, vk::kTransferRead);
  // the window may have shrunk since its image area was computed
  const std::array<std::uint32_t, 4> whole{0, 0, width, height};
  std::array<std::uint32_t, 4> area = items.image_area.value_or(whole);
  area = {area[0], area[1], std::min(area[2], width), std::min(area[3], height)};
  if (area[0] >= area[2] || area[1] >= area[3]) area = whole;
  if (area != whole) {
    const vk::ColorTarget cleared{&window_, std::array<float, 4>{0, 0, 0, 1}};
    commands.begin_pass({&cleared, 1}, {});
    commands.end_pass();
  }
  commands.transition(window_, vk::kTransferWrite);
  blit_image(commands, rendered, window_, area);
  record(commands, items);
  commands.transition(window_, vk::kTransferRead);
  return commands.finish();
}

}  // namespace catena::render
