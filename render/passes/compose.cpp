#include "render/passes/compose.h"

#include "render/passes/grid_bindings.h"

namespace catena::render {
namespace {

constexpr std::uint32_t kVertexShader[] = {
#include "spirv/screen.vert.inc"
};
constexpr std::uint32_t kFragmentShader[] = {
#include "spirv/compose.frag.inc"
};

}  // namespace

Outcome ComposePass::record(vk::Commands& commands, Targets& targets, const std::array<float, 4>& background, bool opaque, bool volume) {
  vk::Pipeline& pipeline = pipelines_[(opaque ? 1u : 0u) | (volume ? 2u : 0u)];
  if (!pipeline) {
    vk::GraphicsInfo info;
    info.vertex = kVertexShader;
    info.fragment = kFragmentShader;
    info.slots = {{0, vk::Resource::uniform}, {1, vk::Resource::texture}, {2, vk::Resource::texture}};
    info.constants = {opaque, volume};
    info.colors = {kPictureFormat};
    CATENA_TRY(pipeline, vk::Pipeline::create(*device_, info));
  }
  shared::ComposeData data{};
  data.background = {background[0], background[1], background[2], background[3]};
  CATENA_CHECK(write_uniform(*device_, uniform_, data));
  if (opaque) commands.use(targets.opaque_color, vk::kFragmentRead);
  if (volume) commands.use(targets.volume, vk::kFragmentRead);
  const vk::ColorTarget target{&targets.picture, std::array<float, 4>{0, 0, 0, 0}};
  commands.begin_pass({&target, 1}, {});
  const vk::Binding bindings[] = {{0, vk::Resource::uniform, &uniform_, nullptr, nullptr},
                                  {1, vk::Resource::texture, nullptr, opaque ? &targets.opaque_color : &targets.none, nullptr},
                                  {2, vk::Resource::texture, nullptr, volume ? &targets.volume : &targets.none, nullptr}};
  commands.bind(pipeline, bindings);
  commands.draw_triangle();
  commands.end_pass();
  commands.use(targets.picture, vk::kTransferRead);
  return Done{};
}

}  // namespace catena::render
