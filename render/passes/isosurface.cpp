#include "render/passes/isosurface.h"

#include <algorithm>
#include <cmath>

#include "render/passes/targets.h"

namespace catena::render {
namespace {

constexpr std::uint32_t kVertexShader[] = {
#include "spirv/screen.vert.inc"
};
constexpr std::uint32_t kFragmentShader[] = {
#include "spirv/isosurface.frag.inc"
};

/// The pixels that the bricks with the level can cover; all where one of their corners is behind the eye.
VkRect2D surface_area(const CellMap& cells, const GridMirror& mirror, const field::Mapping& mapping, const Camera& camera) {
  if (cells.lo == cells.hi) return {};
  const Vec3 origin(mirror.origin.x, mirror.origin.y, mirror.origin.z);
  double x0 = camera.width, y0 = camera.height, x1 = 0, y1 = 0;
  for (int i = 0; i < 8; ++i) {
    const Vec3 local{(i & 1) ? cells.hi.x : cells.lo.x, (i & 2) ? cells.hi.y : cells.lo.y, (i & 4) ? cells.hi.z : cells.lo.z};
    const auto pixel = project(camera, mapping.world_from_index(origin + local));
    if (!pixel) return {{0, 0}, {std::uint32_t(camera.width), std::uint32_t(camera.height)}};
    x0 = std::min(x0, pixel->x);
    y0 = std::min(y0, pixel->y);
    x1 = std::max(x1, pixel->x);
    y1 = std::max(y1, pixel->y);
  }
  x0 = std::clamp(std::floor(x0) - 1, 0.0, camera.width);
  y0 = std::clamp(std::floor(y0) - 1, 0.0, camera.height);
  x1 = std::clamp(std::ceil(x1) + 1, x0, camera.width);
  y1 = std::clamp(std::ceil(y1) + 1, y0, camera.height);
  return {{std::int32_t(x0), std::int32_t(y0)}, {std::uint32_t(x1 - x0), std::uint32_t(y1 - y0)}};
}

VkRect2D intersection(const VkRect2D& a, const VkRect2D& b) {
  const std::int32_t x0 = std::max(a.offset.x, b.offset.x), y0 = std::max(a.offset.y, b.offset.y);
  const std::int32_t x1 = std::min(a.offset.x + std::int32_t(a.extent.width), b.offset.x + std::int32_t(b.extent.width));
  const std::int32_t y1 = std::min(a.offset.y + std::int32_t(a.extent.height), b.offset.y + std::int32_t(b.extent.height));
  return {{x0, y0}, {std::uint32_t(std::max(0, x1 - x0)), std::uint32_t(std::max(0, y1 - y0))}};
}

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

Result<const vk::Pipeline*> IsosurfacePass::pipeline(std::uint32_t flags, bool has_cells) {
  vk::Pipeline& pipeline = pipelines_[{flags, has_cells}];
  if (!pipeline) {
    vk::GraphicsInfo info;
    info.vertex = kVertexShader;
    info.fragment = kFragmentShader;
    info.slots = {{0, vk::Resource::uniform}, {1, vk::Resource::texture}};
    add_grid_slots(info.slots, 1);
    info.constants = {flags, has_cells ? 1u : 0u};
    info.colors = {kOpaqueFormat, kDepthValueFormat};
    info.depth = true;
    CATENA_TRY(pipeline, vk::Pipeline::create(*device_, info));
  }
  return &pipeline;
}

Outcome IsosurfacePass::make_cells(Surface& surface) {
  surface.cells = make_cell_map(*surface.item.grid, *surface.state.mirror, surface.state.level);
  surface.cell_map = {};
  if (!surface.cells.texels.empty()) {
    CATENA_TRY(surface.cell_map, upload_cell_map(*device_, surface.cells));
  }
  surface.cells.texels = {};
  return Done{};
}

Outcome IsosurfacePass::prepare(std::span<const std::pair<const IsosurfaceItem*, std::shared_ptr<const GridMirror>>> items) {
  if (surfaces_.size() > items.size()) surfaces_.erase(surfaces_.begin() + std::ptrdiff_t(items.size()), surfaces_.end());
  while (surfaces_.size() < items.size()) surfaces_.emplace_back();
  for (std::size_t i = 0; i < items.size(); ++i) {
    Surface& surface = surfaces_[i];
    const auto [item, mirror] = items[i];
    const bool same = surface.state.map.image && surface.state.mirror == mirror && surface.state.level == float(item->level);
    CATENA_CHECK(surface.state.update(*device_, mirror, item->level));
    surface.item = *item;
    if (!same) CATENA_CHECK(make_cells(surface));
  }
  return Done{};
}

Outcome IsosurfacePass::record(vk::Commands& commands, const CameraRays& rays, const VkRect2D& area) {
  for (Surface& surface : surfaces_) {
    shared::FrameData data = rays.frame();
    const VkRect2D around = intersection(area, surface_area(surface.cells, *surface.state.mirror, surface.item.grid->mapping(), rays.camera));
    if (around.extent.width == 0 || around.extent.height == 0) continue;
    data.grids[0] = surface_data(rays, surface.state, surface.item);
    CATENA_CHECK(write_uniform(*device_, surface.uniform, data));
    const BoundGrid bound = surface.state.bound();
    CATENA_TRY(const vk::Pipeline* pipe, pipeline(bound.flags(), bool(surface.cell_map)));
    std::vector<vk::Binding> bindings{{0, vk::Resource::uniform, &surface.uniform, nullptr, nullptr},
                                      {1, vk::Resource::texture, nullptr, surface.cell_map ? &surface.cell_map : &bound.map->image, nullptr}};
    add_grid_bindings(bindings, {&bound, 1}, 1, linear_);
    commands.scissor(around);
    commands.bind(*pipe, bindings);
    commands.draw_triangle();
  }
  return Done{};
}

}  // namespace catena::render
