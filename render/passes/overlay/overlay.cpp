// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cstring>

#include "render/passes/overlay/canvas.h"
#include "render/passes/passes.h"
#include "render/vk/commands.h"

namespace catena::render {
namespace {

constexpr std::uint32_t kOverlayVertexShader[] = {
#include "spirv/overlay.vert.inc"
};
constexpr std::uint32_t kOverlayFragmentShader[] = {
#include "spirv/overlay.frag.inc"
};
constexpr std::uint32_t kOverlayBlendShader[] = {
#include "spirv/overlay_blend.comp.inc"
};
constexpr std::uint32_t kOverlayBlendFloatShader[] = {
#include "spirv/overlay_blend_float.comp.inc"
};
constexpr VkFormat kAtlasFormat = VK_FORMAT_R8_UNORM;
constexpr VkFormat kOverlayFormat = VK_FORMAT_R8G8B8A8_UNORM;  // premultiplied alpha
constexpr vk::ResourceUse kComputeBoth{VK_IMAGE_LAYOUT_GENERAL, VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT,
                                       VK_ACCESS_2_SHADER_READ_BIT | VK_ACCESS_2_SHADER_WRITE_BIT};
constexpr double kSlackShare = 1e-3;  // share of the distance; keeps a label on a surface in front of it

class OverlayPass final : public Pass {
 public:
  static Result<std::unique_ptr<Pass>> create(vk::Device& device);
  PassUse use(const Frame& frame) const override;
  Outcome prepare(Frame& frame) override;
  Outcome record(vk::Commands& commands, Frame& frame) override;
  std::string warning() const override { return typesetter_.error_message(); }

 private:
  OverlayPass() = default;
  Outcome lay_out(Frame& frame);
  Outcome upload_atlas(vk::Device& device);

  Typesetter typesetter_;
  vk::Pipeline draw_, blend_;
  vk::Buffer shapes_, stops_, uniform_;
  vk::Image atlas_, image_;
  VkFormat blend_format_ = VK_FORMAT_UNDEFINED;
  std::uint64_t atlas_version_ = 0;
  std::uint32_t count_ = 0;
};

Result<std::unique_ptr<Pass>> OverlayPass::create(vk::Device& device) {
  std::unique_ptr<OverlayPass> self(new OverlayPass);
  vk::GraphicsInfo draw;
  draw.vertex = kOverlayVertexShader;
  draw.fragment = kOverlayFragmentShader;
  draw.layout_bindings = {{0, vk::DescriptorKind::uniform},
                          {1, vk::DescriptorKind::buffer},
                          {2, vk::DescriptorKind::buffer},
                          {3, vk::DescriptorKind::texture},
                          {4, vk::DescriptorKind::texture}};
  draw.colors = {kOverlayFormat};
  draw.blends = {vk::Blend::over};
  CATENA_TRY(self->draw_, vk::Pipeline::create(device, draw));
  return std::unique_ptr<Pass>(std::move(self));
}

/// Reads the opaque depth if a label is hidden by occlusion.
PassUse OverlayPass::use(const Frame& frame) const {
  const auto& labels = frame.packet.overlay.labels;
  const bool hides = std::any_of(labels.begin(), labels.end(), [](const LabelItem& label) { return label.hide_if_occluded; });
  return {hides ? frame.written_targets & target::opaque_depth : 0, target::output, true};
}

Outcome OverlayPass::upload_atlas(vk::Device& device) {
  const GlyphAtlas& atlas = typesetter_.atlas();
  if (atlas_ && atlas_version_ == atlas.version()) return Done{};
  // an empty atlas: one row, never read
  const auto height = std::uint32_t(std::max(1, atlas.height()));
  if (!atlas_ || atlas_.info().extent.height != height) {
    vk::ImageInfo info;
    info.format = kAtlasFormat;
    info.extent = {std::uint32_t(GlyphAtlas::kWidth), height, 1};
    info.usage = VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT;
    CATENA_TRY(atlas_, vk::Image::create(device, info));
  }
  CATENA_CHECK(vk::upload_planes(device, atlas_, 1, [&](std::uint32_t, std::uint32_t, std::byte* out) {
    if (!atlas.pixels().empty()) std::memcpy(out, atlas.pixels().data(), atlas.pixels().size());
  }));
  atlas_version_ = atlas.version();
  return Done{};
}

/// Makes an image of the output's size.
Outcome OverlayPass::prepare(Frame& frame) {
  return vk::ensure_image(frame.device, image_, kOverlayFormat, frame.packet.width, frame.packet.height);
}

/// Converts the items into shapes; called when the frame's camera is fixed.
Outcome OverlayPass::lay_out(Frame& frame) {
  const Overlay& overlay = frame.packet.overlay;
  Canvas canvas(frame.packet, typesetter_);
  draw_labels(canvas, overlay, frame.rays.camera, frame.rays.reference_depth);
  draw_scalar_bars(canvas, overlay);
  if (overlay.orientation_marker) draw_orientation_marker(canvas, *overlay.orientation_marker, frame.rays.camera);
  if (overlay.status) draw_status(canvas, *overlay.status);
  draw_texts(canvas, overlay);
  const std::vector<shared::OverlayShape>& shapes = canvas.finish();
  count_ = std::uint32_t(shapes.size());
  CATENA_CHECK(vk::write_items(frame.device, shapes_, shapes, VK_BUFFER_USAGE_STORAGE_BUFFER_BIT));
  CATENA_CHECK(vk::write_items(frame.device, stops_, canvas.stops(), VK_BUFFER_USAGE_STORAGE_BUFFER_BIT));
  return upload_atlas(frame.device);
}

Outcome OverlayPass::record(vk::Commands& commands, Frame& frame) {
  CATENA_CHECK(lay_out(frame));
  if (count_ == 0) return Done{};
  Targets& targets = frame.targets;
  const bool hides = (use(frame).reads & target::opaque_depth) != 0;
  const VkExtent3D& extent = image_.info().extent;
  shared::OverlayData data{};
  data.half_size = {0.5f * float(extent.width), 0.5f * float(extent.height)};
  data.depth_slack = float(kSlackShare * frame.rays.depth_far);
  data.has_depth = hides;
  CATENA_CHECK(vk::write_uniform(frame.device, uniform_, data));

  // draw the shapes in order
  if (hides) commands.transition(targets.opaque_depth, vk::kShaderRead);
  const vk::ColorTarget into{&image_, std::array<float, 4>{0, 0, 0, 0}};
  commands.begin_pass({&into, 1}, {});
  const vk::Binding drawn[] = {{0, vk::DescriptorKind::uniform, &uniform_, nullptr, nullptr},
                               {1, vk::DescriptorKind::buffer, &shapes_, nullptr, nullptr},
                               {2, vk::DescriptorKind::buffer, &stops_, nullptr, nullptr},
                               {3, vk::DescriptorKind::texture, nullptr, &atlas_, nullptr},
                               {4, vk::DescriptorKind::texture, nullptr, hides ? &targets.opaque_depth : &targets.placeholder, nullptr}};
  commands.bind(draw_, drawn);
  commands.draw(6 * count_, 1);
  commands.end_pass();

  // blend over the output, in its format
  const VkFormat format = targets.output.info().format;
  if (!blend_ || format != blend_format_) {
    vk::ComputeInfo blend;
    blend.shader = vk::Spirv(kOverlayBlendShader);
    if (format == VK_FORMAT_R32G32B32A32_SFLOAT) blend.shader = vk::Spirv(kOverlayBlendFloatShader);
    blend.layout_bindings = {{0, vk::DescriptorKind::texture}, {1, vk::DescriptorKind::storage_image}};
    CATENA_TRY(blend_, vk::Pipeline::create(frame.device, blend));
    blend_format_ = format;
  }
  commands.transition(image_, vk::kFragmentRead);
  commands.transition(targets.output, kComputeBoth);
  const vk::Binding blended[] = {{0, vk::DescriptorKind::texture, nullptr, &image_, nullptr},
                                 {1, vk::DescriptorKind::storage_image, nullptr, &targets.output, nullptr}};
  commands.bind(blend_, blended);
  commands.dispatch((extent.width + 15) / 16, (extent.height + 3) / 4, 1);
  return Done{};
}

}  // namespace

const PassEntry kOverlayPass{"overlay", [](const Frame& frame) { return !frame.packet.overlay.empty(); }, OverlayPass::create,
                             target::output};

}  // namespace catena::render
