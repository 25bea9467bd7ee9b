#include "render/passes/isosurface.h"

#include <algorithm>
#include <map>

#include "render/passes/covered_area.h"
#include "render/passes/targets.h"

namespace catena::render {
namespace {

constexpr std::uint32_t kVertexShader[] = {
#include "spirv/screen.vert.inc"
};
constexpr std::uint32_t kFragmentShader[] = {
#include "spirv/isosurface.frag.inc"
};

bool is_opaque(const IsosurfaceItem& item) { return item.opacity >= 1; }

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
  data.id = item.id;
  data.clipped = item.clipped;
  return data;
}

namespace {

class IsosurfacePass final : public Pass {
 public:
  static Result<std::unique_ptr<Pass>> create(vk::Device& device) {
    auto self = std::make_unique<IsosurfacePass>();
    CATENA_TRY(self->linear_, vk::Sampler::create(device, vk::Filter::linear));
    return std::unique_ptr<Pass>(std::move(self));
  }
  PassUse use(const Frame&) const override { return {0, target::opaque}; }
  Outcome prepare(Frame& frame) override;
  Bounds bounds() const override;
  Outcome record(vk::Commands& commands, Frame& frame) override;

 private:
  struct Surface {
    SurfaceState state;
    IsosurfaceItem item;
    vk::Buffer uniform;
  };
  Result<const vk::Pipeline*> pipeline(vk::Device& device, std::uint32_t flags);

  vk::Sampler linear_;
  std::map<std::uint32_t, vk::Pipeline> pipelines_;
  std::vector<Surface> surfaces_;
};

Result<const vk::Pipeline*> IsosurfacePass::pipeline(vk::Device& device, std::uint32_t flags) {
  vk::Pipeline& pipeline = pipelines_[flags];
  if (!pipeline) {
    vk::GraphicsInfo info;
    info.vertex = kVertexShader;
    info.fragment = kFragmentShader;
    info.slots = {{0, vk::Resource::uniform}};
    add_grid_slots(info.slots, 1);
    info.constants = {flags};
    info.colors = opaque_formats();
    info.depth = true;
    CATENA_TRY(pipeline, vk::Pipeline::create(device, info));
  }
  return &pipeline;
}

Outcome IsosurfacePass::prepare(Frame& frame) {
  std::size_t count = 0;
  for (const IsosurfaceItem& item : frame.packet.isosurfaces) {
    if (!is_opaque(item)) continue;
    CATENA_TRY(auto mirror, frame.mirror(*item.grid));
    if (!mirror->drawable) continue;
    if (count == surfaces_.size()) surfaces_.emplace_back();
    Surface& surface = surfaces_[count++];
    CATENA_CHECK(surface.state.update(frame.device, std::move(mirror), item.level));
    surface.item = item;
  }
  while (surfaces_.size() > count) surfaces_.pop_back();
  return Done{};
}

Bounds IsosurfacePass::bounds() const {
  Bounds all;
  for (const Surface& surface : surfaces_) all.add(grid_bounds(*surface.item.grid));
  return all;
}

Outcome IsosurfacePass::record(vk::Commands& commands, Frame& frame) {
  for (Surface& surface : surfaces_) {
    const field::ScalarGrid* grid = surface.item.grid.get();
    shared::FrameData data = frame.rays.frame();
    data.grids[0] = surface_data(frame.rays, surface.state, surface.item);
    CATENA_CHECK(write_uniform(frame.device, surface.uniform, data));
    const BoundGrid bound = surface.state.bound();
    CATENA_TRY(const vk::Pipeline* pipe, pipeline(frame.device, bound.flags()));
    std::vector<vk::Binding> bindings{{0, vk::Resource::uniform, &surface.uniform, nullptr, nullptr}};
    add_grid_bindings(bindings, {&bound, 1}, 1, linear_);
    commands.scissor(covered_area({&grid, 1}, frame.rays.camera));
    commands.bind(*pipe, bindings);
    commands.draw_triangle();
  }
  return Done{};
}

}  // namespace

const PassEntry kIsosurfacePass{
    "isosurfaces",
    [](const Frame& frame) { return std::any_of(frame.packet.isosurfaces.begin(), frame.packet.isosurfaces.end(), is_opaque); },
    IsosurfacePass::create};

}  // namespace catena::render
