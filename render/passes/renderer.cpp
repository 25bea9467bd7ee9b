// SPDX-License-Identifier: MIT
#include "render/passes/renderer.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "engine/base/camera_limits.h"
#include "render/passes/passes.h"
#include "render/passes/renderer_impl.h"
#include "render/vk/swapchain.h"

namespace catena::render {
namespace {

/// All passes, in drawing order.
constexpr const PassEntry* kPasses[] = {&kEnvironmentPass, &kWidgetPass, &kMeshPass,       &kStreamlinePass,      &kGlyphPass,
                                        &kSpherePass,      &kCursorPass, &kIsosurfacePass, &kSurfaceColorPass,    &kSlicePass,
                                        &kLineHaloPass,    &kLayersPass, &kRaycastPass,    &kOccludedOverlayPass, &kComposePass,
                                        &kVignettePass,    &kOverlayPass};

Outcome check(const FramePacket& packet, const RenderSettings& settings, const vk::DeviceInfo& device) {
  const std::uint32_t max_size = device.limits.maxImageDimension2D;
  if (packet.width == 0 || packet.height == 0 || packet.width > max_size || packet.height > max_size)
    return Error{fmt::format("an image of {} x {} pixels cannot be rendered, expected 1 to {} in each direction", packet.width,
                             packet.height, max_size)};
  if (!(settings.step_voxels > 0) || !std::isfinite(settings.step_voxels))
    return Error{fmt::format("the ray step is {} voxels, expected a positive number", settings.step_voxels)};
  if (packet.clip_planes.size() > kMaxClipPlanes)
    return Error{fmt::format("the scene has {} clip planes, expected at most {}", packet.clip_planes.size(), kMaxClipPlanes)};
  if (packet.lights.size() > kMaxLights)
    return Error{fmt::format("the scene has {} lights, expected at most {}", packet.lights.size(), kMaxLights)};
  return Done{};
}

/// Returns whether rays of a single view march volumes in pages.
bool marches_pages(const FramePacket& packet) {
  return packet.eyes.empty() && packet.planes.empty() &&
         std::ranges::any_of(packet.volumes, [](const VolumeItem& item) { return item.paged != nullptr; });
}

}  // namespace

Renderer::Renderer() : impl_(std::make_unique<Impl>()) {
  impl_->passes.resize(std::size(kPasses)), impl_->needed_passes.resize(std::size(kPasses));
}
Renderer::~Renderer() = default;

Result<std::unique_ptr<Renderer>> Renderer::create(const vk::DeviceOptions& options) {
  std::unique_ptr<Renderer> self(new Renderer);
  CATENA_TRY(self->impl_->device, vk::Device::create(options));
  self->impl_->residency.emplace(*self->impl_->device);
  return self;
}

std::vector<Pass*> Renderer::Impl::active_passes(std::vector<std::string>* names) const {
  std::vector<Pass*> list;
  for (std::size_t i = 0; i < passes.size(); ++i) {
    if (!passes[i] || !needed_passes[i]) continue;
    list.push_back(passes[i].get());
    if (names) names->push_back(kPasses[i]->name);
  }
  return list;
}

/// Destroys the passes with their pipelines; the next image recreates them.
void Renderer::Impl::drop_passes() {
  for (auto& pass : passes) {
    if (pass) retired_build_ms += pass->build_ms();
    pass.reset();
  }
  stereo_composer.reset();
  window_painter.reset();
  drawn_targets = 0;
}

/// Calls work(), and once more if the memory budget refused an allocation while older frames or the first of several grids held memory.
template <class Work>
auto Renderer::Impl::within_budget(const FramePacket& packet, const Work& work) -> decltype(work()) {
  const std::size_t grids = packet.volumes.size() + packet.isosurfaces.size() + packet.slices.size();
  if (budget_sharers != grids) budget_sharers = 1;
  const std::uint64_t refused = device->counters().refused_allocations;
  const bool held = device->counters().allocated_bytes > 0;
  auto result = reset_on_error(work());
  if (result || device->counters().refused_allocations == refused || !(held || grids > 1)) return result;
  budget_sharers = grids;
  return reset_on_error(work());
}

/// Returns the bytes of the budget that resident grids must not use: targets, their readback copy, layers, and 1 MB of tables and vertices.
std::uint64_t Renderer::Impl::reserved_bytes(const Frame& frame) const {
  TargetSet needed = target::output | target::volume;
  std::uint64_t a_pixel = vk::texel_bytes(targets.output_format);
  for (const PassEntry* entry : kPasses)
    if (entry->is_needed(frame)) {
      needed |= entry->reserved_targets;
      a_pixel += entry->reserved_pixel_bytes;
    }
  const std::uint64_t pixels = std::uint64_t(frame.packet.width) * frame.packet.height;
  if (frame.eye_count > eye_volumes.size() + 1) a_pixel += (frame.eye_count - 1 - eye_volumes.size()) * vk::texel_bytes(kVolumeFormat);
  return pixels * a_pixel + targets.missing_bytes(frame.packet.width, frame.packet.height, needed) + 1'000'000;
}

/// Creates the passes that the packet needs, destroys the others, uploads their data, and fixes the rays and the targets.
Outcome Renderer::Impl::prepare(Frame& frame) {
  targets.output_format = frame.settings.float_image ? kFloatOutputFormat : kOutputFormat;
  if (frame.is_first) residency->begin_frame(reserved_bytes(frame), budget_sharers);
  if (frame.is_first) wanted_passes.assign(passes.size(), false);
  for (std::size_t i = 0; i < passes.size(); ++i) {
    needed_passes[i] = kPasses[i]->is_needed(frame);
    wanted_passes[i] = wanted_passes[i] || needed_passes[i];
    if (!needed_passes[i]) {
      if (passes[i] && frame.is_last && !wanted_passes[i]) {
        retired_build_ms += passes[i]->build_ms();
        passes[i].reset();
      }
      continue;
    }
    if (!passes[i]) {
      CATENA_TRY(passes[i], kPasses[i]->create(*device));
    }
    CATENA_CHECK(passes[i]->prepare(frame));
  }
  if (frame.is_last) residency->drop_unused();
  Bounds bounds, of_rays, of_surfaces;
  TargetSet needed = target::output;
  for (Pass* pass : active_passes()) {
    bounds.extend(pass->bounds());
    if (pass->ray_sampler()) of_rays.extend(pass->bounds());
    if (pass->casts_surface_rays()) of_surfaces.extend(pass->bounds());
    const TargetSet writes = pass->use(frame).writes;
    frame.written_targets |= writes;
    needed |= writes;
  }
  frame.written_targets = 0;
  frame.rays = CameraRays::make(frame.packet, bounds, of_rays.empty() ? of_surfaces : of_rays);
  CATENA_CHECK(light.update(*device, frame.packet, frame.is_first && frame.is_last));
  frame.rays.light_place = light.place();
  return targets.ensure(*device, frame.packet.width, frame.packet.height, needed);
}

/// Records the passes. Consecutive passes with equal targets share one rendering scope. A target is cleared before its first write and made
/// readable before a pass that reads it.
Outcome Renderer::Impl::record(vk::Commands& commands, Frame& frame, const std::vector<Pass*>& list) {
  TargetSet open = 0;
  const auto close = [&] {
    if (open != 0) commands.end_pass();
    open = 0;
  };
  for (Pass* pass : list) {
    const PassUse use = pass->use(frame);
    CATENA_ASSERT((use.reads & ~frame.written_targets) == 0);
    if (use.owns_rendering || use.writes != open || use.reads != 0) close();
    for (TargetSet one = 1; one <= use.reads; one <<= 1)
      if ((use.reads & one) != 0) commands.transition(targets.image(one), vk::kFragmentRead);
    if (!use.owns_rendering) {
      if (open == 0) targets.begin(commands, use.writes, use.writes & ~frame.written_targets);
      open = use.writes;
      commands.set_scissor({{0, 0}, {frame.packet.width, frame.packet.height}});
    }
    CATENA_CHECK(pass->record(commands, frame));
    frame.written_targets |= use.writes;
  }
  close();
  return Done{};
}

/// Draws one view into targets.output.
Outcome Renderer::Impl::draw(const FramePacket& packet, const RenderSettings& settings, std::size_t eye, std::size_t eyes, bool is_first,
                             bool is_last) {
  Frame frame{*device, *residency, targets, packet, settings, {}};
  frame.is_first = is_first;
  frame.is_last = is_last;
  frame.eye_index = eye;
  frame.eye_count = eyes;
  CATENA_CHECK(prepare(frame));
  rendered_passes.clear();
  const std::vector<Pass*> active = active_passes(&rendered_passes);
  const auto writes_depth = [&](const Pass* pass) { return (pass->use(frame).writes & target::opaque_depth) != 0; };
  CATENA_CHECK(hand_shadow.update(frame, std::ranges::any_of(active, writes_depth), ray_sampler()));
  frame.hand_shadow = &hand_shadow;
  CATENA_TRY(vk::Commands commands, vk::Commands::begin(*device));
  CATENA_CHECK(record(commands, frame, active));
  commands.transition(targets.output, vk::kTransferRead);
  CATENA_CHECK(commands.finish());
  drawn_targets = frame.written_targets;
  view_width = packet.width;
  view_height = packet.height;
  reference_depth = frame.rays.reference_depth;
  return draw_ray_depth(frame);
}

RaySampler* Renderer::Impl::ray_sampler() const {
  for (Pass* pass : active_passes())
    if (RaySampler* rays = pass->ray_sampler()) return rays;
  return nullptr;
}

Outcome Renderer::Impl::draw_ray_depth(Frame& frame) {
  ray_depth_spacing = 0;
  const std::uint32_t spacing = frame.settings.ray_depth_spacing;
  RaySampler* rays = ray_sampler();
  if (spacing == 0 || !rays || !rays->has_half_opacity_depth()) return Done{};
  const std::uint32_t width = (frame.packet.width + spacing - 1) / spacing, height = (frame.packet.height + spacing - 1) / spacing;
  CATENA_CHECK(vk::ensure_image(*device, ray_depth, kVolumeFormat, width, height));
  CATENA_TRY(vk::Commands commands, vk::Commands::begin(*device));
  CATENA_CHECK(rays->record_half_opacity_depth(commands, frame, spacing, ray_depth, {{0, 0}, {width, height}}));
  CATENA_CHECK(commands.finish());
  ray_depth_spacing = spacing;
  return Done{};
}

/// Draws the eyes one after the other (passes upload only changes); the first eye is last, so that its depth and ids remain.
Outcome Renderer::Impl::draw_eyes(const FramePacket& packet, const RenderSettings& settings) {
  if (!stereo_composer) stereo_composer.emplace(*device);
  CATENA_CHECK(stereo_composer->begin(packet.packing, packet.eyes.size(), packet.width, packet.height));
  FramePacket one = packet;
  one.eyes.clear();
  eye_volumes.resize(packet.packing == Packing::single ? 0 : packet.eyes.size() - 1);
  for (std::size_t k = eye_volumes.size() + 1; k-- > 0;) {
    one.view = packet.eyes[k];
    if (k > 0) std::swap(targets.volume, eye_volumes[k - 1]);
    CATENA_CHECK(draw(one, settings, k, eye_volumes.size() + 1));
    if (k > 0) std::swap(targets.volume, eye_volumes[k - 1]);
    stereo_composer->store_view(k, targets.output);
  }
  CATENA_TRY(vk::Commands commands, vk::Commands::begin(*device));
  CATENA_CHECK(stereo_composer->record(commands));
  return commands.finish();
}

/// Draws the planes, then the packet itself, so that its depth and ids remain.
Outcome Renderer::Impl::draw_planes(const FramePacket& packet, const RenderSettings& settings) {
  if (!stereo_composer) stereo_composer.emplace(*device);
  const std::size_t count = packet.planes.size();
  CATENA_CHECK(stereo_composer->begin(packet.packing, count + 1, packet.width, packet.height));
  eye_volumes.clear();
  // translucent slices of a plane overwrite the volume image
  RenderSettings anew = settings;
  anew.reuse_rays = false;
  for (std::size_t k = count + 1; k-- > 0;) {
    CATENA_CHECK(draw(k == 0 ? packet : *packet.planes[k - 1], anew, 0, 1, k == count, k == 0));
    stereo_composer->store_view(k, targets.output);
  }
  CATENA_TRY(vk::Commands commands, vk::Commands::begin(*device));
  CATENA_CHECK(stereo_composer->record(commands));
  return commands.finish();
}

/// Images of which each shows pages that the one before did not, until the last one is returned all the same.
constexpr int kMaxPageRounds = 16;

Outcome Renderer::draw(const FramePacket& packet, const RenderSettings& settings) {
  impl_->drawn_targets = 0;
  CATENA_CHECK(check(packet, settings, impl_->device->info()));
  return impl_->within_budget(packet, [&]() -> Outcome {
    if (settings.waits_for_pages && marches_pages(packet)) {
      CATENA_CHECK(load_sampled_pages(packet, settings));
      if (settings.divides_for_pages && paging().finest_level > 0) return Done{};
    }
    CATENA_CHECK(draw_once(packet, settings));
    for (int k = 0; settings.waits_for_pages && k < kMaxPageRounds; ++k) {
      CATENA_TRY(const bool loaded, impl_->load_pages(settings));
      if (!loaded) break;
      CATENA_CHECK(draw_once(packet, settings));
    }
    return Done{};
  });
}

/// Loads the pages that sparse rays visit: most of those of the image, at a small part of its cost.
Outcome Renderer::load_sampled_pages(const FramePacket& packet, const RenderSettings& settings) {
  constexpr std::uint32_t kSpacing = 4;
  for (int k = 0; k < kMaxPageRounds; ++k) {
    CATENA_CHECK(sample_rays_once(packet, settings, kSpacing));
    CATENA_TRY(const bool loaded, impl_->load_pages(settings));
    if (!loaded) break;
  }
  return Done{};
}

Result<bool> Renderer::Impl::load_pages(const RenderSettings& settings) {
  bool loaded = false;
  for (Pass* pass : active_passes())
    for (PagedVolume* pages : pass->pages()) {
      const std::uint64_t before = pages->loaded_count();
      CATENA_CHECK(pages->finish(settings.shows_finest_pages, settings.divides_for_pages));
      loaded = loaded || pages->loaded_count() != before;
    }
  return loaded;
}

Result<Image8> Renderer::sample_rays(const FramePacket& packet, const RenderSettings& settings, std::uint32_t spacing) {
  impl_->drawn_targets = 0;
  CATENA_CHECK(check(packet, settings, impl_->device->info()));
  return impl_->within_budget(packet, [&] { return sample_rays_once(packet, settings, spacing); });
}

Outcome Renderer::draw_once(const FramePacket& packet, const RenderSettings& settings) {
  Impl& p = *impl_;
  p.is_composed = !packet.eyes.empty() || !packet.planes.empty();
  if (!p.is_composed) p.stereo_composer.reset(), p.eye_volumes.clear();
  if (!packet.planes.empty()) return p.draw_planes(packet, settings);
  return p.is_composed ? p.draw_eyes(packet, settings) : p.draw(packet, settings);
}

RenderedImage Renderer::rendered_image() const {
  CATENA_ASSERT(impl_->drawn_targets != 0);
  const vk::Image& shown = impl_->output_image();
  const VkExtent3D& size = shown.info().extent;
  return {shown.handle(), shown.info().format,       {size.width, size.height},
          shown.layout,   impl_->device->timeline(), impl_->device->submitted_value()};
}

vk::Image& Renderer::output_image() {
  CATENA_ASSERT(impl_->drawn_targets != 0);
  return impl_->output_image();
}

std::optional<Renderer::OpaqueDepth> Renderer::opaque_depth() {
  if ((impl_->drawn_targets & target::opaque_depth) == 0) return std::nullopt;
  return OpaqueDepth{&impl_->targets.opaque_depth, impl_->reference_depth};
}

std::optional<Renderer::RayDepth> Renderer::ray_depth() {
  CATENA_ASSERT(impl_->drawn_targets != 0);
  if (impl_->ray_depth_spacing == 0) return std::nullopt;
  return RayDepth{&impl_->ray_depth, impl_->reference_depth, impl_->ray_depth_spacing};
}

vk::Image& Renderer::placeholder_image() { return impl_->targets.placeholder; }

std::uint32_t Renderer::max_image_side() const { return impl_->device->info().limits.maxImageDimension2D; }

bool Renderer::can_draw_fast(const FramePacket& packet) const {
  for (Pass* pass : impl_->active_passes())
    if (const RaySampler* rays = pass->ray_sampler(); rays && rays->was_out_of_memory(packet)) return false;
  return supports_fast_raycast(*impl_->device, packet);
}

bool Renderer::skips_empty_space() const {
  for (Pass* pass : impl_->active_passes())
    if (const RaySampler* rays = pass->ray_sampler(); rays && rays->skips_empty_space()) return true;
  return false;
}

std::array<std::uint32_t, 2> Renderer::view_size() const { return {impl_->view_width, impl_->view_height}; }

/// Paints the window. If the memory does not suffice, frees the passes and resident grids and tries once more; the rendered image remains.
Outcome Renderer::Impl::paint(std::uint32_t width, std::uint32_t height, const UiItems& items) {
  CATENA_ASSERT(drawn_targets != 0);
  if (!window_painter) window_painter.emplace(*device);
  const std::uint64_t refused = device->counters().refused_allocations;
  Outcome painted = window_painter->paint(output_image(), width, height, items);
  if (!painted && device->counters().refused_allocations != refused && residency->count() > 0) {
    for (auto& pass : passes) {
      if (pass) retired_build_ms += pass->build_ms();
      pass.reset();
    }
    residency->clear();
    CATENA_CHECK(device->wait_idle());
    painted = window_painter->paint(output_image(), width, height, items);
  }
  if (!painted) window_painter.reset();
  return painted;
}

Outcome Renderer::paint_window(std::uint32_t width, std::uint32_t height, const UiItems& ui) { return impl_->paint(width, height, ui); }

Result<bool> Renderer::present(vk::Swapchain& swapchain, const UiItems* ui) {
  Impl& p = *impl_;
  CATENA_ASSERT(p.drawn_targets != 0);
  const VkExtent2D extent = swapchain.extent();
  if (extent.width == 0 || extent.height == 0) return false;
  if (ui == nullptr) return swapchain.present(p.output_image());
  CATENA_CHECK(p.paint(extent.width, extent.height, *ui));
  return swapchain.present(p.window_painter->window());
}

vk::Image* Renderer::window_image() {
  return impl_->window_painter && impl_->window_painter->window() ? &impl_->window_painter->window() : nullptr;
}

Result<bool> Renderer::replace_shader(std::string_view name, std::vector<std::uint32_t> words) {
  const auto all = embedded_shaders();
  const auto found = std::ranges::find(all, name, &EmbeddedShader::name);
  if (found == all.end()) return Error{fmt::format("there is no shader \"{}\"", name)};
  const auto bound = vk::declared_bindings(found->words);
  for (const std::uint32_t binding : vk::declared_bindings(words))
    if (!std::ranges::binary_search(bound, binding))
      return Error{fmt::format("{}: binding {} is not one that the program binds, expected the bindings of the shader it was built with",
                               name, binding)};
  vk::ShaderReplacements& shaders = impl_->device->shaders();
  if (std::ranges::equal(shaders.resolve(found->words), words)) return false;
  shaders.replace(found->words, std::move(words));
  impl_->drop_passes();
  return true;
}

void Renderer::restore_shaders() {
  impl_->device->shaders().clear();
  impl_->drop_passes();
}

std::string PagingStats::message() const {
  if (visible == 0) return {};
  std::string text = fmt::format("{} of {} bricks", resident, visible);
  if (finest_level > 0) text += fmt::format(" of level {}: the memory holds no more (--gpu-memory MB, --memory MB)", finest_level);
  return text;
}

PagingStats Renderer::paging() const {
  PagingStats stats;
  for (Pass* pass : impl_->active_passes()) {
    stats.has_arrived = stats.has_arrived || pass->has_new_data();
    for (const PagedVolume* pages : pass->pages()) {
      const PagePlan& plan = pages->plan();
      stats.visible += plan.visible;
      stats.resident += plan.resident;
      stats.finest_level = std::max(stats.finest_level, plan.bias);
      stats.is_loading = stats.is_loading || !plan.loads.empty();
      stats.has_arrived = stats.has_arrived || pages->has_arrived();
    }
  }
  return stats;
}

RenderStats Renderer::stats() const {
  const vk::Device& device = *impl_->device;
  RenderStats stats;
  stats.device = device.info().name;
  stats.driver = device.info().driver;
  stats.gpu_bytes = device.counters().allocated_bytes;
  stats.uploads = device.counters().uploads;
  stats.upload_bytes = device.counters().upload_bytes;
  stats.pipelines = device.counters().pipelines;
  stats.resident_grids = impl_->residency->count();
  stats.resident_bytes = impl_->residency->bytes();
  stats.downsampled_grids = impl_->residency->downsampled_grids();
  stats.gpu_budget = device.info().memory_budget;
  stats.paging = paging();
  stats.passes = impl_->rendered_passes;
  stats.residency_ms = impl_->residency->build_ms() + impl_->retired_build_ms;
  for (Pass* pass : impl_->active_passes()) {
    stats.residency_ms += pass->build_ms();
    stats.resident_bytes += pass->grid_bytes();
    if (std::string note = pass->warning(); !note.empty()) stats.warnings.push_back(std::move(note));
    if (pass->ray_sampler()) stats.rays_reused = pass->ray_sampler()->reused_previous();
    if (!pass->ray_sampler() && pass->reused_previous()) stats.surfaces_reused = true;
  }
  stats.validation_messages = device.messages().count();
  return stats;
}

std::vector<std::string> Renderer::validation_texts() const { return impl_->device->messages().texts(); }
vk::Device& Renderer::device() { return *impl_->device; }

}  // namespace catena::render
