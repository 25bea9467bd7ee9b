// SPDX-License-Identifier: MIT
#include "render/passes/pass.h"

#include <algorithm>

#include "engine/base/result.h"
#include "engine/base/text.h"
#include "engine/field/field_display_range.h"
#include "shaders/shared/frame.h"

namespace catena::render {
namespace {

#include "spirv/table.inc"

}  // namespace

std::span<const EmbeddedShader> embedded_shaders() { return kEmbedded; }

namespace {

bool fits(const vk::Image& image, VkFormat format, std::uint32_t width, std::uint32_t height) {
  const VkExtent3D& have = image.info().extent;
  return image && image.info().format == format && have.width == width && have.height == height;
}

}  // namespace

std::vector<VkFormat> opaque_formats() { return {kOpaqueFormat, kDepthValueFormat, kIdFormat}; }

Result<vk::Image> create_placeholder_id(vk::Device& device) {
  vk::ImageInfo info;
  info.usage = VK_IMAGE_USAGE_SAMPLED_BIT;
  info.format = kIdFormat;
  CATENA_TRY(vk::Image image, vk::Image::create(device, info));
  CATENA_TRY(vk::Commands commands, vk::Commands::begin(device));
  commands.transition(image, vk::kFragmentRead);
  CATENA_CHECK(commands.finish());
  return image;
}

Outcome Targets::ensure(vk::Device& device, std::uint32_t width, std::uint32_t height, TargetSet needed) {
  constexpr VkImageUsageFlags color = VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT | VK_IMAGE_USAGE_SAMPLED_BIT;
  constexpr VkImageUsageFlags read = VK_IMAGE_USAGE_TRANSFER_SRC_BIT;
  const auto want = [&](TargetSet one, VkFormat format, VkImageUsageFlags usage) -> Outcome {
    return (needed & one) != 0 ? vk::ensure_image(device, image(one), format, width, height, usage) : Done{};
  };
  CATENA_CHECK(want(target::output, output_format, color | VK_IMAGE_USAGE_STORAGE_BIT | read));
  CATENA_CHECK(want(target::opaque_color, kOpaqueFormat, color | read));
  CATENA_CHECK(want(target::opaque_depth, kDepthValueFormat, color | read));
  CATENA_CHECK(want(target::opaque_id, kIdFormat, color | read));
  CATENA_CHECK(want(target::depth_buffer, kDepthBufferFormat, VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT));
  CATENA_CHECK(want(target::volume, kVolumeFormat, color | VK_IMAGE_USAGE_STORAGE_BIT | read));
  CATENA_CHECK(want(target::occluded_overlay, kOccludedOverlayFormat, color));
  if (!placeholder) {
    CATENA_CHECK(vk::ensure_image(device, placeholder, kOutputFormat, 1, 1, VK_IMAGE_USAGE_SAMPLED_BIT));
    CATENA_TRY(vk::Commands commands, vk::Commands::begin(device));
    commands.transition(placeholder, vk::kFragmentRead);
    CATENA_CHECK(commands.finish());
  }
  return Done{};
}

std::uint64_t Targets::missing_bytes(std::uint32_t width, std::uint32_t height, TargetSet needed) const {
  std::uint64_t a_pixel = 0;
  const auto add = [&](TargetSet one, const vk::Image& image, VkFormat format) {
    if ((needed & one) != 0 && !fits(image, format, width, height)) a_pixel += vk::texel_bytes(format);
  };
  add(target::output, output, output_format);
  add(target::opaque_color, opaque_color, kOpaqueFormat);
  add(target::opaque_depth, opaque_depth, kDepthValueFormat);
  add(target::opaque_id, opaque_id, kIdFormat);
  add(target::depth_buffer, depth_buffer, kDepthBufferFormat);
  add(target::volume, volume, kVolumeFormat);
  add(target::occluded_overlay, occluded_overlay, kOccludedOverlayFormat);
  return a_pixel * width * height;
}

vk::Image& Targets::image(TargetSet one) {
  switch (one) {
    case target::opaque_color:
      return opaque_color;
    case target::opaque_depth:
      return opaque_depth;
    case target::opaque_id:
      return opaque_id;
    case target::depth_buffer:
      return depth_buffer;
    case target::volume:
      return volume;
    case target::occluded_overlay:
      return occluded_overlay;
    default:
      CATENA_ASSERT(one == target::output);
      return output;
  }
}

void Targets::begin(vk::Commands& commands, TargetSet writes, TargetSet cleared, const std::optional<VkRect2D>& area) {
  std::vector<vk::ColorTarget> colors;
  for (const TargetSet one :
       {target::opaque_color, target::opaque_depth, target::opaque_id, target::volume, target::output, target::occluded_overlay}) {
    if ((writes & one) == 0) continue;
    const std::array<float, 4> empty{one == target::opaque_depth ? NO_DEPTH : 0.0f, 0, 0, 0};
    colors.push_back({&image(one), (cleared & one) != 0 ? std::optional(empty) : std::nullopt});
  }
  vk::DepthTarget depth;
  if ((writes & target::depth_buffer) != 0)
    depth = {&depth_buffer, (cleared & target::depth_buffer) != 0 ? std::optional(0.0f) : std::nullopt};
  commands.begin_pass(colors, depth, area);
}

ResidencyOptions residency_options(const FramePacket& packet, const RenderSettings& settings, const field::ScalarGrid& grid) {
  const auto uses = [&](const auto& item) { return item.grid.get() == &grid; };
  const bool surface = std::any_of(packet.isosurfaces.begin(), packet.isosurfaces.end(), uses) ||
                       std::any_of(packet.slices.begin(), packet.slices.end(), uses) ||
                       grid.interpolation() == field::Interpolation::nearest;  // a rounded label is another label
  const bool float32 = settings.texel_format == TexelFormat::r32f || (settings.texel_format == TexelFormat::automatic && surface) ||
                       display_range(grid).has_outliers();  // half floats scaled to an outlier of 1e20 would lose the values from 0 to 1
  return {float32, settings.layout};
}

Result<std::shared_ptr<const ResidentGrid>> Frame::resident_grid(const field::ScalarGrid& grid) const {
  return residency.get(grid, residency_options(packet, settings, grid));
}

void CoarseGrids::add(const std::string& name) {
  if (std::ranges::find(names_, name) == names_.end()) names_.push_back(name);
}

std::string CoarseGrids::warning() const {
  std::string text;
  for (const std::string& name : names_)
    text += (text.empty() ? "drawn from the level in memory, not from the finest one (--memory MB loads a finer one): " : ", ") +
            in_quotes(name);
  return text;
}

}  // namespace catena::render
