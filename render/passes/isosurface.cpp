#include "render/passes/isosurface.h"

#include "render/passes/targets.h"

namespace catena::render {
namespace {

constexpr std::uint32_t kVertexShader[] = {
#include "spirv/screen.vert.inc"
};
constexpr std::uint32_t kFragmentShader[] = {
#include "spirv/isosurface.frag.inc"
};

}  // namespace

Outcome SurfaceState::update(vk::Device& device, std::shared_ptr<const GridMirror> next_mirror, double next_level) {
  const auto rounded = float(next_level);
  if (mirror == next_mirror && level == rounded && map.image) return Done{};
  mirror = std::move(next_mirror);
  level = rounded;
  CATENA_TRY(map, make_brick_map(device, *mirror, [this](const BrickRange& r) { return r.least <= level && level <= r.greatest; }));
  return Done{};
}

shared::GridData surface_data(const CameraRays& rays, const SurfaceState& state, const IsosurfaceItem& item) {
  shared::GridData data = rays.grid(*state.mirror, item.grid->mapping());
  data.level = state.level;
  data.opacity = item.opacity;
  data.color = {item.color.r, item.color.g, item.color.b};
  return data;
}

Result<IsosurfacePass> IsosurfacePass::create(vk::Device& device) {
  IsosurfacePass self;
  self.device_ = &device;
  CATENA_TRY(self.linear_, vk::Sampler::create(device, vk::Filter::linear));
  return self;
}

Result<const vk::Pipeline*> IsosurfacePass::pipeline(std::uint32_t flags) {
  vk::Pipeline& pipeline = pipelines_[flags];
  if (!pipeline) {
    vk::GraphicsInfo info;
    info.vertex = kVertexShader;
    info.fragment = kFragmentShader;
    info.slots = {{0, vk::Resource::uniform}};
    add_grid_slots(info.slots, 1);
    info.constants = {flags};
    info.colors = {kOpaqueFormat, kDepthValueFormat};
    info.depth = true;
    CATENA_TRY(pipeline, vk::Pipeline::create(*device_, info));
  }
  return &pipeline;
}

Outcome IsosurfacePass::prepare(std::span<const std::pair<const IsosurfaceItem*, std::shared_ptr<const GridMirror>>> items) {
  if (surfaces_.size() > items.size()) surfaces_.erase(surfaces_.begin() + std::ptrdiff_t(items.size()), surfaces_.end());
  while (surfaces_.size() < items.size()) surfaces_.emplace_back();
  for (std::size_t i = 0; i < items.size(); ++i) {
    CATENA_CHECK(surfaces_[i].state.update(*device_, items[i].second, items[i].first->level));
    surfaces_[i].item = *items[i].first;
  }
  return Done{};
}

Outcome IsosurfacePass::record(vk::Commands& commands, const CameraRays& rays, const VkRect2D& area) {
  for (Surface& surface : surfaces_) {
    shared::FrameData data = rays.frame();
    data.grids[0] = surface_data(rays, surface.state, surface.item);
    CATENA_CHECK(write_uniform(*device_, surface.uniform, data));
    const BoundGrid bound = surface.state.bound();
    CATENA_TRY(const vk::Pipeline* pipe, pipeline(bound.flags()));
    std::vector<vk::Binding> bindings{{0, vk::Resource::uniform, &surface.uniform, nullptr, nullptr}};
    add_grid_bindings(bindings, {&bound, 1}, 1, linear_);
    commands.scissor(area);
    commands.bind(*pipe, bindings);
    commands.draw_triangle();
  }
  return Done{};
}

}  // namespace catena::render
