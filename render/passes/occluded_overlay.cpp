// SPDX-License-Identifier: MIT
#include <algorithm>
#include <array>

#include "engine/base/result.h"
#include "render/passes/passes.h"
#include "render/passes/triangles.h"
#include "render/vk/commands.h"

namespace catena::render {
namespace {

constexpr std::uint32_t kOccludedOverlayFragmentShader[] = {
#include "spirv/occluded_overlay.frag.inc"
};

class GhostPass final : public Pass {
 public:
  static Result<std::unique_ptr<Pass>> create(vk::Device& device) {
    std::unique_ptr<GhostPass> self(new GhostPass);
    vk::GraphicsInfo info;
    set_triangle_stage(info);
    info.fragment = kOccludedOverlayFragmentShader;
    info.layout_bindings.push_back({1, vk::DescriptorKind::texture});
    info.colors = {kOccludedOverlayFormat};
    info.has_depth = true;
    CATENA_TRY(self->pipeline_, vk::Pipeline::create(device, info));
    return std::unique_ptr<Pass>(std::move(self));
  }
  PassUse use(const Frame&) const override { return {target::opaque_id, kWrites, true}; }
  Outcome prepare(Frame& frame) override {
    CATENA_ASSERT(frame.occluded_triangles != nullptr);
    return Done{};
  }

  /// Draws into a cleared depth buffer, so that only the ghost itself occludes the ghost; opaque_id tells where opaque items cover it.
  Outcome record(vk::Commands& commands, Frame& frame) override {
    frame.occluded_area = {};
    if (frame.occluded_index_count == 0) return Done{};
    std::array<Vec3, 8> corners;
    for (int i = 0; i < 8; ++i) corners[std::size_t(i)] = frame.occluded_triangles->bounds().corner(i);
    frame.occluded_area = covered_area(corners, frame.rays.camera);
    if (frame.occluded_area.extent.width == 0 || frame.occluded_area.extent.height == 0) return Done{};
    CATENA_TRY(const vk::Binding numbers, frame.occluded_triangles->frame_binding(frame.device, frame.rays));
    const vk::Binding bindings[] = {numbers, {1, vk::DescriptorKind::texture, nullptr, &frame.targets.opaque_id, nullptr}};
    frame.targets.begin(commands, kWrites, kWrites, frame.occluded_area);
    commands.bind(pipeline_, bindings);
    frame.occluded_triangles->draw(commands, frame.occluded_index_count);
    commands.end_pass();
    return Done{};
  }

 private:
  static constexpr TargetSet kWrites = target::occluded_overlay | target::depth_buffer;
  GhostPass() = default;
  vk::Pipeline pipeline_;
};

}  // namespace

const PassEntry kOccludedOverlayPass{
    "ghost", [](const Frame& frame) { return std::ranges::any_of(frame.packet.cursors, &CursorItem::show_occluded); }, GhostPass::create,
    target::occluded_overlay};

}  // namespace catena::render
