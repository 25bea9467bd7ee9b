// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>

#include "engine/base/result.h"
#include "render/passes/passes.h"
#include "render/vk/commands.h"
#include "shaders/shared/line_halos.h"

namespace catena::render {
namespace {

constexpr std::uint32_t kLineHalosVertexShader[] = {
#include "spirv/fullscreen.vert.inc"
};
constexpr std::uint32_t kLineHalosFragmentShader[] = {
#include "spirv/line_halos.frag.inc"
};

constexpr double kReachShare = 1.0 / 400;  // width of a halo / height of the image
constexpr double kDarkness = 0.75;         // of the darkest halo
constexpr double kRadiiApart = 3;          // a line less than so many radii in front of another has no halo on it
constexpr double kFullShare = 0.06;        // distance at which a halo is darkest / diagonal of the lines' bounds

class LineHaloPass final : public Pass {
 public:
  static Result<std::unique_ptr<Pass>> create(vk::Device& device) {
    auto self = std::make_unique<LineHaloPass>();
    vk::GraphicsInfo info;
    info.vertex = kLineHalosVertexShader;
    info.fragment = kLineHalosFragmentShader;
    info.layout_bindings = {{0, vk::DescriptorKind::uniform}, {1, vk::DescriptorKind::texture}, {2, vk::DescriptorKind::texture}};
    info.colors = {kOpaqueFormat};
    info.blends = {vk::Blend::over};
    CATENA_TRY(self->pipeline_, vk::Pipeline::create(device, info));
    return std::unique_ptr<Pass>(std::move(self));
  }
  PassUse use(const Frame&) const override { return {target::opaque_depth | target::opaque_id, target::opaque_color}; }

  Outcome prepare(Frame& frame) override {
    shared::LineHaloData data{};
    Bounds bounds;
    double radius = 0;
    for (const TubeItem& tube : frame.packet.tubes) {
      if (tube.id < 32 * LINE_ID_WORDS) data.is_line[tube.id / 32] |= 1u << tube.id % 32;
      for (const Vec3& point : tube.points) bounds.extend(point);
      radius = std::max(radius, tube.radius);
    }
    data.reach = std::max(1, static_cast<int>(std::lround(kReachShare * frame.packet.height)));
    data.directions = 8;
    data.least_gap = float(kRadiiApart * radius);
    data.full_gap = data.least_gap + float(std::max(kFullShare * bounds.diagonal(), 1e-3 * radius));
    data.darkness = float(kDarkness);
    return vk::write_uniform(frame.device, uniform_, data);
  }

  Outcome record(vk::Commands& commands, Frame& frame) override {
    const vk::Binding bindings[] = {{0, vk::DescriptorKind::uniform, &uniform_, nullptr, nullptr},
                                    {1, vk::DescriptorKind::texture, nullptr, &frame.targets.opaque_depth, nullptr},
                                    {2, vk::DescriptorKind::texture, nullptr, &frame.targets.opaque_id, nullptr}};
    commands.bind(pipeline_, bindings);
    commands.draw_triangle();
    return Done{};
  }

 private:
  vk::Pipeline pipeline_;
  vk::Buffer uniform_;
};

}  // namespace

const PassEntry kLineHaloPass{"line halos", [](const Frame& frame) { return frame.packet.has_line_halos && !frame.packet.tubes.empty(); },
                              LineHaloPass::create};

}  // namespace catena::render
