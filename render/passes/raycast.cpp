#include "render/passes/raycast.h"

#include <fmt/format.h>

#include <algorithm>

#include "render/passes/covered_area.h"

namespace catena::render {
namespace {

bool is_translucent(const IsosurfaceItem& item) { return item.opacity > 0 && item.opacity < 1; }

RaySettings ray_settings(const RenderSettings& s) { return {s.step_voxels, s.termination, s.skip}; }

}  // namespace

Result<std::unique_ptr<Pass>> RaycastPass::create(vk::Device&) { return std::unique_ptr<Pass>(new RaycastPass); }

bool RaycastPass::draws_fast(const vk::Device& device, const FramePacket& packet) {
  return packet.volumes.size() == 1 && packet.lights.empty() && !packet.fog &&
         std::none_of(packet.isosurfaces.begin(), packet.isosurfaces.end(), is_translucent) &&
         can_be_packed(device, *packet.volumes.front().grid);
}

bool RaycastPass::ends_at_half(const Frame& frame) const {
  return fast_ && frame.settings.fast->ends_at_half() && !frame.settings.float_picture && !frame.has(target::opaque_depth);
}

PassUse RaycastPass::use(const Frame& frame) const {
  const TargetSet reads = frame.has(target::opaque_depth) ? target::opaque_depth : 0;
  return {reads, ends_at_half(frame) ? 0 : target::volume, true};
}

/// False: there is no memory for it.
bool RaycastPass::prepare_fast(Frame& frame) {
  const VolumeItem& item = frame.packet.volumes.front();
  const FastSettings& settings = *frame.settings.fast;
  const bool gradients = item.shade && settings.smooth_gradients;
  const std::uint64_t version = item.grid->version(), needed = packed_bytes(*item.grid) * (gradients ? 2 : 1);
  if (!refused_.reason.empty() && refused_.version == version && refused_.most_bytes == settings.most_bytes &&
      refused_.gradients == gradients)
    return false;
  refused_ = {version, settings.most_bytes, gradients, {}};
  Outcome prepared = Done{};
  if (needed > settings.most_bytes) {
    prepared = Error{fmt::format("it takes {} MiB on the device, at most {} are allowed", needed >> 20, settings.most_bytes >> 20)};
  } else {
    if (!fast_pass_) {
      auto created = FastVolumePass::create(frame.device);
      if (created)
        fast_pass_.emplace(std::move(*created));
      else
        prepared = created.error();
    }
    if (prepared) prepared = fast_pass_->prepare(item, settings);
  }
  if (prepared) return true;
  fast_pass_.reset();
  refused_.reason = fmt::format("the grid \"{}\" is drawn by exact rays, slower: {}", item.grid->name(), prepared.error().message);
  return false;
}

Outcome RaycastPass::prepare(Frame& frame) {
  const FramePacket& packet = frame.packet;
  grids_.clear();
  wanted_fast_ = frame.settings.fast && draws_fast(frame.device, packet);
  fast_ = wanted_fast_ && prepare_fast(frame) ? &packet.volumes.front() : nullptr;
  if (fast_) {
    grids_.push_back(fast_->grid.get());
    return Done{};
  }

  std::vector<VolumePass::Mirrored<VolumeItem>> volumes;
  std::vector<VolumePass::Mirrored<IsosurfaceItem>> surfaces;
  const auto mirror = [&](const auto& item, auto& list) -> Outcome {
    CATENA_TRY(auto mirrored, frame.mirror(*item.grid));
    if (!mirrored->drawable) return Done{};
    grids_.push_back(item.grid.get());
    list.emplace_back(&item, std::move(mirrored));
    return Done{};
  };
  for (const VolumeItem& item : packet.volumes) CATENA_CHECK(mirror(item, volumes));
  for (const IsosurfaceItem& item : packet.isosurfaces)
    if (is_translucent(item)) CATENA_CHECK(mirror(item, surfaces));
  if (volumes.size() > MAX_VOLUMES) return Error{fmt::format("the scene has {} volumes, expected at most {}", volumes.size(), MAX_VOLUMES)};
  if (surfaces.size() > MAX_SURFACES)
    return Error{fmt::format("the scene has {} translucent isosurfaces, expected at most {}", surfaces.size(), MAX_SURFACES)};
  any_ = !volumes.empty() || !surfaces.empty();
  if (!any_) return Done{};
  if (!exact_pass_) {
    CATENA_TRY(exact_pass_, VolumePass::create(frame.device));
  }
  return exact_pass_->prepare(volumes, surfaces);
}

Bounds RaycastPass::bounds() const {
  Bounds all;
  for (const field::ScalarGrid* grid : grids_) all.add(grid_bounds(*grid));
  return all;
}

Outcome RaycastPass::record(vk::Commands& commands, Frame& frame) {
  Targets& targets = frame.targets;
  const vk::Image* opaque = frame.has(target::opaque_depth) ? &targets.opaque_depth : nullptr;
  const VkRect2D area = covered_area(grids_, frame.rays.camera);
  if (fast_) {
    const bool half = ends_at_half(frame);
    CATENA_CHECK(fast_pass_->record(commands, frame.rays, *frame.settings.fast, area, targets.picture.info().extent,
                                    half ? nullptr : &targets.volume, opaque, targets.none));
    if (half) {
      frame.half_lattice = &fast_pass_->half();
      frame.half_area = area;
    }
    return Done{};
  }
  targets.begin(commands, target::volume, target::volume);
  if (any_) CATENA_CHECK(exact_pass_->record(commands, frame.rays, ray_settings(frame.settings), area, opaque, targets.none));
  commands.end_pass();
  return Done{};
}

Outcome RaycastPass::record_probe(vk::Commands& commands, Frame& frame, std::uint32_t spacing, vk::Image& target) {
  const vk::Image* opaque = frame.has(target::opaque_depth) ? &frame.targets.opaque_depth : nullptr;
  if (fast_) return fast_pass_->record_probe(commands, frame.rays, *frame.settings.fast, spacing, target, opaque, frame.targets.none);
  CameraRays rays = frame.rays;
  rays.spacing = spacing;
  const vk::ColorTarget color{&target, std::array<float, 4>{0, 0, 0, 0}};
  commands.begin_pass({&color, 1}, {});
  const VkExtent3D& extent = target.info().extent;
  if (any_)
    CATENA_CHECK(exact_pass_->record(commands, rays, ray_settings(frame.settings), {{0, 0}, {extent.width, extent.height}}, opaque,
                                     frame.targets.none));
  commands.end_pass();
  return Done{};
}

const PassEntry kRaycastPass{"raycast",
                             [](const Frame& frame) {
                               const auto& surfaces = frame.packet.isosurfaces;
                               return !frame.packet.volumes.empty() || std::any_of(surfaces.begin(), surfaces.end(), is_translucent);
                             },
                             RaycastPass::create};

}  // namespace catena::render
