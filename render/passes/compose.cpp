// SPDX-License-Identifier: MIT
#include <map>

#include "engine/base/result.h"
#include "render/passes/passes.h"
#include "render/raycast/fast_volume.h"
#include "render/vk/commands.h"

namespace catena::render {
namespace {

constexpr std::uint32_t kComposeVertexShader[] = {
#include "spirv/fullscreen.vert.inc"
};
constexpr std::uint32_t kComposeFragmentShader[] = {
#include "spirv/compose.frag.inc"
};

constexpr int kMaxStep = 16;  ///< pixels searched along a step of a contour in each direction

class ComposePass final : public Pass {
 public:
  explicit ComposePass(vk::Device& device) : upsample_(device) {}
  static Result<std::unique_ptr<Pass>> create(vk::Device& device) {
    std::unique_ptr<ComposePass> self(new ComposePass(device));
    CATENA_TRY(self->placeholder_id_, create_placeholder_id(device));
    return std::unique_ptr<Pass>(std::move(self));
  }
  PassUse use(const Frame& frame) const override {
    TargetSet reads = target::opaque_color | target::volume | target::occluded_overlay;
    if (smooths_edges(frame)) reads |= target::opaque_depth | target::opaque_id;
    return {frame.written_targets & reads, target::output, true};
  }
  Outcome prepare(Frame&) override { return Done{}; }
  Outcome record(vk::Commands& commands, Frame& frame) override;

 private:
  /// Returns whether contours are antialiased: not at half resolution, whose pixels have no ids of their own.
  static bool smooths_edges(const Frame& frame) {
    return frame.settings.smooth_edges && frame.has(target::opaque_id) && frame.half_resolution_volume == nullptr;
  }
  Result<const vk::Pipeline*> pipeline(Frame& frame, bool ghost);
  Upsampler upsample_;
  std::map<std::pair<VkFormat, std::uint32_t>, vk::Pipeline> pipelines_;
  vk::Buffer uniform_;
  vk::Image placeholder_id_;  ///< bound where the id image is not used
};

Result<const vk::Pipeline*> ComposePass::pipeline(Frame& frame, bool ghost) {
  const VkFormat format = frame.targets.output_format;
  const bool opaque = frame.has(target::opaque_color), volume = frame.has(target::volume);
  const bool smooth = smooths_edges(frame);
  vk::Pipeline& pipeline = pipelines_[{format, (opaque ? 1u : 0u) | (volume ? 2u : 0u) | (ghost ? 4u : 0u) | (smooth ? 8u : 0u)}];
  if (!pipeline) {
    vk::GraphicsInfo info;
    info.vertex = kComposeVertexShader;
    info.fragment = kComposeFragmentShader;
    info.layout_bindings = {{0, vk::DescriptorKind::uniform}, {1, vk::DescriptorKind::texture}, {2, vk::DescriptorKind::texture},
                            {3, vk::DescriptorKind::texture}, {4, vk::DescriptorKind::texture}, {5, vk::DescriptorKind::texture}};
    info.constants = {opaque, volume, ghost, smooth};
    info.colors = {format};
    CATENA_TRY(pipeline, vk::Pipeline::create(frame.device, info));
  }
  return &pipeline;
}

/// Composites the image without the ghost, then the ghost's area once more with it.
Outcome ComposePass::record(vk::Commands& commands, Frame& frame) {
  Targets& targets = frame.targets;
  const bool opaque = frame.has(target::opaque_color), volume = frame.has(target::volume), smooth = smooths_edges(frame);
  const bool ghost = frame.has(target::occluded_overlay) && frame.occluded_area.extent.width > 0 && frame.occluded_area.extent.height > 0;
  const bool is_linear = frame.packet.illumination.is_linear;
  const std::array<float, 4>& background = frame.packet.background;
  if (frame.half_resolution_volume) {
    CATENA_ASSERT(!ghost);  // without opaque items there is no cursor, and so no ghost
    return upsample_.record(commands, *frame.half_resolution_volume, opaque ? &targets.opaque_color : nullptr, targets.placeholder,
                            background, is_linear, frame.half_resolution_area, targets.output);
  }
  CATENA_TRY(const vk::Pipeline* plain, pipeline(frame, false));
  const vk::Pipeline* with_ghost = nullptr;
  if (ghost) {
    CATENA_TRY(with_ghost, pipeline(frame, true));
  }
  shared::ComposeData data{};
  data.background = background_data(background, is_linear);
  data.is_linear = is_linear ? 1 : 0;
  data.sides = 4;
  data.ends = 2;
  data.max_step = kMaxStep;
  CATENA_CHECK(vk::write_uniform(frame.device, uniform_, data));
  targets.begin(commands, target::output, target::output);
  const vk::Binding bindings[] = {
      {0, vk::DescriptorKind::uniform, &uniform_, nullptr, nullptr},
      {1, vk::DescriptorKind::texture, nullptr, opaque ? &targets.opaque_color : &targets.placeholder, nullptr},
      {2, vk::DescriptorKind::texture, nullptr, volume ? &targets.volume : &targets.placeholder, nullptr},
      {3, vk::DescriptorKind::texture, nullptr, ghost ? &targets.occluded_overlay : &targets.placeholder, nullptr},
      {4, vk::DescriptorKind::texture, nullptr, smooth ? &targets.opaque_depth : &targets.placeholder, nullptr},
      {5, vk::DescriptorKind::texture, nullptr, smooth ? &targets.opaque_id : &placeholder_id_, nullptr}};
  commands.bind(*plain, bindings);
  commands.draw_triangle();
  if (with_ghost) {
    commands.set_scissor(frame.occluded_area);
    commands.bind(*with_ghost, bindings);
    commands.draw_triangle();
  }
  commands.end_pass();
  return Done{};
}

}  // namespace

const PassEntry kComposePass{"compose", [](const Frame&) { return true; }, ComposePass::create, target::output};

}  // namespace catena::render
