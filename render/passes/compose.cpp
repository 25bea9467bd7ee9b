// SPDX-License-Identifier: MIT
#include <algorithm>
#include <iterator>
#include <map>

#include "engine/base/result.h"
#include "render/passes/hand_shadow.h"
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
constexpr std::uint32_t kComposeHandFragmentShader[] = {
#include "spirv/compose_hand.frag.inc"
};

constexpr std::size_t kBindings = 6;  ///< without those of the hand's shadow
VkRect2D common_area(const VkRect2D& a, const VkRect2D& b) {
  const auto length = [](std::int32_t a0, std::uint32_t an, std::int32_t b0, std::uint32_t bn) {
    const std::int64_t end = std::min(std::int64_t(a0) + an, std::int64_t(b0) + bn);
    return std::uint32_t(std::max<std::int64_t>(0, end - std::max(a0, b0)));
  };
  return {
      {std::max(a.offset.x, b.offset.x), std::max(a.offset.y, b.offset.y)},
      {length(a.offset.x, a.extent.width, b.offset.x, b.extent.width), length(a.offset.y, a.extent.height, b.offset.y, b.extent.height)}};
}

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
    if (has_hand_shadow(frame)) reads |= target::opaque_depth;
    return {frame.written_targets & reads, target::output, true};
  }
  Outcome prepare(Frame&) override { return Done{}; }
  Outcome record(vk::Commands& commands, Frame& frame) override;

 private:
  /// Returns whether contours are antialiased: not at half resolution, whose pixels have no ids of their own.
  static bool smooths_edges(const Frame& frame) {
    return frame.settings.smooth_edges && frame.has(target::opaque_id) && frame.half_resolution_volume == nullptr;
  }
  static bool has_hand_shadow(const Frame& frame) { return frame.hand_shadow && frame.hand_shadow->area().extent.width > 0; }
  Result<const vk::Pipeline*> pipeline(Frame& frame, bool ghost, bool hand);
  Upsampler upsample_;
  std::map<std::pair<VkFormat, std::uint32_t>, vk::Pipeline> pipelines_;
  vk::Buffer uniform_;
  vk::Image placeholder_id_;  ///< bound where the id image is not used
};

Result<const vk::Pipeline*> ComposePass::pipeline(Frame& frame, bool ghost, bool hand) {
  const VkFormat format = frame.targets.output_format;
  const bool opaque = frame.has(target::opaque_color), volume = frame.has(target::volume);
  const bool smooth = smooths_edges(frame);
  vk::Pipeline& pipeline =
      pipelines_[{format, (opaque ? 1u : 0u) | (volume ? 2u : 0u) | (ghost ? 4u : 0u) | (smooth ? 8u : 0u) | (hand ? 16u : 0u)}];
  if (!pipeline) {
    vk::GraphicsInfo info;
    info.vertex = hand ? HandShadow::vertex_shader() : vk::Spirv(kComposeVertexShader);
    info.fragment = hand ? vk::Spirv(kComposeHandFragmentShader) : vk::Spirv(kComposeFragmentShader);
    info.layout_bindings = {{0, vk::DescriptorKind::uniform}, {1, vk::DescriptorKind::texture}, {2, vk::DescriptorKind::texture},
                            {3, vk::DescriptorKind::texture}, {4, vk::DescriptorKind::texture}, {5, vk::DescriptorKind::texture}};
    if (hand) std::ranges::copy(HandShadow::layout(), std::back_inserter(info.layout_bindings));
    info.constants = {opaque, volume, ghost, smooth};
    info.colors = {format};
    CATENA_TRY(pipeline, vk::Pipeline::create(frame.device, info));
  }
  return &pipeline;
}

/// Composites the image, then the areas of the hand's shadow and of the ghost once more with them.
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
  const bool hand = has_hand_shadow(frame);
  shared::ComposeData data{};
  data.background = background_data(background, is_linear);
  data.is_linear = is_linear ? 1 : 0;
  data.sides = 4;
  data.ends = 2;
  data.max_step = kMaxStep;
  CATENA_CHECK(vk::write_uniform(frame.device, uniform_, data));
  if (hand) CATENA_CHECK(frame.hand_shadow->record_mask(commands, frame));
  targets.begin(commands, target::output, target::output);
  std::vector<vk::Binding> bindings{
      {0, vk::DescriptorKind::uniform, &uniform_, nullptr, nullptr},
      {1, vk::DescriptorKind::texture, nullptr, opaque ? &targets.opaque_color : &targets.placeholder, nullptr},
      {2, vk::DescriptorKind::texture, nullptr, volume ? &targets.volume : &targets.placeholder, nullptr},
      {3, vk::DescriptorKind::texture, nullptr, ghost ? &targets.occluded_overlay : &targets.placeholder, nullptr},
      {4, vk::DescriptorKind::texture, nullptr, smooth || (hand && opaque) ? &targets.opaque_depth : &targets.placeholder, nullptr},
      {5, vk::DescriptorKind::texture, nullptr, smooth ? &targets.opaque_id : &placeholder_id_, nullptr}};
  if (hand) std::ranges::copy(frame.hand_shadow->bindings(targets), std::back_inserter(bindings));
  const auto draw = [&](const VkRect2D& area, bool with_ghost, bool with_hand) -> Outcome {
    CATENA_TRY(const vk::Pipeline* pipe, pipeline(frame, with_ghost, with_hand));
    const std::size_t count = with_hand ? bindings.size() : kBindings;
    commands.set_scissor(area);
    commands.bind(*pipe, std::span(bindings).first(count));
    if (with_hand)
      commands.draw(6, frame.hand_shadow->tile_count());
    else
      commands.draw_triangle();
    return Done{};
  };
  CATENA_CHECK(draw({{0, 0}, {frame.packet.width, frame.packet.height}}, false, false));
  if (ghost) CATENA_CHECK(draw(frame.occluded_area, true, false));
  if (hand) CATENA_CHECK(draw(frame.hand_shadow->area(), false, true));
  if (ghost && hand) CATENA_CHECK(draw(common_area(frame.occluded_area, frame.hand_shadow->area()), true, true));
  commands.end_pass();
  return Done{};
}

}  // namespace

const PassEntry kComposePass{"compose", [](const Frame&) { return true; }, ComposePass::create, target::output};

}  // namespace catena::render
