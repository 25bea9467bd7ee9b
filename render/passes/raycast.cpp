// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <ranges>

#include "engine/field/bricks/paged_grid.h"
#include "render/passes/passes.h"
#include "render/passes/renderer.h"
#include "render/passes/slice.h"
#include "render/raycast/fast_volume.h"
#include "render/raycast/paged_projection.h"
#include "render/raycast/projection.h"
#include "render/raycast/volume.h"

namespace catena::render {
namespace {

bool is_translucent(const IsosurfaceItem& item) { return item.opacity > 0 && item.opacity < 1; }

/// Returns the number of translucent isosurfaces, which the volume rays pass through.
std::size_t surfaces_of(const FramePacket& packet) {
  return std::size_t(std::ranges::count_if(packet.isosurfaces, [](const IsosurfaceItem& item) { return is_translucent(item); }));
}

bool is_projected(const VolumeItem& item) { return item.projection != Projection::composite; }

/// Returns whether the volumes are paged, with the same pages, and cut alike.
bool are_channels(const FramePacket& packet) {
  if (packet.volumes.empty() || packet.volumes.size() > kMaxChannels) return false;
  const VolumeItem& first = packet.volumes.front();
  return std::ranges::all_of(packet.volumes, [&](const VolumeItem& item) {
    return first.paged && item.paged && item.is_clipped == first.is_clipped && have_same_pages(*first.paged, *item.paged);
  });
}

RaySettings ray_settings(const Frame& frame) {
  const RenderSettings& s = frame.settings;
  return {s.step_voxels, s.termination, s.skip_empty, frame.packet.jitter.value_or(s.jitter)};
}

RayScene ray_scene(const Frame& frame) {
  return {frame.has(target::opaque_depth) ? &frame.targets.opaque_depth : nullptr, frame.layers, frame.layers_version,
          &frame.targets.placeholder};
}

/// Returns settings of the fast raycast whose rays are those of the exact raycast, as far as codes permit: every pixel, the same step.
FastSettings exact_rays(const RenderSettings& settings) {
  FastSettings fast;
  fast.step_voxels = settings.step_voxels;
  fast.termination = settings.termination;
  fast.skip_empty = settings.skip_empty;
  fast.smooth_gradients = true;
  return fast;
}

/// Error: too many volumes, surfaces or layers, or a projection together with other translucent items.
Outcome check(const FramePacket& packet, std::size_t layers, std::size_t volumes, std::size_t surfaces, std::size_t colors) {
  const std::size_t grids = volumes + surfaces + colors;
  if (volumes > MAX_VOLUMES) return Error{fmt::format("the scene has {} volumes, expected at most {}", volumes, MAX_VOLUMES)};
  if (surfaces > MAX_SURFACES)
    return Error{fmt::format("the scene has {} translucent isosurfaces, expected at most {}", surfaces, MAX_SURFACES)};
  if (layers > MAX_LAYERS) return Error{fmt::format("the scene has {} translucent layers, expected at most {}", layers, MAX_LAYERS)};
  const std::size_t most = layers == 0 ? MAX_GRIDS : MAX_GRIDS_WITH_LAYERS;
  if (grids > most)
    return Error{
        fmt::format("the scene has {} volumes, translucent isosurfaces and fields that colour them{}, expected at most {} together", grids,
                    layers == 0 ? "" : " beside translucent triangles", most)};
  const auto& items = packet.volumes;
  if (volumes + surfaces + layers > 1 && std::any_of(items.begin(), items.end(), is_projected))
    return Error{
        "a volume with a projection (maximum, minimum, average) stands beside another volume or something translucent, expected alone "
        "over opaque things"};
  return Done{};
}

class RaycastPass final : public Pass, public RaySampler {
 public:
  static Result<std::unique_ptr<Pass>> create(vk::Device& device);
  PassUse use(const Frame& frame) const override;
  Outcome prepare(Frame& frame) override;
  Bounds bounds() const override;
  Outcome record(vk::Commands& commands, Frame& frame) override;
  double build_ms() const override { return fast_pass_ ? fast_pass_->build_ms() : 0; }
  std::uint64_t grid_bytes() const override { return fast_pass_ ? fast_pass_->grid_bytes() : 0; }
  std::string warning() const override { return wanted_fast_ && !fast_ ? refused_.reason : coarse_.warning(); }

  RaySampler* ray_sampler() override { return this; }
  Outcome record_ray_samples(vk::Commands& commands, Frame& frame, std::uint32_t spacing, vk::Image& target) override;
  Outcome record_half_opacity_depth(vk::Commands& commands, Frame& frame, std::uint32_t spacing, vk::Image& target,
                                    const VkRect2D& area) override;
  bool has_half_opacity_depth() const override { return fast_ || (any_ && !projected_ && exact_pass_->has_half_opacity_depth()); }
  bool skips_empty_space() const override { return fast_ && fast_pass_->skips_empty_space(); }
  bool reused_previous() const override {
    return fast_ ? fast_pass_->reused_previous() : any_ && !projected_ && exact_pass_->reused_previous();
  }
  vk::Image* dirty_tiles() override {
    if (!reused_previous()) return nullptr;
    return fast_ ? fast_pass_->dirty_tiles() : exact_pass_->dirty_tiles();
  }
  std::array<vk::Image*, 2> marked_blocks() override { return fast_ ? fast_pass_->marked_blocks() : std::array<vk::Image*, 2>{}; }
  std::vector<PagedVolume*> pages() override {
    if (projects_pages_) return {&paged_projection_->pages()};
    return fast_ && fast_pass_->pages() ? std::vector<PagedVolume*>{fast_pass_->pages()} : std::vector<PagedVolume*>{};
  }
  bool was_out_of_memory(const FramePacket& packet) const override {
    return !refused_.reason.empty() && !packet.volumes.empty() && packet.volumes.front().grid->version() == refused_.version;
  }

 private:
  RaycastPass() = default;
  bool ends_at_half(const Frame& frame) const;
  /// A grid for which the fast raycast had too little memory; retried with another grid or other settings.
  struct Refused {
    std::uint64_t version = 0, permitted_bytes = 0;
    bool gradients = false;
    std::string reason;
  };
  bool prepare_fast(Frame& frame);
  /// Returns false if the memory does not suffice, or there is no projected volume in pages.
  bool prepare_paged_projection(Frame& frame);
  /// Draws the volumes or the projected volume into the current rendering scope.
  Outcome record_exact(vk::Commands& commands, Frame& frame, const CameraRays& rays, const VkRect2D& area);

  std::optional<VolumeRaycast> exact_pass_;
  std::optional<ProjectionRaycast> projection_pass_;
  std::optional<PagedProjection> paged_projection_;
  std::optional<FastVolumeRaycast> fast_pass_;
  const VolumeItem* fast_ = nullptr;  ///< the frame's first volume, if the fast raycast draws the volumes
  FastSettings fast_settings_;        ///< of the last frame that wanted the fast raycast
  Refused refused_;
  CoarseGrids coarse_;
  bool wanted_fast_ = false;
  bool any_ = false, projected_ = false, projects_pages_ = false;
  std::vector<const field::Field*> grids_;
};

Result<std::unique_ptr<Pass>> RaycastPass::create(vk::Device&) { return std::unique_ptr<Pass>(new RaycastPass); }

bool RaycastPass::ends_at_half(const Frame& frame) const {
  return fast_ && fast_settings_.ends_at_half_resolution() && !frame.settings.float_image && !frame.has(target::opaque_depth);
}

PassUse RaycastPass::use(const Frame& frame) const {
  const TargetSet reads = frame.has(target::opaque_depth) ? target::opaque_depth : 0;
  // layers are not targets: LayersPass::record() makes them readable
  return {reads, ends_at_half(frame) ? 0 : target::volume, true};
}

/// Returns false if the memory does not suffice; refused_ then holds the reason.
bool RaycastPass::prepare_fast(Frame& frame) {
  const VolumeItem& item = frame.packet.volumes.front();
  const FastSettings& settings = fast_settings_;
  const bool gradients = item.is_shaded && settings.smooth_gradients;
  const std::uint64_t version = item.grid->version();
  if (!refused_.reason.empty() && refused_.version == version && refused_.permitted_bytes == settings.max_bytes &&
      refused_.gradients == gradients)
    return false;
  refused_ = {version, settings.max_bytes, gradients, {}};
  Outcome prepared = Done{};
  if (!fast_pass_) {
    auto created = FastVolumeRaycast::create(frame.device);
    if (created)
      fast_pass_.emplace(std::move(*created));
    else
      prepared = created.error();
  }
  if (prepared && (item.paged || !can_pack_dense(frame.device, *item.grid))) {
    exact_pass_.reset();
    for (const VolumeItem& volume : frame.packet.volumes) frame.residency.drop_unused(*volume.grid);
  }
  if (prepared)
    prepared = fast_pass_->prepare(frame.packet.volumes, settings, frame.residency.available_bytes(), !frame.settings.waits_for_pages);
  if (prepared) return true;
  fast_pass_.reset();
  refused_.reason = fmt::format("the grid \"{}\" is drawn by exact rays, slower: {}", item.grid->name(), prepared.error().message);
  return false;
}

bool RaycastPass::prepare_paged_projection(Frame& frame) {
  const FramePacket& packet = frame.packet;
  const bool is_alone = packet.volumes.size() == 1 && surfaces_of(packet) == 0 && frame.layers.empty();
  const bool is_paged = is_alone && packet.volumes.front().paged && is_projected(packet.volumes.front()) &&
                        packet.volumes.front().grid->interpolation() == field::Interpolation::linear;
  if (is_paged) {
    if (!paged_projection_) paged_projection_.emplace(frame.device);
    std::uint64_t most = page_pool_bytes(frame.device, frame.residency.available_bytes(), 1);
    if (frame.settings.fast) most = std::min(most, frame.settings.fast->max_bytes);
    if (paged_projection_->prepare(packet.volumes.front(), most, !frame.settings.waits_for_pages)) return true;
  }
  paged_projection_.reset();
  return false;
}

Outcome RaycastPass::prepare(Frame& frame) {
  const FramePacket& packet = frame.packet;
  grids_.clear();
  coarse_.clear();
  const bool is_paged = !packet.volumes.empty() && packet.volumes.front().paged;
  projects_pages_ = false;
  wanted_fast_ = (frame.settings.fast || is_paged) && frame.layers.empty() && supports_fast_raycast(frame.device, packet);
  fast_settings_ = frame.settings.fast ? *frame.settings.fast : exact_rays(frame.settings);
  fast_ = wanted_fast_ && prepare_fast(frame) ? &packet.volumes.front() : nullptr;
  if (fast_) {
    if (fast_->paged)
      grids_.push_back(fast_->paged.get());
    else
      grids_.push_back(fast_->grid.get());
    return Done{};
  }
  if (fast_pass_ && fast_pass_->is_bricked()) fast_pass_.reset();
  projects_pages_ = prepare_paged_projection(frame);
  if (projects_pages_) {
    any_ = projected_ = true;
    grids_.push_back(packet.volumes.front().paged.get());
    return Done{};
  }

  std::vector<ResidentItem<VolumeItem>> volumes;
  std::vector<ResidentItem<IsosurfaceItem>> surfaces;
  std::size_t colors = 0;
  const auto add_item = [&](const auto& item, auto& list) -> Outcome {
    CATENA_TRY(auto grid, frame.resident_grid(*item.grid));
    if (!grid->is_drawable) return Done{};
    grids_.push_back(item.grid.get());
    if (item.paged) coarse_.add(item.grid->name());
    list.push_back({&item, std::move(grid), nullptr});
    if (!item.color_by) return Done{};
    CATENA_TRY(grid, frame.resident_grid(*item.color_by->grid));
    if (!grid->is_drawable) return Done{};
    list.back().color_grid = std::move(grid);
    ++colors;
    return Done{};
  };
  for (const VolumeItem& item : packet.volumes) CATENA_CHECK(add_item(item, volumes));
  for (const IsosurfaceItem& item : packet.isosurfaces)
    if (is_translucent(item)) CATENA_CHECK(add_item(item, surfaces));
  CATENA_CHECK(check(packet, frame.layers.size(), volumes.size(), surfaces.size(), colors));
  any_ = !volumes.empty() || !surfaces.empty() || !frame.layers.empty();
  projected_ = !volumes.empty() && is_projected(*volumes.front().item);
  if (!any_) return Done{};
  if (projected_) {
    if (!projection_pass_) {
      CATENA_TRY(projection_pass_, ProjectionRaycast::create(frame.device));
    }
    return projection_pass_->prepare(*volumes.front().item, volumes.front().resident);
  }
  if (!exact_pass_) {
    CATENA_TRY(exact_pass_, VolumeRaycast::create(frame.device));
  }
  return exact_pass_->prepare(volumes, surfaces);
}

Bounds RaycastPass::bounds() const {
  Bounds all;
  for (const field::Field* grid : grids_) all.extend(grid->world_bounds());
  return all;
}

Outcome RaycastPass::record(vk::Commands& commands, Frame& frame) {
  Targets& targets = frame.targets;
  const vk::Image* opaque = frame.has(target::opaque_depth) ? &targets.opaque_depth : nullptr;
  for (const Layer& layer : frame.layers)
    for (vk::Image* image : {layer.color, layer.depth}) commands.transition(*image, vk::kFragmentRead);
  if (exact_pass_) exact_pass_->select_eye(frame.eye_index, frame.eye_count);
  if (fast_pass_) fast_pass_->select_eye(frame.eye_index, frame.eye_count);
  const VkRect2D whole{{0, 0}, {frame.packet.width, frame.packet.height}};
  const VkRect2D area = frame.layers.empty() ? covered_area(grids_, frame.rays.camera) : whole;
  if (fast_) {
    if (exact_pass_) exact_pass_->invalidate_target();
    const bool half = ends_at_half(frame);
    CATENA_CHECK(fast_pass_->record(commands, frame.rays, fast_settings_, area, targets.output.info().extent,
                                    half ? nullptr : &targets.volume, opaque, targets.placeholder, frame.settings.reuse_rays));
    if (half) {
      frame.half_resolution_volume = &fast_pass_->half_resolution();
      frame.half_resolution_area = area;
    }
    return Done{};
  }
  if (fast_pass_) fast_pass_->invalidate_target();
  if (any_ && !projected_)
    return exact_pass_->record_into(commands, frame.rays, ray_settings(frame), area, ray_scene(frame), targets.volume,
                                    frame.settings.reuse_rays);
  if (exact_pass_) exact_pass_->invalidate_target();
  targets.begin(commands, target::volume, target::volume);
  CATENA_CHECK(record_exact(commands, frame, frame.rays, area));
  commands.end_pass();
  if (projects_pages_) paged_projection_->pages().finish_visits(commands);
  return Done{};
}

Outcome RaycastPass::record_exact(vk::Commands& commands, Frame& frame, const CameraRays& rays, const VkRect2D& area) {
  if (!any_) return Done{};
  if (projects_pages_) return paged_projection_->record(commands, rays, ray_settings(frame), area, ray_scene(frame));
  if (projected_) return projection_pass_->record(commands, rays, ray_settings(frame), area, ray_scene(frame));
  return exact_pass_->record(commands, rays, ray_settings(frame), area, ray_scene(frame));
}

Outcome RaycastPass::record_ray_samples(vk::Commands& commands, Frame& frame, std::uint32_t spacing, vk::Image& target) {
  const vk::Image* opaque = frame.has(target::opaque_depth) ? &frame.targets.opaque_depth : nullptr;
  if (fast_)
    return fast_pass_->record_ray_samples(commands, frame.rays, fast_settings_, spacing, target, opaque, frame.targets.placeholder);
  for (const Layer& layer : frame.layers)
    for (vk::Image* image : {layer.color, layer.depth}) commands.transition(*image, vk::kFragmentRead);
  CameraRays rays = frame.rays;
  rays.spacing = spacing;
  const vk::ColorTarget color{&target, std::array<float, 4>{0, 0, 0, 0}};
  commands.begin_pass({&color, 1}, {});
  const VkExtent3D& extent = target.info().extent;
  CATENA_CHECK(record_exact(commands, frame, rays, {{0, 0}, {extent.width, extent.height}}));
  commands.end_pass();
  if (projects_pages_) paged_projection_->pages().finish_visits(commands);
  return Done{};
}

Outcome RaycastPass::record_half_opacity_depth(vk::Commands& commands, Frame& frame, std::uint32_t spacing, vk::Image& target,
                                               const VkRect2D& area) {
  constexpr double kHalf = 0.5;  // termination opacity: samples behind half opacity do not change the depth
  const vk::Image* opaque = frame.has(target::opaque_depth) ? &frame.targets.opaque_depth : nullptr;
  if (fast_) {
    FastSettings settings = fast_settings_;
    settings.termination = kHalf;
    return fast_pass_->record_half_opacity_depth(commands, frame.rays, settings, spacing, target, area, opaque, frame.targets.placeholder);
  }
  CameraRays rays = frame.rays;
  rays.spacing = spacing;
  RaySettings settings = ray_settings(frame);
  settings.termination = kHalf;
  const vk::ColorTarget depth{&target, std::array<float, 4>{NO_DEPTH, 0, 0, 0}};
  commands.begin_pass({&depth, 1}, {});
  CATENA_CHECK(exact_pass_->record_half_opacity_depth(commands, rays, settings, area, ray_scene(frame)));
  commands.end_pass();
  return Done{};
}

}  // namespace

bool supports_fast_raycast(const vk::Device& device, const FramePacket& packet) {
  const auto supports = [&](const VolumeItem& item) {
    return !is_projected(item) && !item.color_by && item.transfer.gradient_factors.empty() &&
           item.grid->interpolation() == field::Interpolation::linear && FastVolumeResources::can_pack(device, *item.grid) &&
           FastVolumeResources::can_quantize(item);
  };
  return (packet.volumes.size() == 1 || are_channels(packet)) && !packet.fog && !needs_layers(packet) && surfaces_of(packet) == 0 &&
         std::ranges::all_of(packet.volumes, supports);
}

bool uses_raycast(const FramePacket& packet) { return !packet.volumes.empty() || needs_layers(packet) || surfaces_of(packet) > 0; }

bool rays_match(const FramePacket& a, const FramePacket& b) {
  const auto same = []<class Item>(const std::vector<Item>& some, const std::vector<Item>& others) {
    const auto translucent = std::views::filter([](const Item& item) { return is_translucent(item); });
    return std::ranges::equal(some | translucent, others | translucent);
  };
  return a.view == b.view && a.eyes == b.eyes && a.packing == b.packing && a.width == b.width && a.height == b.height &&
         a.volumes == b.volumes && same(a.isosurfaces, b.isosurfaces) && same(a.meshes, b.meshes) && same(a.slices, b.slices) &&
         a.clip_planes == b.clip_planes && a.lights == b.lights && a.illumination == b.illumination && a.fog == b.fog;
}

const PassEntry kRaycastPass{"raycast", [](const Frame& frame) { return uses_raycast(frame.packet) || !frame.layers.empty(); },
                             RaycastPass::create, target::volume};

Outcome check_ray_items(const FramePacket& packet) {
  return check(packet, needs_layers(packet) ? 1 : 0, packet.volumes.size(), surfaces_of(packet), 0);
}

}  // namespace catena::render
