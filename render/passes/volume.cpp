#include "render/passes/volume.h"

#include <algorithm>

#include "render/passes/targets.h"
#include "render/vk/upload.h"

namespace catena::render {
namespace {

constexpr std::uint32_t kVertexShader[] = {
#include "spirv/screen.vert.inc"
};
constexpr std::uint32_t kFragmentShader[] = {
#include "spirv/volume.frag.inc"
};
constexpr std::uint32_t kBlendShader[] = {
#include "spirv/blend.frag.inc"
};

/// Below this share of active bricks a ray asks the brick map before it samples; above, asking costs more than it saves.
constexpr double kSkipBelow = 0.95;

BrickRange range_of(const GridMirror& mirror) {
  BrickRange all;
  for (const BrickRange& r : mirror.ranges) {
    if (r.empty()) continue;
    all = all.empty() ? r : BrickRange{std::min(all.least, r.least), std::max(all.greatest, r.greatest)};
  }
  return all.empty() ? BrickRange{0, 0} : all;
}

bool same(const TransferTable& a, const TransferTable& b) { return a.colors == b.colors && a.extinctions == b.extinctions; }

}  // namespace

Result<VolumePass> VolumePass::create(vk::Device& device) {
  VolumePass self;
  self.device_ = &device;
  CATENA_TRY(self.linear_, vk::Sampler::create(device, vk::Filter::linear));
  return self;
}

Result<const vk::Pipeline*> VolumePass::pipeline(std::uint32_t flags, std::uint32_t volumes, std::uint32_t surfaces, bool opaque) {
  vk::Pipeline& pipeline = pipelines_[{flags, volumes, surfaces, opaque}];
  if (!pipeline) {
    vk::GraphicsInfo info;
    info.vertex = kVertexShader;
    const bool single = volumes == 1 && surfaces == 0;
    info.fragment = single ? vk::Spirv(kFragmentShader) : vk::Spirv(kBlendShader);
    info.slots = {{0, vk::Resource::uniform}, {1, vk::Resource::buffer}, {2, vk::Resource::texture}};
    add_grid_slots(info.slots, single ? 1 : MAX_GRIDS);
    info.constants = single ? std::vector<std::uint32_t>{flags, opaque} : std::vector<std::uint32_t>{flags, opaque, volumes, surfaces};
    info.colors = {kVolumeFormat};
    CATENA_TRY(pipeline, vk::Pipeline::create(*device_, info));
  }
  return &pipeline;
}

Outcome VolumePass::prepare(std::span<const Mirrored<VolumeItem>> volumes, std::span<const Mirrored<IsosurfaceItem>> surfaces) {
  CATENA_ASSERT(volumes.size() <= MAX_VOLUMES && surfaces.size() <= MAX_SURFACES);

  // tables and brick maps of what is new
  bool changed = volumes.size() != volumes_.size() || !tables_;
  volumes_.resize(volumes.size());
  for (std::size_t i = 0; i < volumes.size(); ++i) {
    Volume& volume = volumes_[i];
    const auto& [item, mirror] = volumes[i];
    const bool fresh = volume.mirror != mirror || !same(volume.item.transfer, item->transfer);
    volume.item = *item;
    volume.mirror = mirror;
    if (!fresh) continue;
    changed = true;
    volume.lut = make_transfer_lut(item->transfer, range_of(*mirror));
    CATENA_TRY(volume.map, make_brick_map(*device_, *mirror, [&volume](const BrickRange& r) { return volume.lut.visible(r); }));
  }
  if (changed) {
    std::vector<glm::vec4> entries;
    for (Volume& volume : volumes_) {
      volume.table_start = std::uint32_t(entries.size());
      entries.insert(entries.end(), volume.lut.entries.begin(), volume.lut.entries.end());
    }
    if (entries.empty()) entries.resize(2);
    CATENA_TRY(tables_, vk::upload_buffer(*device_, std::as_bytes(std::span(entries)), VK_BUFFER_USAGE_STORAGE_BUFFER_BIT));
  }
  surfaces_.resize(surfaces.size());
  for (std::size_t i = 0; i < surfaces.size(); ++i) {
    CATENA_CHECK(surfaces_[i].state.update(*device_, surfaces[i].second, surfaces[i].first->level));
    surfaces_[i].item = *surfaces[i].first;
  }
  return Done{};
}

Outcome VolumePass::record(vk::Commands& commands, const CameraRays& rays, const RaySettings& settings, const VkRect2D& area,
                           const vk::Image* opaque_depth, const vk::Image& none) {
  // the frame's data
  shared::FrameData data = rays.frame();
  data.termination = float(settings.termination);
  std::vector<BoundGrid> bound;
  double edge = 0;
  for (const Volume& volume : volumes_) {
    shared::GridData& grid = data.grids[bound.size()];
    grid = rays.grid(*volume.mirror, volume.item.grid->mapping());
    grid.id = volume.item.id;
    grid.clipped = volume.item.clipped;
    grid.table_start = volume.table_start;
    grid.table_last = volume.lut.last();
    grid.table_lo = volume.lut.lo;
    grid.table_per_value = volume.lut.per_value;
    const double own = volume.item.grid->mapping().smallest_edge();
    edge = edge > 0 ? std::min(edge, own) : own;
    const bool skips = settings.skip && double(volume.map.active) < kSkipBelow * double(volume.map.total);
    bound.push_back({volume.mirror, &volume.map, volume.item.shade, skips});
  }
  for (const Surface& surface : surfaces_) {
    data.grids[bound.size()] = surface_data(rays, surface.state, surface.item);
    bound.push_back(surface.state.bound());
  }
  data.step_world = float(settings.step_voxels * edge);
  CATENA_CHECK(write_uniform(*device_, uniform_, data));

  // draw
  std::uint32_t flags = 0;
  for (std::size_t i = 0; i < bound.size(); ++i) flags |= bound[i].flags() << (4 * i);
  CATENA_TRY(const vk::Pipeline* pipe,
             pipeline(flags, std::uint32_t(volumes_.size()), std::uint32_t(surfaces_.size()), opaque_depth != nullptr));
  std::vector<vk::Binding> bindings{{0, vk::Resource::uniform, &uniform_, nullptr, nullptr},
                                    {1, vk::Resource::buffer, &tables_, nullptr, nullptr},
                                    {2, vk::Resource::texture, nullptr, opaque_depth ? opaque_depth : &none, nullptr}};
  add_grid_bindings(bindings, bound, bound.size() == 1 && surfaces_.empty() ? 1 : MAX_GRIDS, linear_);
  commands.scissor(area);
  commands.bind(*pipe, bindings);
  commands.draw_triangle();
  return Done{};
}

}  // namespace catena::render
