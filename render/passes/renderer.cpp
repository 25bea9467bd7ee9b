#include "render/passes/renderer.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "engine/base/eye_limits.h"
#include "render/passes/passes.h"
#include "render/passes/renderer_parts.h"
#include "render/vk/swapchain.h"

namespace catena::render {
namespace {

/// All that a picture can hold, in the order of drawing.
constexpr const PassEntry* kPasses[] = {&kAidPass,    &kWidgetPass,     &kMeshPass,         &kStreamlinePass, &kGlyphPass,  &kBallPass,
                                        &kCursorPass, &kIsosurfacePass, &kSurfaceColorPass, &kSlicePass,      &kLayersPass, &kRaycastPass,
                                        &kGhostPass,  &kComposePass,    &kVignettePass,     &kOverlayPass};

Outcome check(const FramePacket& packet, const RenderSettings& settings, const vk::DeviceInfo& device) {
  const std::uint32_t most = device.limits.maxImageDimension2D;
  if (packet.width == 0 || packet.height == 0 || packet.width > most || packet.height > most)
    return Error{fmt::format("a picture of {} x {} pixels cannot be drawn, expected 1 to {} each way", packet.width, packet.height, most)};
  if (!(settings.step_voxels > 0) || !std::isfinite(settings.step_voxels))
    return Error{fmt::format("the ray step is {} voxels, expected a positive number", settings.step_voxels)};
  if (packet.clip.size() > kMaxClipPlanes)
    return Error{fmt::format("the scene has {} clip planes, expected at most {}", packet.clip.size(), kMaxClipPlanes)};
  if (packet.lights.size() > kMaxLights)
    return Error{fmt::format("the scene has {} lights, expected at most {}", packet.lights.size(), kMaxLights)};
  return Done{};
}

}  // namespace

Renderer::Renderer() : parts_(std::make_unique<Parts>()) { parts_->passes.resize(std::size(kPasses)); }
Renderer::~Renderer() = default;

Result<std::unique_ptr<Renderer>> Renderer::create(const vk::DeviceOptions& options) {
  std::unique_ptr<Renderer> self(new Renderer);
  CATENA_TRY(self->parts_->device, vk::Device::create(options));
  self->parts_->mirrors.emplace(*self->parts_->device);
  return self;
}

std::vector<Pass*> Renderer::Parts::active(std::vector<std::string>* names) const {
  std::vector<Pass*> list;
  for (std::size_t i = 0; i < passes.size(); ++i) {
    if (!passes[i]) continue;
    list.push_back(passes[i].get());
    if (names) names->push_back(kPasses[i]->name);
  }
  return list;
}

/// With their pipelines; the next picture makes them anew.
void Renderer::Parts::drop_passes() {
  for (auto& pass : passes) {
    if (pass) gone_build_ms += pass->build_ms();
    pass.reset();
  }
  pack.reset();
  ui.reset();
  drawn = 0;
}

/// Once more where the budget refused and older frames, or the first of several grids, held what this one needs.
template <class Work>
auto Renderer::Parts::within_budget(const FramePacket& packet, const Work& work) -> decltype(work()) {
  const std::size_t grids = packet.volumes.size() + packet.isosurfaces.size() + packet.slices.size();
  if (sharers != grids) sharers = 1;
  const std::uint64_t refused = device->counters().refused;
  const bool held = device->counters().bytes > 0;
  auto result = kept_or_dropped(work());
  if (result || device->counters().refused == refused || !(held || grids > 1)) return result;
  sharers = grids;
  return kept_or_dropped(work());
}

/// Bytes of the budget that are not for mirrors: the targets, their copy on the way back, layers, and 1 MB of tables and vertices.
std::uint64_t Renderer::Parts::reserved(const Frame& frame) const {
  TargetSet needed = target::picture | target::volume;
  std::uint64_t a_pixel = vk::texel_bytes(targets.picture_format);
  for (const PassEntry* entry : kPasses)
    if (entry->wanted(frame)) {
      needed |= entry->reserves;
      a_pixel += entry->reserved_pixel_bytes;
    }
  const std::uint64_t pixels = std::uint64_t(frame.packet.width) * frame.packet.height;
  if (frame.eyes > volumes.size() + 1) a_pixel += (frame.eyes - 1 - volumes.size()) * vk::texel_bytes(kVolumeFormat);
  return pixels * a_pixel + targets.bytes_to_come(frame.packet.width, frame.packet.height, needed) + 1'000'000;
}

/// Makes the passes that the packet wants and no others, uploads, and fixes the targets and the rays.
Outcome Renderer::Parts::prepare(Frame& frame) {
  targets.picture_format = frame.settings.float_picture ? kFloatPictureFormat : kPictureFormat;
  mirrors->begin_frame(reserved(frame), sharers);
  for (std::size_t i = 0; i < passes.size(); ++i) {
    if (!kPasses[i]->wanted(frame)) {
      if (passes[i]) gone_build_ms += passes[i]->build_ms();
      passes[i].reset();
      continue;
    }
    if (!passes[i]) {
      CATENA_TRY(passes[i], kPasses[i]->create(*device));
    }
    CATENA_CHECK(passes[i]->prepare(frame));
  }
  mirrors->drop_unused();
  Bounds bounds, of_rays, of_surfaces;
  TargetSet needed = target::picture;
  for (Pass* pass : active()) {
    bounds.add(pass->bounds());
    if (pass->probe()) of_rays.add(pass->bounds());
    if (pass->finds_surfaces()) of_surfaces.add(pass->bounds());
    const TargetSet writes = pass->use(frame).writes;
    frame.written |= writes;
    needed |= writes;
  }
  frame.written = 0;
  frame.rays = CameraRays::make(frame.packet, bounds, of_rays.empty() ? of_surfaces : of_rays);
  return targets.ensure(*device, frame.packet.width, frame.packet.height, needed);
}

/// Neighbours with equal targets share one rendering scope; what is written first is cleared, what is read is moved there before.
Outcome Renderer::Parts::record(vk::Commands& commands, Frame& frame, const std::vector<Pass*>& list) {
  TargetSet open = 0;
  const auto close = [&] {
    if (open != 0) commands.end_pass();
    open = 0;
  };
  for (Pass* pass : list) {
    const PassUse use = pass->use(frame);
    CATENA_ASSERT((use.reads & ~frame.written) == 0);
    if (use.own_scope || use.writes != open || use.reads != 0) close();
    for (TargetSet one = 1; one <= use.reads; one <<= 1)
      if ((use.reads & one) != 0) commands.use(targets.image(one), vk::kFragmentRead);
    if (!use.own_scope) {
      if (open == 0) targets.begin(commands, use.writes, use.writes & ~frame.written);
      open = use.writes;
      commands.scissor({{0, 0}, {frame.packet.width, frame.packet.height}});
    }
    CATENA_CHECK(pass->record(commands, frame));
    frame.written |= use.writes;
  }
  close();
  return Done{};
}

/// One view, into targets.picture.
Outcome Renderer::Parts::draw(const FramePacket& packet, const RenderSettings& settings, std::size_t eye, std::size_t eyes) {
  Frame frame{*device, *mirrors, targets, packet, settings, {}};
  frame.eye = eye;
  frame.eyes = eyes;
  CATENA_CHECK(prepare(frame));
  drawn_passes.clear();
  CATENA_TRY(vk::Commands commands, vk::Commands::begin(*device));
  CATENA_CHECK(record(commands, frame, active(&drawn_passes)));
  commands.use(targets.picture, vk::kTransferRead);
  CATENA_CHECK(commands.finish());
  drawn = frame.written;
  view_width = packet.width;
  view_height = packet.height;
  reference_depth = frame.rays.reference_depth;
  return draw_ray_depth(frame);
}

Outcome Renderer::Parts::draw_ray_depth(Frame& frame) {
  ray_depth_spacing = 0;
  const std::uint32_t spacing = frame.settings.ray_depth_spacing;
  if (spacing == 0) return Done{};
  for (Pass* pass : active()) {
    RayProbe* rays = pass->probe();
    if (!rays || !rays->has_half_depth()) continue;
    CATENA_CHECK(vk::fit_image(*device, ray_depth, kVolumeFormat, (frame.packet.width + spacing - 1) / spacing,
                               (frame.packet.height + spacing - 1) / spacing));
    CATENA_TRY(vk::Commands commands, vk::Commands::begin(*device));
    CATENA_CHECK(rays->record_half_depth(commands, frame, spacing, ray_depth));
    CATENA_CHECK(commands.finish());
    ray_depth_spacing = spacing;
  }
  return Done{};
}

/// One eye after the other (passes upload only what changed since the last); the first comes last, so that its depth and ids stay.
Outcome Renderer::Parts::draw_eyes(const FramePacket& packet, const RenderSettings& settings) {
  if (!pack) pack.emplace(*device);
  CATENA_CHECK(pack->begin(packet.packing, packet.eyes.size(), packet.width, packet.height));
  FramePacket one = packet;
  one.eyes.clear();
  volumes.resize(packet.packing == Packing::single ? 0 : packet.eyes.size() - 1);
  for (std::size_t k = volumes.size() + 1; k-- > 0;) {
    one.view = packet.eyes[k];
    if (k > 0) std::swap(targets.volume, volumes[k - 1]);
    CATENA_CHECK(draw(one, settings, k, volumes.size() + 1));
    if (k > 0) std::swap(targets.volume, volumes[k - 1]);
    pack->keep(k, targets.picture);
  }
  CATENA_TRY(vk::Commands commands, vk::Commands::begin(*device));
  CATENA_CHECK(pack->record(commands));
  return commands.finish();
}

Outcome Renderer::draw(const FramePacket& packet, const RenderSettings& settings) {
  parts_->drawn = 0;
  CATENA_CHECK(check(packet, settings, parts_->device->info()));
  return parts_->within_budget(packet, [&] { return draw_once(packet, settings); });
}

Result<Picture> Renderer::probe(const FramePacket& packet, const RenderSettings& settings, std::uint32_t spacing) {
  parts_->drawn = 0;
  CATENA_CHECK(check(packet, settings, parts_->device->info()));
  return parts_->within_budget(packet, [&] { return probe_once(packet, settings, spacing); });
}

Outcome Renderer::draw_once(const FramePacket& packet, const RenderSettings& settings) {
  Parts& p = *parts_;
  p.packed = !packet.eyes.empty();
  if (!p.packed) p.pack.reset(), p.volumes.clear();
  return p.packed ? p.draw_eyes(packet, settings) : p.draw(packet, settings);
}

DrawnImage Renderer::image() const {
  CATENA_ASSERT(parts_->drawn != 0);
  const vk::Image& shown = parts_->shown();
  const VkExtent3D& size = shown.info().extent;
  return {shown.handle(), shown.info().format,        {size.width, size.height},
          shown.layout,   parts_->device->timeline(), parts_->device->submitted()};
}

vk::Image& Renderer::picture() {
  CATENA_ASSERT(parts_->drawn != 0);
  return parts_->shown();
}

std::optional<Renderer::OpaqueDepth> Renderer::opaque_depth() {
  if ((parts_->drawn & target::opaque_depth) == 0) return std::nullopt;
  return OpaqueDepth{&parts_->targets.opaque_depth, parts_->reference_depth};
}

std::optional<Renderer::RayDepth> Renderer::ray_depth() {
  CATENA_ASSERT(parts_->drawn != 0);
  if (parts_->ray_depth_spacing == 0) return std::nullopt;
  return RayDepth{&parts_->ray_depth, parts_->reference_depth, parts_->ray_depth_spacing};
}

vk::Image& Renderer::no_image() { return parts_->targets.none; }

std::uint32_t Renderer::longest_side() const { return parts_->device->info().limits.maxImageDimension2D; }

bool Renderer::draws_fast(const FramePacket& packet) const {
  for (Pass* pass : parts_->active())
    if (const RayProbe* rays = pass->probe(); rays && rays->has_refused(packet)) return false;
  return can_be_drawn_fast(*parts_->device, packet);
}

bool Renderer::leaps() const {
  for (Pass* pass : parts_->active())
    if (const RayProbe* rays = pass->probe(); rays && rays->leaps()) return true;
  return false;
}

std::array<std::uint32_t, 2> Renderer::view_size() const { return {parts_->view_width, parts_->view_height}; }

/// Where mirrors hold what the window needs, they go: the next picture makes them anew in what is left. The picture stays.
Outcome Renderer::Parts::paint(std::uint32_t width, std::uint32_t height, const UiItems& items) {
  CATENA_ASSERT(drawn != 0);
  if (!ui) ui.emplace(*device);
  const std::uint64_t refused = device->counters().refused;
  Outcome painted = ui->paint(shown(), width, height, items);
  if (!painted && device->counters().refused != refused && mirrors->count() > 0) {
    for (auto& pass : passes) {
      if (pass) gone_build_ms += pass->build_ms();
      pass.reset();
    }
    mirrors->clear();
    CATENA_CHECK(device->wait_idle());
    painted = ui->paint(shown(), width, height, items);
  }
  if (!painted) ui.reset();
  return painted;
}

Outcome Renderer::paint_window(std::uint32_t width, std::uint32_t height, const UiItems& ui) { return parts_->paint(width, height, ui); }

Result<bool> Renderer::present(vk::Swapchain& swapchain, const UiItems* ui) {
  Parts& p = *parts_;
  CATENA_ASSERT(p.drawn != 0);
  const VkExtent2D extent = swapchain.extent();
  if (extent.width == 0 || extent.height == 0) return false;
  if (ui == nullptr) return swapchain.present(p.shown());
  CATENA_CHECK(p.paint(extent.width, extent.height, *ui));
  return swapchain.present(p.ui->window());
}

vk::Image* Renderer::window_image() { return parts_->ui && parts_->ui->window() ? &parts_->ui->window() : nullptr; }

Result<bool> Renderer::replace_shader(std::string_view name, std::vector<std::uint32_t> words) {
  const auto all = embedded_shaders();
  const auto found = std::ranges::find(all, name, &EmbeddedShader::name);
  if (found == all.end()) return Error{fmt::format("there is no shader \"{}\"", name)};
  const auto bound = vk::declared_bindings(found->words);
  for (const std::uint32_t binding : vk::declared_bindings(words))
    if (!std::ranges::binary_search(bound, binding))
      return Error{fmt::format("{}: binding {} is not one that the program binds, expected the bindings of the shader it was built with",
                               name, binding)};
  vk::ShaderReplacements& shaders = parts_->device->shaders();
  if (std::ranges::equal(shaders.of(found->words), words)) return false;
  shaders.replace(found->words, std::move(words));
  parts_->drop_passes();
  return true;
}

void Renderer::restore_shaders() {
  parts_->device->shaders().clear();
  parts_->drop_passes();
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
  stats.mirror_bytes = parts_->mirrors->bytes();
  stats.mirror_coarsening = parts_->mirrors->coarsenings();
  stats.gpu_budget = device.info().memory_budget;
  stats.passes = parts_->drawn_passes;
  stats.mirror_ms = parts_->mirrors->build_ms() + parts_->gone_build_ms;
  for (Pass* pass : parts_->active()) {
    stats.mirror_ms += pass->build_ms();
    stats.mirror_bytes += pass->grid_bytes();
    if (std::string note = pass->note(); !note.empty()) stats.notes.push_back(std::move(note));
    if (pass->probe()) stats.rays_kept = pass->probe()->has_kept();
    if (!pass->probe() && pass->has_kept()) stats.surfaces_kept = true;
  }
  stats.validation_messages = device.messages().count();
  return stats;
}

std::vector<std::string> Renderer::validation_texts() const { return parts_->device->messages().texts(); }
vk::Device& Renderer::device() { return *parts_->device; }

}  // namespace catena::render
