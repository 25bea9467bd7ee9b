// SPDX-License-Identifier: MIT
#include <map>

#include "engine/base/result.h"
#include "render/passes/passes.h"
#include "render/vk/commands.h"
#include "shaders/shared/vignette.h"

namespace catena::render {
namespace {

constexpr std::uint32_t kVignetteVertexShader[] = {
#include "spirv/fullscreen.vert.inc"
};
constexpr std::uint32_t kVignetteFragmentShader[] = {
#include "spirv/vignette.frag.inc"
};

class VignettePass final : public Pass {
 public:
  static Result<std::unique_ptr<Pass>> create(vk::Device&) { return std::unique_ptr<Pass>(new VignettePass); }
  PassUse use(const Frame&) const override { return {0, target::output, true}; }
  Outcome prepare(Frame&) override { return Done{}; }

  Outcome record(vk::Commands& commands, Frame& frame) override {
    const Camera& camera = frame.rays.camera;
    if (camera.orthographic) return Done{};  // no angles
    vk::Pipeline& pipeline = pipelines_[frame.targets.output_format];
    if (!pipeline) {
      vk::GraphicsInfo info;
      info.vertex = kVignetteVertexShader;
      info.fragment = kVignetteFragmentShader;
      info.layout_bindings = {{0, vk::DescriptorKind::uniform}};
      info.colors = {frame.targets.output_format};
      info.blends = {vk::Blend::over_straight};
      CATENA_TRY(pipeline, vk::Pipeline::create(frame.device, info));
    }
    shared::VignetteData data{};
    data.first = {float(camera.center_x - camera.half_width), float(-camera.center_y - camera.half_height)};
    data.step = {float(2 * camera.half_width / camera.width), float(2 * camera.half_height / camera.height)};
    data.strength = float(std::clamp(frame.packet.vignette, 0.0, 1.0));
    data.inner = float(std::tan(kVignetteInner_deg * M_PI / 180));
    data.outer = float(std::tan(kVignetteOuter_deg * M_PI / 180));
    CATENA_CHECK(vk::write_uniform(frame.device, uniform_, data));
    frame.targets.begin(commands, target::output, 0);
    const vk::Binding bindings[] = {{0, vk::DescriptorKind::uniform, &uniform_, nullptr, nullptr}};
    commands.bind(pipeline, bindings);
    commands.draw_triangle();
    commands.end_pass();
    return Done{};
  }

 private:
  std::map<VkFormat, vk::Pipeline> pipelines_;
  vk::Buffer uniform_;
};

}  // namespace

const PassEntry kVignettePass{"vignette", [](const Frame& frame) { return frame.packet.vignette > 0; }, VignettePass::create,
                              target::output};

}  // namespace catena::render
