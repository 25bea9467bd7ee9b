// SPDX-License-Identifier: MIT
#include <algorithm>
#include <map>

#include "render/passes/passes.h"
#include "render/raycast/grid_bindings.h"
#include "render/vk/commands.h"

namespace catena::render {
namespace {

constexpr std::uint32_t kSurfaceColorVertexShader[] = {
#include "spirv/fullscreen.vert.inc"
};
constexpr std::uint32_t kSurfaceColorFragmentShader[] = {
#include "spirv/surface_color.frag.inc"
};
constexpr std::uint32_t kIds = 27;

bool is_wanted(const IsosurfaceItem& item) { return item.opacity >= 1 && item.color_by && item.id != 0; }

class SurfaceColorPass final : public Pass {
 public:
  static Result<std::unique_ptr<Pass>> create(vk::Device& device) {
    auto self = std::make_unique<SurfaceColorPass>();
    CATENA_TRY(self->linear_, vk::Sampler::create(device, vk::Filter::linear));
    return std::unique_ptr<Pass>(std::move(self));
  }
  PassUse use(const Frame&) const override { return {target::opaque_depth | target::opaque_id, target::opaque_color}; }
  Outcome prepare(Frame& frame) override;
  Outcome record(vk::Commands& commands, Frame& frame) override;

 private:
  struct Surface {
    IsosurfaceItem item;
    std::shared_ptr<const ResidentGrid> resident;
    BrickMap map;  ///< of the isosurface's own grid
    ColorGrid colors;
    vk::Buffer uniform, table;
  };
  Result<const vk::Pipeline*> pipeline(vk::Device& device, std::uint32_t flags, const TransferLut& lut);

  vk::Sampler linear_;
  std::map<std::pair<std::uint32_t, std::uint32_t>, vk::Pipeline> pipelines_;
  std::vector<Surface> surfaces_;
};

Result<const vk::Pipeline*> SurfaceColorPass::pipeline(vk::Device& device, std::uint32_t flags, const TransferLut& lut) {
  vk::Pipeline& pipeline = pipelines_[{flags, table_flags(lut)}];
  if (!pipeline) {
    vk::GraphicsInfo info;
    info.vertex = kSurfaceColorVertexShader;
    info.fragment = kSurfaceColorFragmentShader;
    info.layout_bindings = {{0, vk::DescriptorKind::uniform},
                            {1, vk::DescriptorKind::buffer},
                            {2, vk::DescriptorKind::texture},
                            {kIds, vk::DescriptorKind::texture},
                            {vk::kSharedBinding, vk::DescriptorKind::sampled}};
    add_grid_layout(info.layout_bindings, 2);
    info.constants = {flags};
    add_table_flags(info.constants, lut);
    info.colors = {kOpaqueFormat};
    CATENA_TRY(pipeline, vk::Pipeline::create(device, info));
  }
  return &pipeline;
}

Outcome SurfaceColorPass::prepare(Frame& frame) {
  std::size_t count = 0;
  for (const IsosurfaceItem& item : frame.packet.isosurfaces) {
    if (!is_wanted(item)) continue;
    CATENA_TRY(auto resident, frame.resident_grid(*item.grid));
    CATENA_TRY(auto colors, frame.resident_grid(*item.color_by->grid));
    if (!resident->is_drawable || !colors->is_drawable) continue;
    if (count == surfaces_.size()) surfaces_.emplace_back();
    Surface& surface = surfaces_[count++];
    surface.item = item;
    if (surface.resident != resident) {
      surface.resident = std::move(resident);
      CATENA_TRY(surface.map,
                 make_brick_word_map(frame.device, *surface.resident, std::vector<std::uint8_t>(surface.resident->brick_ranges.size())));
    }
    CATENA_TRY(const bool fresh, surface.colors.update(frame.device, std::move(colors), *item.color_by));
    if (!fresh) continue;
    const std::vector<glm::vec4> words = surface.colors.lut.pack_for_shader();
    CATENA_TRY(surface.table, vk::upload_buffer(frame.device, std::as_bytes(std::span(words)), VK_BUFFER_USAGE_STORAGE_BUFFER_BIT));
  }
  while (surfaces_.size() > count) surfaces_.pop_back();
  return Done{};
}

Outcome SurfaceColorPass::record(vk::Commands& commands, Frame& frame) {
  for (Surface& surface : surfaces_) {
    const field::ScalarGrid* grid = surface.item.grid.get();
    const Color& base = surface.item.color;
    shared::FrameData data = frame.rays.frame_data();
    data.grids[0] = frame.rays.grid_data(*surface.resident, grid->mapping());
    data.grids[0].id = surface.item.id;
    data.grids[0].color = {base.r, base.g, base.b};
    data.grids[1] = color_data(frame.rays, surface.colors, 0);
    CATENA_CHECK(vk::write_uniform(frame.device, surface.uniform, data));
    const GridBinding bound[] = {{surface.resident, &surface.map, true, false}, surface.colors.binding()};
    CATENA_TRY(const vk::Pipeline* pipe, pipeline(frame.device, grid_flags(bound), surface.colors.lut));
    std::vector<vk::Binding> bindings{{0, vk::DescriptorKind::uniform, &surface.uniform, nullptr, nullptr},
                                      {1, vk::DescriptorKind::buffer, &surface.table, nullptr, nullptr},
                                      {2, vk::DescriptorKind::texture, nullptr, &frame.targets.opaque_depth, nullptr},
                                      {kIds, vk::DescriptorKind::texture, nullptr, &frame.targets.opaque_id, nullptr}};
    add_grid_bindings(bindings, bound, 2, linear_);
    const field::Field* const domain = grid;
    commands.set_scissor(covered_area({&domain, 1}, frame.rays.camera));
    commands.bind(*pipe, bindings);
    commands.draw_triangle();
  }
  return Done{};
}

}  // namespace

const PassEntry kSurfaceColorPass{
    "surface colours",
    [](const Frame& frame) { return std::any_of(frame.packet.isosurfaces.begin(), frame.packet.isosurfaces.end(), is_wanted); },
    SurfaceColorPass::create};

}  // namespace catena::render
