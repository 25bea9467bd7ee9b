#include <algorithm>

#include "engine/base/result.h"
#include "render/passes/passes.h"
#include "render/passes/triangles.h"
#include "render/vk/commands.h"

namespace catena::render {
namespace {

constexpr std::uint32_t kGhostFragmentShader[] = {
#include "spirv/ghost.frag.inc"
};

class GhostPass final : public Pass {
 public:
  static Result<std::unique_ptr<Pass>> create(vk::Device& device) {
    std::unique_ptr<GhostPass> self(new GhostPass);
    vk::GraphicsInfo info;
    set_triangle_stage(info);
    info.fragment = kGhostFragmentShader;
    info.slots.push_back({1, vk::Resource::texture});
    info.colors = {kGhostFormat};
    info.depth = true;
    CATENA_TRY(self->pipeline_, vk::Pipeline::create(device, info));
    return std::unique_ptr<Pass>(std::move(self));
  }
  PassUse use(const Frame&) const override { return {target::opaque_id, kWrites, true}; }
  Outcome prepare(Frame& frame) override {
    CATENA_ASSERT(frame.ghosts != nullptr);
    return Done{};
  }

  /// The depth buffer starts anew: what is solid is drawn, and a ghost is hidden by nothing but itself.
  Outcome record(vk::Commands& commands, Frame& frame) override {
    frame.targets.begin(commands, kWrites, kWrites);
    if (frame.ghost_indices > 0) {
      CATENA_TRY(const vk::Binding numbers, frame.ghosts->frame_binding(frame.device, frame.rays));
      const vk::Binding bindings[] = {numbers, {1, vk::Resource::texture, nullptr, &frame.targets.opaque_id, nullptr}};
      commands.bind(pipeline_, bindings);
      frame.ghosts->draw(commands, frame.ghost_indices);
    }
    commands.end_pass();
    return Done{};
  }

 private:
  static constexpr TargetSet kWrites = target::ghost | target::depth_buffer;
  GhostPass() = default;
  vk::Pipeline pipeline_;
};

}  // namespace

const PassEntry kGhostPass{"ghost", [](const Frame& frame) { return std::ranges::any_of(frame.packet.cursors, &CursorItem::ghost); },
                           GhostPass::create, target::ghost};

}  // namespace catena::render
