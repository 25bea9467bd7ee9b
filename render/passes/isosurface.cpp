// SPDX-License-Identifier: MIT
#include <algorithm>
#include <map>

#include "engine/field/bricks/paged_grid.h"
#include "render/passes/paged_surfaces.h"
#include "render/passes/passes.h"
#include "render/passes/surface_cache.h"
#include "render/raycast/grid_bindings.h"
#include "render/residency/cell_map.h"
#include "render/vk/commands.h"

namespace catena::render {
namespace {

constexpr std::uint32_t kIsosurfaceVertexShader[] = {
#include "spirv/fullscreen.vert.inc"
};
constexpr std::uint32_t kIsosurfaceFragmentShader[] = {
#include "spirv/isosurface.frag.inc"
};

bool is_opaque(const IsosurfaceItem& item) { return item.opacity >= 1; }

class IsosurfacePass final : public Pass {
 public:
  static Result<std::unique_ptr<Pass>> create(vk::Device& device) {
    auto self = std::make_unique<IsosurfacePass>();
    CATENA_TRY(self->linear_, vk::Sampler::create(device, vk::Filter::linear));
    return std::unique_ptr<Pass>(std::move(self));
  }
  PassUse use(const Frame& frame) const override { return {0, target::opaque, frame.settings.reuse_rays || !paged_.is_empty()}; }
  Outcome prepare(Frame& frame) override;
  Bounds bounds() const override;
  Outcome record(vk::Commands& commands, Frame& frame) override;
  bool casts_surface_rays() const override { return true; }
  bool reused_previous() const override { return keeps_ && still_[eye_].reused_previous(); }
  std::vector<PagedVolume*> pages() override { return paged_.pages(); }
  std::string warning() const override { return paged_.warning().empty() ? coarse_.warning() : paged_.warning(); }

 private:
  struct Surface {
    SurfaceState state;
    CellMap cells;       // without its texels, which are in cell_map
    vk::Image cell_map;  // empty if the map would be too large, or if the state holds it
    IsosurfaceItem item;
    vk::Buffer uniform;
    bool has_pages = false;  // drawn by PagedSurfaces; the members above `item` are empty
    Outcome make_cells(vk::Device& device);
    /// Returns the pixels that the bricks containing the level can cover.
    VkRect2D area(const Camera& camera) const;
  };
  shared::GridData grid_data(const Frame& frame, const Surface& surface) const {
    return surface.has_pages ? paged_.grid_data(frame.rays, surface.item) : surface_data(frame.rays, surface.state, surface.item);
  }
  Result<const vk::Pipeline*> pipeline(vk::Device& device, std::uint32_t flags, bool has_cells);

  vk::Sampler linear_;
  std::map<std::pair<std::uint32_t, bool>, vk::Pipeline> pipelines_;
  Outcome draw(vk::Commands& commands, Frame& frame);

  std::vector<Surface> surfaces_;
  std::vector<SurfaceCache> still_;  ///< one per eye
  std::size_t eye_ = 0;
  std::uint64_t version_ = 0;  ///< number of changes found by prepare()
  bool keeps_ = false;
  PagedSurfaces paged_;
  CoarseGrids coarse_;
};

Result<const vk::Pipeline*> IsosurfacePass::pipeline(vk::Device& device, std::uint32_t flags, bool has_cells) {
  vk::Pipeline& pipeline = pipelines_[{flags, has_cells}];
  if (!pipeline) {
    vk::GraphicsInfo info;
    info.vertex = kIsosurfaceVertexShader;
    info.fragment = kIsosurfaceFragmentShader;
    info.layout_bindings = {
        {0, vk::DescriptorKind::uniform}, {1, vk::DescriptorKind::texture}, {vk::kSharedBinding, vk::DescriptorKind::sampled}};
    add_grid_layout(info.layout_bindings, 1);
    info.constants = {flags, has_cells ? 1u : 0u};
    info.colors = opaque_formats();
    info.has_depth = true;
    CATENA_TRY(pipeline, vk::Pipeline::create(device, info));
  }
  return &pipeline;
}

VkRect2D IsosurfacePass::Surface::area(const Camera& camera) const {
  const field::Field* const paged = item.paged.get();
  if (has_pages) return covered_area({&paged, 1}, camera);
  if (cells.lo == cells.hi) return {};
  const ResidentGrid& resident = *state.resident;
  const Vec3 origin(resident.origin.x, resident.origin.y, resident.origin.z);
  std::array<Vec3, 8> corners;
  for (int i = 0; i < 8; ++i) {
    const Vec3 local{(i & 1) ? cells.hi.x : cells.lo.x, (i & 2) ? cells.hi.y : cells.lo.y, (i & 4) ? cells.hi.z : cells.lo.z};
    corners[i] = resident.source(*item.grid).mapping().world_from_index(origin + local);
  }
  return covered_area(corners, camera);
}

Outcome IsosurfacePass::Surface::make_cells(vk::Device& device) {
  cell_map = {};
  if (state.resident->cubic) {
    cells = state.cells;
    return Done{};
  }
  cells = make_cell_map(state.resident->source(*item.grid), *state.resident, state.level);
  if (!cells.texels.empty()) {
    CATENA_TRY(cell_map, upload_cell_map(device, cells));
  }
  cells.texels = {};
  return Done{};
}

Outcome IsosurfacePass::prepare(Frame& frame) {
  std::size_t count = 0;
  std::vector<const IsosurfaceItem*> paged;
  for (const IsosurfaceItem& item : frame.packet.isosurfaces)
    if (is_opaque(item) && item.paged && !item.color_by && item.grid->interpolation() == field::Interpolation::linear)
      paged.push_back(&item);
  CATENA_CHECK(paged_.prepare(frame, paged));
  coarse_.clear();
  for (const IsosurfaceItem& item : frame.packet.isosurfaces) {
    if (!is_opaque(item)) continue;
    if (paged_.has_pages(item)) {
      if (count == surfaces_.size()) surfaces_.emplace_back();
      Surface& surface = surfaces_[count++];
      surface.state = {};
      surface.cell_map = {};
      surface.item = item;
      surface.has_pages = true;
      continue;
    }
    CATENA_TRY(auto uploaded, frame.resident_grid(*item.grid));
    if (!uploaded->is_drawable) continue;
    if (count == surfaces_.size()) surfaces_.emplace_back();
    Surface& surface = surfaces_[count++];
    const bool same = surface.state.map.image && surface.state.resident == uploaded && surface.state.level == float(item.level);
    CATENA_CHECK(surface.state.update(frame.device, *item.grid, std::move(uploaded), item.level));
    surface.item = item;
    surface.has_pages = false;
    if (item.paged) coarse_.add(item.grid->name());
    version_ += !same;
    if (!same) CATENA_CHECK(surface.make_cells(frame.device));
  }
  while (surfaces_.size() > count) surfaces_.pop_back();
  return Done{};
}

Bounds IsosurfacePass::bounds() const {
  Bounds all;
  for (const Surface& surface : surfaces_)
    all.extend(surface.has_pages ? surface.item.paged->world_bounds() : surface.item.grid->world_bounds());
  return all;
}

Outcome IsosurfacePass::record(vk::Commands& commands, Frame& frame) {
  keeps_ = false;
  if (!use(frame).owns_rendering) return draw(commands, frame);
  still_.resize(frame.eye_count);
  SurfaceCache& still = still_[eye_ = frame.eye_index];
  keeps_ = frame.settings.reuse_rays && still.ensure(frame.device, {frame.packet.width, frame.packet.height, 1});
  if (keeps_) {
    SurfaceCache::Key look{{}, version_ + paged_.version()};
    for (const Surface& surface : surfaces_) {
      look.surfaces.push_back(frame.rays.frame_data());
      look.surfaces.back().grids[0] = grid_data(frame, surface);
    }
    CATENA_CHECK(still.update(commands, std::move(look), [&] { return draw(commands, frame); }));
  }
  frame.targets.begin(commands, target::opaque, target::opaque & ~frame.written_targets);
  CATENA_CHECK(keeps_ ? still.draw(frame.device, commands, frame.rays.frame_data()) : draw(commands, frame));
  commands.end_pass();
  paged_.finish_visits(commands);
  return Done{};
}

Outcome IsosurfacePass::draw(vk::Commands& commands, Frame& frame) {
  for (Surface& surface : surfaces_) {
    const VkRect2D area = surface.area(frame.rays.camera);
    if (area.extent.width == 0 || area.extent.height == 0) continue;
    commands.set_scissor(area);
    shared::FrameData data = frame.rays.frame_data();
    data.grids[0] = grid_data(frame, surface);
    CATENA_CHECK(vk::write_uniform(frame.device, surface.uniform, data));
    if (surface.has_pages) {
      CATENA_CHECK(paged_.draw(commands, frame, surface.item, surface.uniform));
      continue;
    }
    const GridBinding bound = surface.state.binding();
    const bool has_cells = frame.settings.skip_empty && surface.cell_map;
    CATENA_TRY(const vk::Pipeline* pipe, pipeline(frame.device, grid_flags({&bound, 1}), has_cells));
    // without a cell map the shader does not read the binding; the map of bricks has the right type
    std::vector<vk::Binding> bindings{
        {0, vk::DescriptorKind::uniform, &surface.uniform, nullptr, nullptr},
        {1, vk::DescriptorKind::texture, nullptr, has_cells ? &surface.cell_map : &bound.map->image, nullptr}};
    add_grid_bindings(bindings, {&bound, 1}, 1, linear_);
    commands.bind(*pipe, bindings);
    commands.draw_triangle();
  }
  commands.set_scissor({{0, 0}, {frame.packet.width, frame.packet.height}});
  return Done{};
}

}  // namespace

const PassEntry kIsosurfacePass{
    "isosurfaces",
    [](const Frame& frame) { return std::any_of(frame.packet.isosurfaces.begin(), frame.packet.isosurfaces.end(), is_opaque); },
    IsosurfacePass::create};

}  // namespace catena::render
