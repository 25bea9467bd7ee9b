// SPDX-License-Identifier: MIT
#include <Imath/half.h>
#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>

#include "render/frame/linear_color.h"
#include "render/passes/renderer_impl.h"

namespace catena::render {
namespace {

/// Returns `count` elements of an image, copied through a buffer.
template <class T>
Result<std::vector<T>> bytes_of(vk::Device& device, vk::Image& image, std::size_t count) {
  const std::size_t bytes = count * sizeof(T);
  CATENA_TRY(const vk::Buffer buffer, vk::Buffer::create(device, bytes, VK_BUFFER_USAGE_TRANSFER_DST_BIT, vk::Memory::readback));
  CATENA_TRY(vk::Commands commands, vk::Commands::begin(device));
  commands.copy(image, buffer);
  CATENA_CHECK(commands.finish());
  std::vector<T> values(count);
  std::memcpy(values.data(), buffer.bytes().data(), bytes);
  return values;
}

/// Copies one texel of 4 bytes.
void copy_texel(vk::Commands& commands, vk::Image& from, std::uint32_t x, std::uint32_t y, const vk::Buffer& to, VkDeviceSize offset) {
  commands.transition(from, vk::kTransferRead);
  VkBufferImageCopy region{};
  region.bufferOffset = offset;
  region.imageSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1};
  region.imageOffset = {std::int32_t(x), std::int32_t(y), 0};
  region.imageExtent = {1, 1, 1};
  vkCmdCopyImageToBuffer(commands.handle(), from.handle(), VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, to.handle(), 1, &region);
}

}  // namespace

Result<Image8> Renderer::read_back() {
  Impl& p = *impl_;
  CATENA_ASSERT(p.drawn_targets != 0 && p.targets.output.info().format == kOutputFormat);
  Image8 result;
  result.width = p.output_image().info().extent.width;
  result.height = p.output_image().info().extent.height;
  CATENA_TRY(result.rgba,
             p.reset_on_error(bytes_of<std::uint8_t>(*p.device, p.output_image(), std::size_t(4) * result.width * result.height)));
  return result;
}

Result<ImageF32> Renderer::read_back_float() {
  Impl& p = *impl_;
  CATENA_ASSERT(p.drawn_targets != 0 && p.targets.output.info().format == kFloatOutputFormat);
  ImageF32 result;
  result.width = p.targets.output.info().extent.width;
  result.height = p.targets.output.info().extent.height;
  CATENA_TRY(result.rgba, p.reset_on_error(bytes_of<float>(*p.device, p.targets.output, std::size_t(4) * result.width * result.height)));
  return result;
}

Result<DepthImage> Renderer::read_depth() {
  Impl& p = *impl_;
  CATENA_ASSERT(p.drawn_targets != 0);
  DepthImage result;
  result.width = p.view_width;
  result.height = p.view_height;
  result.depth.assign(std::size_t(result.width) * result.height, std::numeric_limits<float>::infinity());
  if ((p.drawn_targets & target::opaque_depth) == 0) return result;
  CATENA_TRY(const std::vector<float> relative, p.reset_on_error(bytes_of<float>(*p.device, p.targets.opaque_depth, result.depth.size())));
  for (std::size_t i = 0; i < relative.size(); ++i)
    if (relative[i] < NO_DEPTH) result.depth[i] = float(double(relative[i]) + p.reference_depth);
  return result;
}

Result<IdImage> Renderer::read_ids() {
  Impl& p = *impl_;
  CATENA_ASSERT(p.drawn_targets != 0);
  IdImage result;
  result.width = p.view_width;
  result.height = p.view_height;
  result.ids.assign(std::size_t(result.width) * result.height, 0);
  if ((p.drawn_targets & target::opaque_id) == 0) return result;
  CATENA_TRY(result.ids, p.reset_on_error(bytes_of<std::uint32_t>(*p.device, p.targets.opaque_id, result.ids.size())));
  return result;
}

/// Counts the texels of an R8_UINT image that are 1.
Result<std::uint64_t> Renderer::Impl::count_marks(vk::Image& marks) {
  const VkExtent3D& size = marks.info().extent;
  CATENA_TRY(const auto bytes, reset_on_error(bytes_of<std::uint8_t>(*device, marks, std::size_t(size.width) * size.height)));
  return std::uint64_t(std::ranges::count(bytes, std::uint8_t(1)));
}

Result<MarchedTiles> Renderer::marched_tiles() {
  Impl& p = *impl_;
  constexpr std::uint32_t kTile = 16;
  MarchedTiles tiles;
  tiles.total = tiles.marched = (p.view_width + kTile - 1) / kTile * ((p.view_height + kTile - 1) / kTile);
  for (Pass* pass : p.active_passes()) {
    RaySampler* rays = pass->ray_sampler();
    if (!rays || !rays->reused_previous()) continue;
    tiles.marched = 0;
    if (vk::Image* changed = rays->dirty_tiles()) {
      CATENA_TRY(const std::uint64_t marked, p.count_marks(*changed));
      tiles.marched = std::uint32_t(marked);
    }
  }
  return tiles;
}

Result<std::array<std::uint64_t, 2>> Renderer::refined_ray_counts() {
  Impl& p = *impl_;
  std::array<std::uint64_t, 2> rays{};
  for (Pass* pass : p.active_passes()) {
    if (!pass->ray_sampler()) continue;
    const std::array<vk::Image*, 2> blocks = pass->ray_sampler()->marked_blocks();
    for (std::size_t k = 0; k < blocks.size(); ++k) {
      if (blocks[k] == nullptr) continue;
      CATENA_TRY(const std::uint64_t marked, p.count_marks(*blocks[k]));
      rays[k] += 16 * marked;
    }
  }
  return rays;
}

Result<PickResult> Renderer::pick(std::uint32_t x, std::uint32_t y) {
  Impl& p = *impl_;
  CATENA_ASSERT(p.drawn_targets != 0 && x < p.view_width && y < p.view_height);
  PickResult picked{0, std::numeric_limits<double>::infinity()};
  constexpr TargetSet kBoth = target::opaque_depth | target::opaque_id;
  if ((p.drawn_targets & kBoth) != kBoth) return picked;
  const auto read = [&]() -> Outcome {
    CATENA_TRY(const vk::Buffer buffer, vk::Buffer::create(*p.device, 8, VK_BUFFER_USAGE_TRANSFER_DST_BIT, vk::Memory::readback));
    CATENA_TRY(vk::Commands commands, vk::Commands::begin(*p.device));
    copy_texel(commands, p.targets.opaque_depth, x, y, buffer, 0);
    copy_texel(commands, p.targets.opaque_id, x, y, buffer, 4);
    commands.barrier(buffer, vk::kTransferWrite, vk::kHostRead);
    CATENA_CHECK(commands.finish());
    float relative = 0;
    std::memcpy(&relative, buffer.bytes().data(), 4);
    std::memcpy(&picked.id, buffer.bytes().data() + 4, 4);
    if (relative < NO_DEPTH) picked.depth = double(relative) + p.reference_depth;
    return Done{};
  };
  CATENA_CHECK(p.reset_on_error(read()));
  return picked;
}

Result<Image8> Renderer::read_back_window() {
  Impl& p = *impl_;
  CATENA_ASSERT(p.window_painter && p.window_painter->window());
  vk::Image& window = p.window_painter->window();
  Image8 result;
  result.width = window.info().extent.width;
  result.height = window.info().extent.height;
  CATENA_TRY(result.rgba, p.reset_on_error(bytes_of<std::uint8_t>(*p.device, window, std::size_t(4) * result.width * result.height)));
  for (std::size_t i = 3; i < result.rgba.size(); i += 4) result.rgba[i] = 255;
  return result;
}

Result<Image8> Renderer::sample_rays_once(const FramePacket& packet, const RenderSettings& settings, std::uint32_t spacing) {
  Impl& p = *impl_;
  Frame frame{*p.device, *p.residency, p.targets, packet, settings, {}};
  CATENA_CHECK(p.prepare(frame));

  // the passes before the raycast are drawn at full resolution, the rays into a separate image
  Image8 result;
  result.width = (packet.width + spacing - 1) / spacing;
  result.height = (packet.height + spacing - 1) / spacing;
  const std::size_t count = std::size_t(result.width) * result.height;
  vk::Image target;
  std::vector<Pass*> before;
  RaySampler* rays = nullptr;
  for (Pass* pass : p.active_passes()) {
    if ((rays = pass->ray_sampler())) break;
    if ((pass->use(frame).writes & target::output) == 0) before.push_back(pass);
  }
  CATENA_TRY(vk::Commands commands, vk::Commands::begin(*p.device));
  CATENA_CHECK(p.record(commands, frame, before));
  if (rays) {
    vk::ImageInfo info;
    info.format = kVolumeFormat;
    info.extent = {result.width, result.height, 1};
    info.usage = VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT;
    CATENA_TRY(target, vk::Image::create(*p.device, info));
    if (frame.has(target::opaque_depth)) commands.transition(p.targets.opaque_depth, vk::kFragmentRead);
    CATENA_CHECK(rays->record_ray_samples(commands, frame, spacing, target));
  }
  CATENA_CHECK(commands.finish());
  std::vector<float> volume(4 * count);
  std::vector<std::uint16_t> opaque;
  if (rays) {
    CATENA_TRY(volume, bytes_of<float>(*p.device, target, volume.size()));
  }
  if (frame.has(target::opaque_color)) {
    CATENA_TRY(opaque, bytes_of<std::uint16_t>(*p.device, p.targets.opaque_color, 4 * std::size_t(packet.width) * packet.height));
  }

  // volume over opaque over background
  result.rgba.assign(4 * count, 0);
  const auto to_byte = [](float x) { return std::uint8_t(std::lround(255 * std::clamp(x, 0.0f, 1.0f))); };
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t pixel = spacing * (i / result.width * packet.width + i % result.width);
    const float behind = opaque.empty() ? 1 : 1 - imath_half_to_float(opaque[4 * pixel + 3]), through = 1 - volume[4 * i + 3];
    // linear radiance is composited with the background after the conversion, as an image with straight alpha is
    const bool is_linear = packet.illumination.is_linear;
    const float alpha = 1 - through * behind;
    for (std::size_t c = 0; c < 3; ++c) {
      const float sum = (is_linear ? 0 : behind * packet.background[c]) + (opaque.empty() ? 0 : imath_half_to_float(opaque[4 * pixel + c]));
      float value = volume[4 * i + c] + through * sum;
      if (is_linear && alpha > 0) value = alpha * float(to_display(double(value / alpha))) + (1 - alpha) * packet.background[c];
      result.rgba[4 * i + c] = to_byte(value);
    }
    result.rgba[4 * i + 3] = to_byte(alpha);
  }
  return result;
}

}  // namespace catena::render
