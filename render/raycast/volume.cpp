#include "render/raycast/volume.h"

#include <algorithm>

#include "render/mirror/voxel_block.h"
#include "render/vk/commands.h"

namespace catena::render {
namespace {

constexpr std::uint32_t kVolumeVertexShader[] = {
#include "spirv/screen.vert.inc"
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
#include "spirv/still_tiles.vert.inc"
};
constexpr std::uint32_t kLayers = 27;                         // bindings of their colours; those of their depths follow
constexpr std::uint32_t kChanged = kLayers + 2 * MAX_LAYERS;  // as in still_tiles.vert

/// Below this share of active bricks a ray asks the brick map before it samples; above, asking costs more than it saves.
constexpr double kSkipBelow = 0.95;

bool same(const TransferTable& a, const TransferTable& b) {
  return a.colors == b.colors && a.extinctions == b.extinctions && a.gradient_factors == b.gradient_factors && a.labels == b.labels &&
         a.linear_below == b.linear_below;
}

/// The colour and sigma of a volume follow from its value alone.
bool is_plain_where_its_value_is(const VolumeItem& item) { return !item.shade && !item.color_by && item.transfer.gradient_factors.empty(); }

}  // namespace

Result<VolumeRaycast> VolumeRaycast::create(vk::Device& device) {
  VolumeRaycast self;
  self.device_ = &device;
  CATENA_TRY(self.linear_, vk::Sampler::create(device, vk::Filter::linear));
  return self;
}

Result<const vk::Pipeline*> VolumeRaycast::pipeline(const Kind& kind) {
  vk::Pipeline& pipeline = pipelines_[kind];
  if (pipeline) return &pipeline;
  vk::GraphicsInfo info;
  info.vertex = kind.tiles ? vk::Spirv(kVolumeTilesShader) : vk::Spirv(kVolumeVertexShader);
  info.slots = {{0, vk::Resource::uniform}, {2, vk::Resource::texture}};
  if (kind.tiles) info.slots.push_back({kChanged, vk::Resource::texture});
  if (!kind.layers_alone()) info.slots.push_back({1, vk::Resource::buffer});
  add_grid_slots(info.slots, kind.grid_slots());
  if (kind.layers > 0)
    for (std::uint32_t i = 0; i < 2 * MAX_LAYERS; ++i) info.slots.push_back({kLayers + i, vk::Resource::texture});
  info.colors = {kVolumeFormat};
  if (kind.layers_alone()) {
    info.fragment = kVolumeLayersShader;
    info.constants = {kind.opaque, kind.layers};
  } else {
    const bool cubic = any_cubic(kind.flags);
    info.fragment = kind.single()     ? vk::Spirv(kVolumeFragmentShader)
                    : kind.layers > 0 ? cubic ? vk::Spirv(kVolumeBlendLayersCubicShader) : vk::Spirv(kVolumeBlendLayersShader)
                    : cubic ? vk::Spirv(kVolumeBlendCubicShader)
                                      : vk::Spirv(kVolumeBlendShader);
    info.constants = {kind.flags,       kind.opaque, kind.volumes, kind.surfaces, kind.layers,     kind.modes,
                      kind.color_grids, kind.jitter, kind.colors,  kind.fog,      kind.half_depth, kind.tables};
  }
  CATENA_TRY(pipeline, vk::Pipeline::create(*device_, info));
  return &pipeline;
}

Result<bool> VolumeRaycast::update_volume(Volume& volume, const Mirrored<VolumeItem>& next) {
  const bool plain = is_plain_where_its_value_is(*next.item);
  const bool fresh =
      volume.mirror != next.mirror || !same(volume.item.transfer, next.item->transfer) || plain != is_plain_where_its_value_is(volume.item);
  volume.item = *next.item;
  volume.mirror = next.mirror;
  if (!fresh) return false;
  volume.lut = make_transfer_lut(next.item->transfer, range_of(*next.mirror), next.item->grid->length(), some_values(*next.item->grid));
  volume.factors = next.item->transfer.gradient_factors.empty() ? TransferLut{} : make_factor_lut(next.item->transfer.gradient_factors);
  CATENA_TRY(volume.map, make_leap_map(*device_, *next.mirror, [&](const BrickRange& r) -> std::uint16_t {
               return plain ? volume.lut.look(r) : volume.lut.visible(r) ? 0 : 1;
             }));
  return true;
}

Result<bool> VolumeRaycast::update_colors(std::span<const Mirrored<VolumeItem>> volumes,
                                          std::span<const Mirrored<IsosurfaceItem>> surfaces) {
  std::size_t count = 0;
  bool changed = false;
  const auto update = [&](const auto& next, std::size_t owner) -> Outcome {
    if (!next.colors) return Done{};
    if (count == colors_.size()) colors_.emplace_back();
    Colors& colors = colors_[count++];
    CATENA_TRY(const bool fresh, colors.grid.update(*device_, next.colors, *next.item->color_by));
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
    volume.table_start = append(volume.lut.words());
    volume.factor_start = append(volume.factors.words());
  }
  for (Colors& colors : colors_) colors.table_start = append(colors.grid.lut.words());
  if (entries.empty()) entries.resize(2);
  CATENA_TRY(tables_, vk::upload_buffer(*device_, std::as_bytes(std::span(entries)), VK_BUFFER_USAGE_STORAGE_BUFFER_BIT));
  return Done{};
}

Outcome VolumeRaycast::prepare(std::span<const Mirrored<VolumeItem>> volumes, std::span<const Mirrored<IsosurfaceItem>> surfaces) {
  CATENA_ASSERT(volumes.size() <= MAX_VOLUMES && surfaces.size() <= MAX_SURFACES);
  bool changed = volumes.size() != volumes_.size() || !tables_;
  volumes_.resize(volumes.size());
  for (std::size_t i = 0; i < volumes.size(); ++i) {
    CATENA_TRY(const bool fresh, update_volume(volumes_[i], volumes[i]));
    changed = changed || fresh;
  }
  surfaces_.resize(surfaces.size());
  for (std::size_t i = 0; i < surfaces.size(); ++i) {
    looks_ += surfaces_[i].state.mirror != surfaces[i].mirror;
    CATENA_CHECK(surfaces_[i].state.update(*device_, *surfaces[i].item->grid, surfaces[i].mirror, surfaces[i].item->level));
    surfaces_[i].item = *surfaces[i].item;
  }
  CATENA_TRY(const bool recoloured, update_colors(volumes, surfaces));
  CATENA_ASSERT(volumes_.size() + surfaces_.size() + colors_.size() <= MAX_GRIDS);
  if (!changed && !recoloured) return Done{};
  ++looks_;
  return upload_tables();
}

shared::GridData VolumeRaycast::volume_data(const CameraRays& rays, const Volume& volume) const {
  shared::GridData grid = rays.grid(*volume.mirror, volume.item.grid->mapping());
  grid.id = volume.item.id;
  grid.clipped = volume.item.clipped;
  grid.look = table_data(volume.lut, volume.table_start);
  if (!volume.factors.entries.empty()) grid.factors = table_data(volume.factors, volume.factor_start);
  return grid;
}

std::vector<vk::Binding> VolumeRaycast::bindings(const Kind& kind, std::span<const BoundGrid> bound, const RayScene& scene) {
  std::vector<vk::Binding> list{{0, vk::Resource::uniform, &uniform_, nullptr, nullptr},
                                {2, vk::Resource::texture, nullptr, scene.opaque_depth ? scene.opaque_depth : scene.none, nullptr}};
  if (!kind.layers_alone()) list.push_back({1, vk::Resource::buffer, &tables_, nullptr, nullptr});
  add_grid_bindings(list, bound, kind.grid_slots(), linear_);
  if (kind.tiles) list.push_back({kChanged, vk::Resource::texture, nullptr, &eye().opaque->changed(), nullptr});
  if (kind.layers == 0) return list;
  for (std::uint32_t i = 0; i < MAX_LAYERS; ++i) {
    const Layer& layer = scene.layers[std::min<std::size_t>(i, scene.layers.size() - 1)];
    list.push_back({kLayers + i, vk::Resource::texture, nullptr, layer.color, nullptr});
    list.push_back({kLayers + MAX_LAYERS + i, vk::Resource::texture, nullptr, layer.depth, nullptr});
  }
  return list;
}

VolumeRaycast::Ready VolumeRaycast::ready(const CameraRays& rays, const RaySettings& settings, const RayScene& scene) const {
  // volumes, surfaces, the grids that colour them
  Ready out{{.opaque = scene.opaque_depth != nullptr,
             .volumes = std::uint32_t(volumes_.size()),
             .surfaces = std::uint32_t(surfaces_.size()),
             .layers = std::uint32_t(scene.layers.size()),
             .jitter = settings.jitter,
             .colors = std::uint32_t(colors_.size()),
             .fog = rays.fog && rays.fog->most > 0},
            rays.frame(),
            {}};
  shared::FrameData& data = out.frame;
  std::vector<BoundGrid>& bound = out.grids;
  Kind& kind = out.kind;
  data.termination = float(settings.termination);
  double edge = 0;
  for (const Volume& volume : volumes_) {
    data.grids[bound.size()] = volume_data(rays, volume);
    if (!volume.factors.entries.empty()) kind.modes |= 1u << (2 * bound.size());
    kind.tables |= table_flags(volume.lut) | table_flags(volume.factors);
    const double own = volume.item.grid->mapping().smallest_edge();
    edge = edge > 0 ? std::min(edge, own) : own;
    const bool skips = settings.skip && double(volume.map.active) < kSkipBelow * double(volume.map.total);
    bound.push_back({volume.mirror, &volume.map, volume.item.shade, skips});
  }
  for (const Surface& surface : surfaces_) {
    data.grids[bound.size()] = surface_data(rays, surface.state, surface.item);
    bound.push_back(surface.state.bound());
  }
  for (const Colors& colors : colors_) {
    kind.modes |= 2u << (2 * colors.owner);
    kind.color_grids |= std::uint32_t(bound.size()) << (4 * colors.owner);
    data.grids[bound.size()] = color_data(rays, colors.grid, colors.table_start);
    kind.tables |= table_flags(colors.grid.lut);
    bound.push_back(colors.grid.bound());
  }
  data.step_world = float(settings.step_voxels * edge);
  kind.flags = grid_flags(bound);
  return out;
}

Outcome VolumeRaycast::draw(vk::Commands& commands, const Ready& ready, const VkRect2D& area, const RayScene& scene) {
  CATENA_CHECK(vk::write_uniform(*device_, uniform_, ready.frame));
  CATENA_TRY(const vk::Pipeline* pipe, pipeline(ready.kind));
  commands.scissor(area);
  commands.bind(*pipe, bindings(ready.kind, ready.grids, scene));
  if (!ready.kind.tiles) {
    commands.draw_triangle();
    return Done{};
  }
  const VkExtent3D& tiles = eye().opaque->changed().info().extent;
  commands.draw(6, tiles.width * tiles.height);
  return Done{};
}

Outcome VolumeRaycast::record(vk::Commands& commands, const CameraRays& rays, const RaySettings& settings, const VkRect2D& area,
                              const RayScene& scene) {
  return draw(commands, ready(rays, settings, scene), area, scene);
}

Outcome VolumeRaycast::record_half_depth(vk::Commands& commands, const CameraRays& rays, const RaySettings& settings, const VkRect2D& area,
                                         const RayScene& scene) {
  Ready found = ready(rays, settings, scene);
  found.kind.half_depth = true;
  found.kind.fog = found.kind.jitter = 0;  // no colour, no grain
  return draw(commands, found, area, scene);
}

Outcome VolumeRaycast::record_into(vk::Commands& commands, const CameraRays& rays, const RaySettings& settings, const VkRect2D& area,
                                   const RayScene& scene, vk::Image& target, bool keep) {
  Ready now = ready(rays, settings, scene);
  Eye& own = eye();
  const Kept next{now.kind, {now.frame, looks_, scene.layers_version, &target, target.handle(), area, scene.opaque_depth != nullptr}};
  const bool still = has_kept_ = keep && own.kept && own.kept->kind == next.kind && own.kept->picture.is(next.picture);
  own.kept.reset();
  if (scene.opaque_depth) {
    if (!own.opaque) own.opaque.emplace(*device_);
    CATENA_CHECK(own.opaque->look(commands, *scene.opaque_depth));
    if (still) CATENA_CHECK(own.opaque->find_changed(commands, 0));
  }
  if (!still || scene.opaque_depth) {
    now.kind.tiles = still;
    vk::ColorTarget color{&target, std::array<float, 4>{0, 0, 0, 0}};
    if (still) color.clear.reset();
    commands.begin_pass({&color, 1}, {});
    CATENA_CHECK(draw(commands, now, area, scene));
    commands.end_pass();
  }
  own.kept = next;
  return Done{};
}

}  // namespace catena::render
