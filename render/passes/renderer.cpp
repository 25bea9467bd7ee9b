#include "render/passes/renderer.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>

#include "render/mirror/half.h"
#include "render/passes/camera_rays.h"
#include "render/passes/compose.h"
#include "render/passes/fast_volume.h"
#include "render/passes/isosurface.h"
#include "render/passes/mesh.h"
#include "render/passes/mirrors.h"
#include "render/passes/overlay.h"
#include "render/passes/targets.h"
#include "render/passes/upsample.h"
#include "render/passes/volume.h"
#include "render/vk/swapchain.h"

namespace catena::render {
namespace {

template <class Item>
using Mirrored = VolumePass::Mirrored<Item>;

/// The pixels that the grids' domains can cover; the whole picture when a corner is behind the eye.
VkRect2D covered_area(const std::vector<const field::ScalarGrid*>& grids, const Camera& camera) {
  double x0 = camera.width, y0 = camera.height, x1 = 0, y1 = 0;
  for (const field::ScalarGrid* grid : grids) {
    const field::Box& box = grid->index_box();
    for (int i = 0; i < 8; ++i) {
      const Vec3 index{(i & 1) ? box.hi.x : box.lo.x, (i & 2) ? box.hi.y : box.lo.y, (i & 4) ? box.hi.z : box.lo.z};
      const auto pixel = project(camera, grid->mapping().world_from_index(index));
      if (!pixel) return {{0, 0}, {std::uint32_t(camera.width), std::uint32_t(camera.height)}};
      x0 = std::min(x0, pixel->x);
      y0 = std::min(y0, pixel->y);
      x1 = std::max(x1, pixel->x);
      y1 = std::max(y1, pixel->y);
    }
  }
  x0 = std::clamp(std::floor(x0) - 1, 0.0, camera.width);
  y0 = std::clamp(std::floor(y0) - 1, 0.0, camera.height);
  x1 = std::clamp(std::ceil(x1) + 1, x0, camera.width);
  y1 = std::clamp(std::ceil(y1) + 1, y0, camera.height);
  return {{std::int32_t(x0), std::int32_t(y0)}, {std::uint32_t(x1 - x0), std::uint32_t(y1 - y0)}};
}

/// What one frame draws, sorted by pass.
struct Work {
  std::vector<Mirrored<VolumeItem>> volumes;
  std::vector<Mirrored<IsosurfaceItem>> opaque_surfaces, translucent_surfaces;
  std::vector<const field::ScalarGrid*> grids;
  const VolumeItem* fast = nullptr;  ///< the lone volume of the fast raycast; then `volumes` is empty
  bool ends_at_half = false;         ///< the fast raycast needs no image of every pixel
  bool meshes = false;
  bool opaque() const { return meshes || !opaque_surfaces.empty(); }
  bool raycast() const { return fast || !volumes.empty() || !translucent_surfaces.empty(); }
};

/// One volume and no translucent isosurface: nothing that a ray must blend.
bool is_alone(const FramePacket& packet) {
  const auto translucent = [](const IsosurfaceItem& item) { return item.opacity > 0 && item.opacity < 1; };
  return packet.volumes.size() == 1 && std::none_of(packet.isosurfaces.begin(), packet.isosurfaces.end(), translucent);
}

Outcome check(const FramePacket& packet, const RenderSettings& settings, const vk::DeviceInfo& device) {
  const std::uint32_t most = device.limits.maxImageDimension2D;
  if (packet.width == 0 || packet.height == 0 || packet.width > most || packet.height > most)
    return Error{fmt::format("a picture of {} x {} pixels cannot be drawn, expected 1 to {} each way", packet.width, packet.height, most)};
  if (!(settings.step_voxels > 0) || !std::isfinite(settings.step_voxels))
    return Error{fmt::format("the ray step is {} voxels, expected a positive number", settings.step_voxels)};
  return Done{};
}

}  // namespace

RenderSettings draft_settings() {
  RenderSettings s;
  s.step_voxels = 2;
  s.fast = FastSettings{4, 4, -1, -1};
  return s;
}

RenderSettings balanced_settings() {
  RenderSettings s;
  s.fast = FastSettings{2.5, 4, 0.7, 1.5};
  return s;
}

RenderSettings reference_settings() {
  RenderSettings s;
  s.step_voxels = 0.1;
  s.termination = 1e-4;
  s.texels = TexelFormat::r32f;
  return s;
}

struct Renderer::Parts {
  std::unique_ptr<vk::Device> device;  // first in, last out
  std::optional<Mirrors> mirrors;
  Targets targets;
  std::optional<MeshPass> mesh;
  std::optional<IsosurfacePass> isosurface;
  std::optional<VolumePass> volume;
  std::optional<FastVolumePass> fast_volume;
  std::optional<UpsamplePass> upsample;
  std::optional<ComposePass> compose;
  std::optional<OverlayPass> overlay;
  bool drawn = false, drawn_opaque = false;
  double reference_depth = 0;

  Result<Work> sort(const FramePacket& packet, const RenderSettings& settings);
  Bounds bounds(const Work& work) const;
  Outcome prepare(const FramePacket& packet, const RenderSettings& settings, const Work& work);
  Outcome record_opaque(vk::Commands& commands, const Work& work, const CameraRays& rays);
  Outcome record(vk::Commands& commands, const FramePacket& packet, const RenderSettings& settings, const Work& work,
                 const CameraRays& rays);
};

Renderer::Renderer() : parts_(std::make_unique<Parts>()) {}
Renderer::~Renderer() = default;

Result<std::unique_ptr<Renderer>> Renderer::create(const vk::DeviceOptions& options) {
  std::unique_ptr<Renderer> self(new Renderer);
  CATENA_TRY(self->parts_->device, vk::Device::create(options));
  self->parts_->mirrors.emplace(*self->parts_->device);
  self->parts_->upsample.emplace(*self->parts_->device);
  self->parts_->compose.emplace(*self->parts_->device);
  return self;
}

/// Mirrors what the packet names and says which pass draws it.
Result<Work> Renderer::Parts::sort(const FramePacket& packet, const RenderSettings& settings) {
  Work work;
  work.meshes =
      !packet.meshes.empty() || !packet.tubes.empty() || !packet.arrows.empty() || !packet.cursors.empty() || !packet.indicators.empty();
  mirrors->begin_frame();
  const auto mirror = [&](const field::ScalarGrid& grid) {
    const bool surface =
        std::any_of(packet.isosurfaces.begin(), packet.isosurfaces.end(), [&](const auto& item) { return item.grid.get() == &grid; });
    const bool float32 = settings.texels == TexelFormat::r32f || (settings.texels == TexelFormat::automatic && surface);
    return mirrors->get(grid, {float32, settings.layout});
  };
  for (const VolumeItem& item : packet.volumes) {
    CATENA_ASSERT(item.grid != nullptr);
    if (settings.fast && is_alone(packet) && can_be_packed(*device, *item.grid)) {
      work.grids.push_back(item.grid.get());
      work.fast = &item;
      continue;
    }
    CATENA_TRY(auto mirrored, mirror(*item.grid));
    if (!mirrored->drawable) continue;
    work.grids.push_back(item.grid.get());
    work.volumes.emplace_back(&item, std::move(mirrored));
  }
  for (const IsosurfaceItem& item : packet.isosurfaces) {
    CATENA_ASSERT(item.grid != nullptr);
    if (!(item.opacity > 0)) continue;
    CATENA_TRY(auto mirrored, mirror(*item.grid));
    if (!mirrored->drawable) continue;
    work.grids.push_back(item.grid.get());
    (item.opacity < 1 ? work.translucent_surfaces : work.opaque_surfaces).emplace_back(&item, std::move(mirrored));
  }
  mirrors->drop_unused();
  if (packet.volumes.empty()) fast_volume.reset();
  work.ends_at_half = work.fast && settings.fast->ends_at_half() && !work.opaque();
  if (work.volumes.size() > MAX_VOLUMES)
    return Error{fmt::format("the scene has {} volumes, expected at most {}", work.volumes.size(), MAX_VOLUMES)};
  if (work.translucent_surfaces.size() > MAX_SURFACES)
    return Error{
        fmt::format("the scene has {} translucent isosurfaces, expected at most {}", work.translucent_surfaces.size(), MAX_SURFACES)};
  return work;
}

/// Of all that is drawn; `prepare` comes first.
Bounds Renderer::Parts::bounds(const Work& work) const {
  Bounds all;
  for (const field::ScalarGrid* grid : work.grids) all.add(grid_bounds(*grid));
  if (work.meshes) all.add(mesh->bounds());
  return all;
}

/// Creates the passes that are needed and hands every pass its work, also none.
Outcome Renderer::Parts::prepare(const FramePacket& packet, const RenderSettings& settings, const Work& work) {
  if (!mesh && work.meshes) {
    CATENA_TRY(mesh, MeshPass::create(*device));
  }
  if (!isosurface && !work.opaque_surfaces.empty()) {
    CATENA_TRY(isosurface, IsosurfacePass::create(*device));
  }
  if (!volume && work.raycast() && !work.fast) {
    CATENA_TRY(volume, VolumePass::create(*device));
  }
  if (!fast_volume && work.fast) {
    CATENA_TRY(fast_volume, FastVolumePass::create(*device));
  }
  if (mesh) CATENA_CHECK(mesh->prepare(packet));
  if (isosurface) CATENA_CHECK(isosurface->prepare(work.opaque_surfaces));
  if (volume) CATENA_CHECK(volume->prepare(work.volumes, work.translucent_surfaces));
  if (work.fast) CATENA_CHECK(fast_volume->prepare(*work.fast, *settings.fast));
  return targets.ensure(*device, packet.width, packet.height, work.opaque(), work.raycast() && !work.ends_at_half);
}

Outcome Renderer::Parts::record_opaque(vk::Commands& commands, const Work& work, const CameraRays& rays) {
  if (!work.opaque()) return Done{};
  const vk::ColorTarget colors[] = {{&targets.opaque_color, std::array<float, 4>{0, 0, 0, 0}},
                                    {&targets.opaque_depth, std::array<float, 4>{NO_DEPTH, 0, 0, 0}}};
  commands.begin_pass(colors, {&targets.depth_buffer, 0.0f});
  if (work.meshes) CATENA_CHECK(mesh->record(commands, rays));
  if (isosurface) CATENA_CHECK(isosurface->record(commands, rays, covered_area(work.grids, rays.camera)));
  commands.end_pass();
  return Done{};
}

Outcome Renderer::Parts::record(vk::Commands& commands, const FramePacket& packet, const RenderSettings& settings, const Work& work,
                                const CameraRays& rays) {
  CATENA_CHECK(record_opaque(commands, work, rays));
  const VkRect2D area = covered_area(work.grids, rays.camera);
  if (work.raycast()) {
    if (work.opaque()) commands.use(targets.opaque_depth, vk::kFragmentRead);
    const vk::Image* opaque_depth = work.opaque() ? &targets.opaque_depth : nullptr;
    if (work.fast) {
      CATENA_CHECK(fast_volume->record(commands, rays, *settings.fast, area, targets.picture.info().extent,
                                       work.ends_at_half ? nullptr : &targets.volume, opaque_depth, targets.none));
      if (work.ends_at_half) return upsample->record(commands, fast_volume->half(), targets, packet.background, work.opaque(), area);
      return compose->record(commands, targets, packet.background, work.opaque(), true);
    }
    const vk::ColorTarget color{&targets.volume, std::array<float, 4>{0, 0, 0, 0}};
    commands.begin_pass({&color, 1}, {});
    CATENA_CHECK(
        volume->record(commands, rays, {settings.step_voxels, settings.termination, settings.skip}, area, opaque_depth, targets.none));
    commands.end_pass();
  }
  return compose->record(commands, targets, packet.background, work.opaque(), work.raycast());
}

Outcome Renderer::draw(const FramePacket& packet, const RenderSettings& settings) {
  Parts& p = *parts_;
  p.drawn = false;
  CATENA_CHECK(check(packet, settings, p.device->info()));
  CATENA_TRY(const Work work, p.sort(packet, settings));
  CATENA_CHECK(p.prepare(packet, settings, work));
  const CameraRays rays = CameraRays::make(packet, p.bounds(work));
  if (!p.overlay && !packet.overlay.empty()) {
    CATENA_TRY(p.overlay, OverlayPass::create(*p.device));
  }
  if (p.overlay) CATENA_CHECK(p.overlay->prepare(packet, rays));
  CATENA_TRY(vk::Commands commands, vk::Commands::begin(*p.device));
  CATENA_CHECK(p.record(commands, packet, settings, work, rays));
  if (p.overlay) CATENA_CHECK(p.overlay->record(commands, p.targets, work.opaque() ? &p.targets.opaque_depth : nullptr));
  CATENA_CHECK(commands.finish());
  p.drawn = true;
  p.drawn_opaque = work.opaque();
  p.reference_depth = rays.reference_depth;
  return Done{};
}

Result<Picture> Renderer::read_back() {
  Parts& p = *parts_;
  CATENA_ASSERT(p.drawn);
  Picture picture;
  picture.width = p.targets.picture.info().extent.width;
  picture.height = p.targets.picture.info().extent.height;
  picture.rgba.resize(std::size_t(4) * picture.width * picture.height);
  CATENA_TRY(const vk::Buffer buffer,
             vk::Buffer::create(*p.device, picture.rgba.size(), VK_BUFFER_USAGE_TRANSFER_DST_BIT, vk::Memory::readback));
  CATENA_TRY(vk::Commands commands, vk::Commands::begin(*p.device));
  commands.copy(p.targets.picture, buffer);
  CATENA_CHECK(commands.finish());
  std::memcpy(picture.rgba.data(), buffer.bytes().data(), picture.rgba.size());
  return picture;
}

bool Renderer::draws_fast(const FramePacket& packet) const {
  return is_alone(packet) && can_be_packed(*parts_->device, *packet.volumes.front().grid);
}

Result<Picture> Renderer::probe(const FramePacket& packet, const RenderSettings& settings) {
  Parts& p = *parts_;
  p.drawn = false;
  CATENA_CHECK(check(packet, settings, p.device->info()));
  CATENA_TRY(const Work work, p.sort(packet, settings));
  CATENA_CHECK(p.prepare(packet, settings, work));
  CameraRays rays = CameraRays::make(packet, p.bounds(work));
  CATENA_TRY(vk::Commands commands, vk::Commands::begin(*p.device));
  CATENA_CHECK(p.record_opaque(commands, work, rays));

  // the rays, into an image of their own
  Picture picture;
  picture.width = (packet.width + kProbeSpacing - 1) / kProbeSpacing;
  picture.height = (packet.height + kProbeSpacing - 1) / kProbeSpacing;
  const std::size_t count = std::size_t(picture.width) * picture.height;
  std::vector<float> volume(4 * count);
  std::vector<std::uint16_t> opaque(work.opaque() ? 4 * std::size_t(packet.width) * packet.height : 0);
  vk::Image target;
  vk::Buffer volume_bytes, opaque_bytes;
  if (work.raycast()) {
    vk::ImageInfo info;
    info.format = kVolumeFormat;
    info.extent = {picture.width, picture.height, 1};
    info.usage = VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT;
    CATENA_TRY(target, vk::Image::create(*p.device, info));
    const vk::Image* depth = work.opaque() ? &p.targets.opaque_depth : nullptr;
    if (depth) commands.use(p.targets.opaque_depth, vk::kFragmentRead);
    if (work.fast) {
      CATENA_CHECK(p.fast_volume->record_probe(commands, rays, *settings.fast, kProbeSpacing, target, depth, p.targets.none));
    } else {
      rays.spacing = kProbeSpacing;
      const vk::ColorTarget color{&target, std::array<float, 4>{0, 0, 0, 0}};
      commands.begin_pass({&color, 1}, {});
      CATENA_CHECK(p.volume->record(commands, rays, {settings.step_voxels, settings.termination, settings.skip},
                                    {{0, 0}, {picture.width, picture.height}}, depth, p.targets.none));
      commands.end_pass();
    }
    const std::size_t bytes = volume.size() * sizeof(float);
    CATENA_TRY(volume_bytes, vk::Buffer::create(*p.device, bytes, VK_BUFFER_USAGE_TRANSFER_DST_BIT, vk::Memory::readback));
    commands.copy(target, volume_bytes);
  }
  if (work.opaque()) {
    const std::size_t bytes = opaque.size() * sizeof(std::uint16_t);
    CATENA_TRY(opaque_bytes, vk::Buffer::create(*p.device, bytes, VK_BUFFER_USAGE_TRANSFER_DST_BIT, vk::Memory::readback));
    commands.copy(p.targets.opaque_color, opaque_bytes);
  }
  CATENA_CHECK(commands.finish());
  if (volume_bytes) std::memcpy(volume.data(), volume_bytes.bytes().data(), volume.size() * sizeof(float));
  if (opaque_bytes) std::memcpy(opaque.data(), opaque_bytes.bytes().data(), opaque.size() * sizeof(std::uint16_t));

  // volume over opaque over background over black
  picture.rgba.assign(4 * count, 255);
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t pixel = kProbeSpacing * (i / picture.width * packet.width + i % picture.width);
    for (std::size_t c = 0; c < 3; ++c) {
      float sum = packet.background[c] * packet.background[3];
      if (!opaque.empty()) sum = float_from_half(opaque[4 * pixel + c]) + (1 - float_from_half(opaque[4 * pixel + 3])) * sum;
      sum = volume[4 * i + c] + (1 - volume[4 * i + 3]) * sum;
      picture.rgba[4 * i + c] = std::uint8_t(std::lround(255 * std::clamp(sum, 0.0f, 1.0f)));
    }
  }
  return picture;
}

Result<DepthPicture> Renderer::read_depth() {
  Parts& p = *parts_;
  CATENA_ASSERT(p.drawn);
  DepthPicture picture;
  picture.width = p.targets.picture.info().extent.width;
  picture.height = p.targets.picture.info().extent.height;
  picture.depth.assign(std::size_t(picture.width) * picture.height, std::numeric_limits<float>::infinity());
  if (!p.drawn_opaque) return picture;
  const std::size_t bytes = picture.depth.size() * sizeof(float);
  CATENA_TRY(const vk::Buffer buffer, vk::Buffer::create(*p.device, bytes, VK_BUFFER_USAGE_TRANSFER_DST_BIT, vk::Memory::readback));
  CATENA_TRY(vk::Commands commands, vk::Commands::begin(*p.device));
  commands.copy(p.targets.opaque_depth, buffer);
  CATENA_CHECK(commands.finish());
  std::vector<float> relative(picture.depth.size());
  std::memcpy(relative.data(), buffer.bytes().data(), bytes);
  for (std::size_t i = 0; i < relative.size(); ++i)
    if (relative[i] < NO_DEPTH) picture.depth[i] = float(double(relative[i]) + p.reference_depth);
  return picture;
}

Result<bool> Renderer::present(vk::Swapchain& swapchain) {
  CATENA_ASSERT(parts_->drawn);
  return swapchain.present(parts_->targets.picture);
}

RenderStats Renderer::stats() const {
  const vk::Device& device = *parts_->device;
  RenderStats stats;
  stats.device = device.info().name;
  stats.driver = device.info().driver;
  stats.gpu_bytes = device.counters().bytes;
  stats.uploads = device.counters().uploads;
  stats.upload_bytes = device.counters().upload_bytes;
  stats.pipelines = device.counters().pipelines;
  stats.mirrors = parts_->mirrors->count();
  stats.mirror_ms = parts_->mirrors->build_ms() + (parts_->fast_volume ? parts_->fast_volume->build_ms() : 0);
  if (parts_->overlay) stats.text_fault = parts_->overlay->fault();
  stats.validation_messages = device.messages().count();
  return stats;
}

std::vector<std::string> Renderer::validation_texts() const { return parts_->device->messages().texts(); }
vk::Device& Renderer::device() { return *parts_->device; }

}  // namespace catena::render
