// SPDX-License-Identifier: MIT
#include "render/raycast/volume.h"

#include <algorithm>

#include "render/residency/voxel_block.h"
#include "render/vk/commands.h"

namespace catena::render {
namespace {

constexpr std::uint32_t kVolumeVertexShader[] = {
#include "spirv/fullscreen.vert.inc"
};
constexpr std::uint32_t kVolumeFragmentShader[] = {
#include "spirv/volume.frag.inc"
};
constexpr std::uint32_t kVolumeBlendShader[] = {
#include "spirv/blend.frag.inc"
};
constexpr std::uint32_t kVolumeBlendCubicShader[] = {
#include "spirv/blend_cubic.frag.inc"
};
constexpr std::uint32_t kVolumeBlendLayersShader[] = {
#include "spirv/blend_layers.frag.inc"
};
constexpr std::uint32_t kVolumeBlendLayersCubicShader[] = {
#include "spirv/blend_layers_cubic.frag.inc"
};
constexpr std::uint32_t kVolumeLayersShader[] = {
#include "spirv/layers.frag.inc"
};
constexpr std::uint32_t kVolumeTilesShader[] = {
#include "spirv/dirty_tile_quads.vert.inc"
};
constexpr std::uint32_t kLayers = 27;                         // first binding of the layers' colors; their depths follow
constexpr std::uint32_t kChanged = kLayers + 2 * MAX_LAYERS;  // as in dirty_tile_quads.vert

/// Share of active bricks below which a ray reads the brick map before it samples; above, reading costs more than it saves.
constexpr double kSkipBelow = 0.95;

bool same(const TransferTable& a, const TransferTable& b) {
  return a.colors == b.colors && a.extinctions == b.extinctions && a.gradient_factors == b.gradient_factors &&
         a.is_categorical == b.is_categorical && a.linear_below == b.linear_below;
}

/// Returns whether color and extinction depend on the value alone.
bool is_plain_where_its_value_is(const VolumeItem& item) {
  return !item.is_shaded && !item.color_by && item.transfer.gradient_factors.empty();
}

}  // namespace

Result<VolumeRaycast> VolumeRaycast::create(vk::Device& device) {
  VolumeRaycast self;
  self.device_ = &device;
  CATENA_TRY(self.linear_, vk::Sampler::create(device, vk::Filter::linear));
  return self;
}

Result<const vk::Pipeline*> VolumeRaycast::pipeline(const PipelineKey& kind) {
  vk::Pipeline& pipeline = pipelines_[kind];
  if (pipeline) return &pipeline;
  vk::GraphicsInfo info;
  info.vertex = kind.dirty_only ? vk::Spirv(kVolumeTilesShader) : vk::Spirv(kVolumeVertexShader);
  info.layout_bindings = {
      {0, vk::DescriptorKind::uniform}, {2, vk::DescriptorKind::texture}, {vk::kSharedBinding, vk::DescriptorKind::sampled}};
  if (kind.dirty_only) info.layout_bindings.push_back({kChanged, vk::DescriptorKind::texture});
  if (!kind.is_layers_only()) info.layout_bindings.push_back({1, vk::DescriptorKind::buffer});
  add_grid_layout(info.layout_bindings, kind.grid_slots());
  if (kind.layers > 0)
    for (std::uint32_t i = 0; i < 2 * MAX_LAYERS; ++i) info.layout_bindings.push_back({kLayers + i, vk::DescriptorKind::texture});
  info.colors = {kVolumeFormat};
  if (kind.is_layers_only()) {
    info.fragment = kVolumeLayersShader;
    info.constants = {kind.has_opaque, kind.layers};
  } else {
    const bool cubic = has_cubic_grid(kind.flags);
    info.fragment = kind.is_single_volume() ? vk::Spirv(kVolumeFragmentShader)
                    : kind.layers > 0       ? cubic ? vk::Spirv(kVolumeBlendLayersCubicShader) : vk::Spirv(kVolumeBlendLayersShader)
                          : cubic ? vk::Spirv(kVolumeBlendCubicShader)
                                            : vk::Spirv(kVolumeBlendShader);
    info.constants = {kind.flags,  kind.has_opaque, kind.volumes, kind.surfaces,           kind.layers, kind.modes, kind.color_grids,
                      kind.jitter, kind.colors,     kind.fog,     kind.half_opacity_depth, kind.tables};
  }
  CATENA_TRY(pipeline, vk::Pipeline::create(*device_, info));
  return &pipeline;
}

Result<bool> VolumeRaycast::update_volume(Volume& volume, const ResidentItem<VolumeItem>& next) {
  const bool plain = is_plain_where_its_value_is(*next.item);
  const bool fresh = volume.resident != next.resident || !same(volume.item.transfer, next.item->transfer) ||
                     plain != is_plain_where_its_value_is(volume.item);
  volume.item = *next.item;
  volume.resident = next.resident;
  if (!fresh) return false;
  volume.lut = make_transfer_lut(next.item->transfer, value_range(*next.resident), next.item->grid->domain_length(),
                                 sample_values(*next.item->grid));
  volume.factors =
      next.item->transfer.gradient_factors.empty() ? TransferLut{} : make_gradient_factor_lut(next.item->transfer.gradient_factors);
  CATENA_TRY(volume.map, make_skip_map(*device_, *next.resident, [&](const BrickRange& r) -> std::uint16_t {
               return plain ? volume.lut.appearance(r) : volume.lut.any_visible(r) ? 0 : 1;
             }));
  return true;
}

Result<bool> VolumeRaycast::update_colors(std::span<const ResidentItem<VolumeItem>> volumes,
                                          std::span<const ResidentItem<IsosurfaceItem>> surfaces) {
  std::size_t count = 0;
  bool changed = false;
  const auto update = [&](const auto& next, std::size_t owner) -> Outcome {
    if (!next.color_grid) return Done{};
    if (count == colors_.size()) colors_.emplace_back();
    ColorGridUse& colors = colors_[count++];
    CATENA_TRY(const bool fresh, colors.grid.update(*device_, next.color_grid, *next.item->color_by));
    changed = changed || fresh || colors.owner != owner;
    colors.owner = owner;
    return Done{};
  };
  for (std::size_t i = 0; i < volumes.size(); ++i) CATENA_CHECK(update(volumes[i], i));
  for (std::size_t i = 0; i < surfaces.size(); ++i) CATENA_CHECK(update(surfaces[i], volumes.size() + i));
  changed = changed || count != colors_.size();
  while (colors_.size() > count) colors_.pop_back();
  return changed;
}

Outcome VolumeRaycast::upload_tables() {
  std::vector<glm::vec4> entries;
  const auto append = [&](const std::vector<glm::vec4>& more) {
    const auto start = std::uint32_t(entries.size());
    entries.insert(entries.end(), more.begin(), more.end());
    return start;
  };
  for (Volume& volume : volumes_) {
    volume.table_start = append(volume.lut.pack_for_shader());
    volume.factor_start = append(volume.factors.pack_for_shader());
  }
  for (ColorGridUse& colors : colors_) colors.table_start = append(colors.grid.lut.pack_for_shader());
  if (entries.empty()) entries.resize(2);
  CATENA_TRY(tables_, vk::upload_buffer(*device_, std::as_bytes(std::span(entries)), VK_BUFFER_USAGE_STORAGE_BUFFER_BIT));
  return Done{};
}

Outcome VolumeRaycast::prepare(std::span<const ResidentItem<VolumeItem>> volumes, std::span<const ResidentItem<IsosurfaceItem>> surfaces) {
  CATENA_ASSERT(volumes.size() <= MAX_VOLUMES && surfaces.size() <= MAX_SURFACES);
  bool changed = volumes.size() != volumes_.size() || !tables_;
  volumes_.resize(volumes.size());
  for (std::size_t i = 0; i < volumes.size(); ++i) {
    CATENA_TRY(const bool fresh, update_volume(volumes_[i], volumes[i]));
    changed = changed || fresh;
  }
  surfaces_.resize(surfaces.size());
  for (std::size_t i = 0; i < surfaces.size(); ++i) {
    appearance_version_ += surfaces_[i].state.resident != surfaces[i].resident;
    CATENA_CHECK(surfaces_[i].state.update(*device_, *surfaces[i].item->grid, surfaces[i].resident, surfaces[i].item->level));
    surfaces_[i].item = *surfaces[i].item;
  }
  CATENA_TRY(const bool recoloured, update_colors(volumes, surfaces));
  CATENA_ASSERT(volumes_.size() + surfaces_.size() + colors_.size() <= MAX_GRIDS);
  if (!changed && !recoloured) return Done{};
  ++appearance_version_;
  return upload_tables();
}

shared::GridData VolumeRaycast::volume_data(const CameraRays& rays, const Volume& volume) const {
  shared::GridData grid = rays.grid_data(*volume.resident, volume.item.grid->mapping());
  grid.id = volume.item.id;
  grid.is_clipped = volume.item.is_clipped;
  set_scattering(volume.item.scattering, grid);
  grid.value_table = table_data(volume.lut, volume.table_start);
  if (!volume.factors.entries.empty()) grid.gradient_table = table_data(volume.factors, volume.factor_start);
  return grid;
}

std::vector<vk::Binding> VolumeRaycast::bindings(const PipelineKey& kind, std::span<const GridBinding> bound, const RayScene& scene) {
  std::vector<vk::Binding> list{
      {0, vk::DescriptorKind::uniform, &uniform_, nullptr, nullptr},
      {2, vk::DescriptorKind::texture, nullptr, scene.opaque_depth ? scene.opaque_depth : scene.placeholder, nullptr}};
  if (!kind.is_layers_only()) list.push_back({1, vk::DescriptorKind::buffer, &tables_, nullptr, nullptr});
  add_grid_bindings(list, bound, kind.grid_slots(), linear_);
  if (kind.dirty_only) list.push_back({kChanged, vk::DescriptorKind::texture, nullptr, &eye_state().opaque_tiles->dirty_tiles(), nullptr});
  if (kind.layers == 0) return list;
  for (std::uint32_t i = 0; i < MAX_LAYERS; ++i) {
    const Layer& layer = scene.layers[std::min<std::size_t>(i, scene.layers.size() - 1)];
    list.push_back({kLayers + i, vk::DescriptorKind::texture, nullptr, layer.color, nullptr});
    list.push_back({kLayers + MAX_LAYERS + i, vk::DescriptorKind::texture, nullptr, layer.depth, nullptr});
  }
  return list;
}

VolumeRaycast::DrawState VolumeRaycast::make_draw_state(const CameraRays& rays, const RaySettings& settings, const RayScene& scene) const {
  // volumes, surfaces, grids that color them
  DrawState out{{.has_opaque = scene.opaque_depth != nullptr,
                 .volumes = std::uint32_t(volumes_.size()),
                 .surfaces = std::uint32_t(surfaces_.size()),
                 .layers = std::uint32_t(scene.layers.size()),
                 .jitter = settings.jitter,
                 .colors = std::uint32_t(colors_.size()),
                 .fog = rays.fog && rays.fog->max_opacity > 0},
                rays.frame_data(),
                {}};
  shared::FrameData& data = out.frame;
  std::vector<GridBinding>& bound = out.grids;
  PipelineKey& kind = out.key;
  data.termination = float(settings.termination);
  double edge = 0;
  for (const Volume& volume : volumes_) {
    data.grids[bound.size()] = volume_data(rays, volume);
    if (!volume.factors.entries.empty()) kind.modes |= 1u << (2 * bound.size());
    kind.tables |= table_flags(volume.lut) | table_flags(volume.factors);
    const double voxel_edge = volume.item.grid->mapping().min_voxel_edge();
    edge = edge > 0 ? std::min(edge, voxel_edge) : voxel_edge;
    const bool skips = settings.skip_empty && double(volume.map.active_count) < kSkipBelow * double(volume.map.total_count);
    bound.push_back({volume.resident, &volume.map, volume.item.is_shaded, skips});
  }
  for (const Surface& surface : surfaces_) {
    data.grids[bound.size()] = surface_data(rays, surface.state, surface.item);
    bound.push_back(surface.state.binding());
  }
  for (const ColorGridUse& colors : colors_) {
    kind.modes |= 2u << (2 * colors.owner);
    kind.color_grids |= std::uint32_t(bound.size()) << (4 * colors.owner);
    data.grids[bound.size()] = color_data(rays, colors.grid, colors.table_start);
    kind.tables |= table_flags(colors.grid.lut);
    bound.push_back(colors.grid.binding());
  }
  data.step_world = float(settings.step_voxels * edge);
  kind.flags = grid_flags(bound);
  return out;
}

Outcome VolumeRaycast::draw(vk::Commands& commands, const DrawState& ready, const VkRect2D& area, const RayScene& scene) {
  CATENA_CHECK(vk::write_uniform(*device_, uniform_, ready.frame));
  CATENA_TRY(const vk::Pipeline* pipe, pipeline(ready.key));
  commands.set_scissor(area);
  commands.bind(*pipe, bindings(ready.key, ready.grids, scene));
  if (!ready.key.dirty_only) {
    commands.draw_triangle();
    return Done{};
  }
  const VkExtent3D& tiles = eye_state().opaque_tiles->dirty_tiles().info().extent;
  commands.draw(6, tiles.width * tiles.height);
  return Done{};
}

Outcome VolumeRaycast::record(vk::Commands& commands, const CameraRays& rays, const RaySettings& settings, const VkRect2D& area,
                              const RayScene& scene) {
  return draw(commands, make_draw_state(rays, settings, scene), area, scene);
}

Outcome VolumeRaycast::record_half_opacity_depth(vk::Commands& commands, const CameraRays& rays, const RaySettings& settings,
                                                 const VkRect2D& area, const RayScene& scene) {
  DrawState found = make_draw_state(rays, settings, scene);
  found.key.half_opacity_depth = true;
  found.key.fog = found.key.jitter = 0;  // depth has no color and no noise
  return draw(commands, found, area, scene);
}

Outcome VolumeRaycast::record_into(vk::Commands& commands, const CameraRays& rays, const RaySettings& settings, const VkRect2D& area,
                                   const RayScene& scene, vk::Image& target, bool keep) {
  DrawState now = make_draw_state(rays, settings, scene);
  EyeState& eye = eye_state();
  const ReuseState next{
      now.key, {now.frame, appearance_version_, scene.layers_version, &target, target.handle(), area, scene.opaque_depth != nullptr}};
  const bool reuses = reused_previous_ = keep && eye.reuse && eye.reuse->key == next.key && eye.reuse->state.matches(next.state);
  eye.reuse.reset();
  if (scene.opaque_depth) {
    if (!eye.opaque_tiles) eye.opaque_tiles.emplace(*device_);
    CATENA_CHECK(eye.opaque_tiles->analyze(commands, *scene.opaque_depth));
    if (reuses) CATENA_CHECK(eye.opaque_tiles->find_dirty(commands, 0));
  }
  if (!reuses || scene.opaque_depth) {
    now.key.dirty_only = reuses;
    vk::ColorTarget color{&target, std::array<float, 4>{0, 0, 0, 0}};
    if (reuses) color.clear.reset();
    commands.begin_pass({&color, 1}, {});
    CATENA_CHECK(draw(commands, now, area, scene));
    commands.end_pass();
  }
  eye.reuse = next;
  return Done{};
}

}  // namespace catena::render
