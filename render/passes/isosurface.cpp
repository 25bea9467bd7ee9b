#include <algorithm>
#include <map>

#include "render/mirror/cell_map.h"
#include "render/passes/passes.h"
#include "render/passes/still_surfaces.h"
#include "render/raycast/bound_grids.h"
#include "render/vk/commands.h"

namespace catena::render {
namespace {

constexpr std::uint32_t kIsosurfaceVertexShader[] = {
#include "spirv/screen.vert.inc"
};
constexpr std::uint32_t kIsosurfaceFragmentShader[] = {
#include "spirv/isosurface.frag.inc"
};

/// The pixels that the bricks with the level can cover.
VkRect2D surface_area(const CellMap& cells, const GridMirror& mirror, const field::Mapping& mapping, const Camera& camera) {
  if (cells.lo == cells.hi) return {};
  const Vec3 origin(mirror.origin.x, mirror.origin.y, mirror.origin.z);
  std::array<Vec3, 8> corners;
  for (int i = 0; i < 8; ++i) {
    const Vec3 local{(i & 1) ? cells.hi.x : cells.lo.x, (i & 2) ? cells.hi.y : cells.lo.y, (i & 4) ? cells.hi.z : cells.lo.z};
    corners[i] = mapping.world_from_index(origin + local);
  }
  return covered_area(corners, camera);
}

bool is_opaque(const IsosurfaceItem& item) { return item.opacity >= 1; }

class IsosurfacePass final : public Pass {
 public:
  static Result<std::unique_ptr<Pass>> create(vk::Device& device) {
    auto self = std::make_unique<IsosurfacePass>();
    CATENA_TRY(self->linear_, vk::Sampler::create(device, vk::Filter::linear));
    return std::unique_ptr<Pass>(std::move(self));
  }
  PassUse use(const Frame& frame) const override { return {0, target::opaque, frame.settings.keep}; }
  Outcome prepare(Frame& frame) override;
  Bounds bounds() const override;
  Outcome record(vk::Commands& commands, Frame& frame) override;
  bool finds_surfaces() const override { return true; }
  bool has_kept() const override { return keeps_ && still_[eye_].has_kept(); }

 private:
  struct Surface {
    SurfaceState state;
    CellMap cells;       // without its texels: they are in the image
    vk::Image cell_map;  // none: it would be too large, or the state has it
    IsosurfaceItem item;
    vk::Buffer uniform;
    Outcome make_cells(vk::Device& device);
  };
  Result<const vk::Pipeline*> pipeline(vk::Device& device, std::uint32_t flags, bool has_cells);

  vk::Sampler linear_;
  std::map<std::pair<std::uint32_t, bool>, vk::Pipeline> pipelines_;
  Outcome draw(vk::Commands& commands, Frame& frame);

  std::vector<Surface> surfaces_;
  std::vector<StillSurfaces> still_;  ///< an eye's each
  std::size_t eye_ = 0;
  std::uint64_t version_ = 0;  ///< counts what prepare() has found new
  bool keeps_ = false;
};

Result<const vk::Pipeline*> IsosurfacePass::pipeline(vk::Device& device, std::uint32_t flags, bool has_cells) {
  vk::Pipeline& pipeline = pipelines_[{flags, has_cells}];
  if (!pipeline) {
    vk::GraphicsInfo info;
    info.vertex = kIsosurfaceVertexShader;
    info.fragment = kIsosurfaceFragmentShader;
    info.slots = {{0, vk::Resource::uniform}, {1, vk::Resource::texture}};
    add_grid_slots(info.slots, 1);
    info.constants = {flags, has_cells ? 1u : 0u};
    info.colors = opaque_formats();
    info.depth = true;
    CATENA_TRY(pipeline, vk::Pipeline::create(device, info));
  }
  return &pipeline;
}

Outcome IsosurfacePass::Surface::make_cells(vk::Device& device) {
  cell_map = {};
  if (state.mirror->cubic) {
    cells = state.cells;
    return Done{};
  }
  cells = make_cell_map(state.mirror->source(*item.grid), *state.mirror, state.level);
  if (!cells.texels.empty()) {
    CATENA_TRY(cell_map, upload_cell_map(device, cells));
  }
  cells.texels = {};
  return Done{};
}

Outcome IsosurfacePass::prepare(Frame& frame) {
  std::size_t count = 0;
  for (const IsosurfaceItem& item : frame.packet.isosurfaces) {
    if (!is_opaque(item)) continue;
    CATENA_TRY(auto mirror, frame.mirror(*item.grid));
    if (!mirror->drawable) continue;
    if (count == surfaces_.size()) surfaces_.emplace_back();
    Surface& surface = surfaces_[count++];
    const bool same = surface.state.map.image && surface.state.mirror == mirror && surface.state.level == float(item.level);
    CATENA_CHECK(surface.state.update(frame.device, *item.grid, std::move(mirror), item.level));
    surface.item = item;
    version_ += !same;
    if (!same) CATENA_CHECK(surface.make_cells(frame.device));
  }
  while (surfaces_.size() > count) surfaces_.pop_back();
  return Done{};
}

Bounds IsosurfacePass::bounds() const {
  Bounds all;
  for (const Surface& surface : surfaces_) all.add(surface.item.grid->world_bounds());
  return all;
}

Outcome IsosurfacePass::record(vk::Commands& commands, Frame& frame) {
  keeps_ = false;
  if (!frame.settings.keep) return draw(commands, frame);
  still_.resize(frame.eyes);
  StillSurfaces& still = still_[eye_ = frame.eye];
  keeps_ = bool(still.fit(frame.device, {frame.packet.width, frame.packet.height, 1}));
  if (keeps_) {
    StillSurfaces::Look look{{}, version_};
    for (const Surface& surface : surfaces_) {
      look.surfaces.push_back(frame.rays.frame());
      look.surfaces.back().grids[0] = surface_data(frame.rays, surface.state, surface.item);
    }
    CATENA_CHECK(still.update(commands, std::move(look), [&] { return draw(commands, frame); }));
  }
  frame.targets.begin(commands, target::opaque, target::opaque & ~frame.written);
  CATENA_CHECK(keeps_ ? still.draw(frame.device, commands, frame.rays.frame()) : draw(commands, frame));
  commands.end_pass();
  return Done{};
}

Outcome IsosurfacePass::draw(vk::Commands& commands, Frame& frame) {
  for (Surface& surface : surfaces_) {
    const GridMirror& mirror = *surface.state.mirror;
    const VkRect2D area = surface_area(surface.cells, mirror, mirror.source(*surface.item.grid).mapping(), frame.rays.camera);
    if (area.extent.width == 0 || area.extent.height == 0) continue;
    shared::FrameData data = frame.rays.frame();
    data.grids[0] = surface_data(frame.rays, surface.state, surface.item);
    CATENA_CHECK(vk::write_uniform(frame.device, surface.uniform, data));
    const BoundGrid bound = surface.state.bound();
    const bool has_cells = frame.settings.skip && surface.cell_map;
    CATENA_TRY(const vk::Pipeline* pipe, pipeline(frame.device, grid_flags({&bound, 1}), has_cells));
    // without the map of cells its binding is never read; the map of bricks has the right type
    std::vector<vk::Binding> bindings{{0, vk::Resource::uniform, &surface.uniform, nullptr, nullptr},
                                      {1, vk::Resource::texture, nullptr, has_cells ? &surface.cell_map : &bound.map->image, nullptr}};
    add_grid_bindings(bindings, {&bound, 1}, 1, linear_);
    commands.scissor(area);
    commands.bind(*pipe, bindings);
    commands.draw_triangle();
  }
  commands.scissor({{0, 0}, {frame.packet.width, frame.packet.height}});
  return Done{};
}

}  // namespace

const PassEntry kIsosurfacePass{
    "isosurfaces",
    [](const Frame& frame) { return std::any_of(frame.packet.isosurfaces.begin(), frame.packet.isosurfaces.end(), is_opaque); },
    IsosurfacePass::create};

}  // namespace catena::render
