#include "render/passes/renderer.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>

#include "engine/base/eye_limits.h"
#include "render/mirror/half.h"
#include "render/passes/pack.h"
#include "render/passes/pass.h"
#include "render/passes/passes.h"
#include "render/passes/ui.h"
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

/// The bytes of an image, by way of a buffer of its own.
template <class T>
Result<std::vector<T>> bytes_of(vk::Device& device, vk::Image& image, std::size_t count) {
  const std::size_t bytes = count * sizeof(T);
  CATENA_TRY(const vk::Buffer buffer, vk::Buffer::create(device, bytes, VK_BUFFER_USAGE_TRANSFER_DST_BIT, vk::Memory::readback));
  CATENA_TRY(vk::Commands commands, vk::Commands::begin(device));
  commands.copy(image, buffer);
  CATENA_CHECK(commands.finish());
  std::vector<T> values(count);
  std::memcpy(values.data(), buffer.bytes().data(), bytes);
  return values;
}

/// One texel of 4 bytes.
void copy_texel(vk::Commands& commands, vk::Image& from, std::uint32_t x, std::uint32_t y, const vk::Buffer& to, VkDeviceSize offset) {
  commands.use(from, vk::kTransferRead);
  VkBufferImageCopy region{};
  region.bufferOffset = offset;
  region.imageSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1};
  region.imageOffset = {std::int32_t(x), std::int32_t(y), 0};
  region.imageExtent = {1, 1, 1};
  vkCmdCopyImageToBuffer(commands.handle(), from.handle(), VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, to.handle(), 1, &region);
}

}  // namespace

struct Renderer::Parts {
  std::unique_ptr<vk::Device> device;  // first in, last out
  std::optional<Mirrors> mirrors;
  Targets targets;
  std::array<std::unique_ptr<Pass>, std::size(kPasses)> passes;
  double gone_build_ms = 0;  ///< of passes that have gone
  TargetSet drawn = 0;       ///< by the last picture
  std::optional<EyePacker> pack;
  std::optional<WindowPainter> ui;
  bool packed = false;                            ///< the last picture is made of several views
  std::uint32_t view_width = 0, view_height = 0;  ///< of one view; its depth and ids
  double reference_depth = 0;
  vk::Image ray_depth;
  std::uint32_t ray_depth_spacing = 0;  ///< of the last picture; 0: it has none
  std::vector<std::string> drawn_passes;
  std::size_t sharers = 1;  ///< grids that must share what the budget leaves

  /// What a failed frame leaves may be half made: all of it goes.
  template <class Outcome_>
  Outcome_ kept_or_dropped(Outcome_ result);
  template <class Work>
  auto within_budget(const FramePacket& packet, const Work& work) -> decltype(work());
  std::uint64_t reserved(const Frame& frame) const;
  std::vector<Pass*> active(std::vector<std::string>* names = nullptr) const;
  vk::Image& shown() { return packed ? pack->picture() : targets.picture; }
  void drop_passes();
  Outcome prepare(Frame& frame);
  Outcome record(vk::Commands& commands, Frame& frame, const std::vector<Pass*>& list);
  Outcome draw(const FramePacket& packet, const RenderSettings& settings);
  Outcome draw_ray_depth(Frame& frame);
  Result<std::uint64_t> count_marks(vk::Image& marks);
  Outcome draw_eyes(const FramePacket& packet, const RenderSettings& settings);
  Outcome paint(std::uint32_t width, std::uint32_t height, const UiItems& items);
};

Renderer::Renderer() : parts_(std::make_unique<Parts>()) {}
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

template <class Outcome_>
Outcome_ Renderer::Parts::kept_or_dropped(Outcome_ result) {
  if (result) return result;
  drop_passes();
  mirrors->clear();
  targets = Targets{};
  return result;
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
Outcome Renderer::Parts::draw(const FramePacket& packet, const RenderSettings& settings) {
  Frame frame{*device, *mirrors, targets, packet, settings, {}};
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
  for (std::size_t k = packet.packing == Packing::single ? 1 : packet.eyes.size(); k-- > 0;) {
    one.view = packet.eyes[k];
    CATENA_CHECK(draw(one, settings));
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
  if (!p.packed) p.pack.reset();
  return p.packed ? p.draw_eyes(packet, settings) : p.draw(packet, settings);
}

DrawnImage Renderer::image() const {
  CATENA_ASSERT(parts_->drawn != 0);
  const vk::Image& shown = parts_->shown();
  const VkExtent3D& size = shown.info().extent;
  return {shown.handle(), shown.info().format,        {size.width, size.height},
          shown.layout,   parts_->device->timeline(), parts_->device->submitted()};
}

Result<Picture> Renderer::read_back() {
  Parts& p = *parts_;
  CATENA_ASSERT(p.drawn != 0 && p.targets.picture.info().format == kPictureFormat);
  Picture picture;
  picture.width = p.shown().info().extent.width;
  picture.height = p.shown().info().extent.height;
  CATENA_TRY(picture.rgba,
             p.kept_or_dropped(bytes_of<std::uint8_t>(*p.device, p.shown(), std::size_t(4) * picture.width * picture.height)));
  return picture;
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

Result<FloatPicture> Renderer::read_back_float() {
  Parts& p = *parts_;
  CATENA_ASSERT(p.drawn != 0 && p.targets.picture.info().format == kFloatPictureFormat);
  FloatPicture picture;
  picture.width = p.targets.picture.info().extent.width;
  picture.height = p.targets.picture.info().extent.height;
  CATENA_TRY(picture.rgba,
             p.kept_or_dropped(bytes_of<float>(*p.device, p.targets.picture, std::size_t(4) * picture.width * picture.height)));
  return picture;
}

std::uint32_t Renderer::longest_side() const { return parts_->device->info().limits.maxImageDimension2D; }

bool Renderer::draws_fast(const FramePacket& packet) const {
  for (Pass* pass : parts_->active())
    if (const RayProbe* rays = pass->probe(); rays && rays->has_refused(packet)) return false;
  return can_be_drawn_fast(*parts_->device, packet);
}

Result<Picture> Renderer::probe_once(const FramePacket& packet, const RenderSettings& settings, std::uint32_t spacing) {
  Parts& p = *parts_;
  Frame frame{*p.device, *p.mirrors, p.targets, packet, settings, {}};
  CATENA_CHECK(p.prepare(frame));

  // all before the rays, whole; then the rays, into an image of their own
  Picture picture;
  picture.width = (packet.width + spacing - 1) / spacing;
  picture.height = (packet.height + spacing - 1) / spacing;
  const std::size_t count = std::size_t(picture.width) * picture.height;
  vk::Image target;
  std::vector<Pass*> before;
  RayProbe* rays = nullptr;
  for (Pass* pass : p.active()) {
    if ((rays = pass->probe())) break;
    if ((pass->use(frame).writes & target::picture) == 0) before.push_back(pass);
  }
  CATENA_TRY(vk::Commands commands, vk::Commands::begin(*p.device));
  CATENA_CHECK(p.record(commands, frame, before));
  if (rays) {
    vk::ImageInfo info;
    info.format = kVolumeFormat;
    info.extent = {picture.width, picture.height, 1};
    info.usage = VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT;
    CATENA_TRY(target, vk::Image::create(*p.device, info));
    if (frame.has(target::opaque_depth)) commands.use(p.targets.opaque_depth, vk::kFragmentRead);
    CATENA_CHECK(rays->record_probe(commands, frame, spacing, target));
  }
  CATENA_CHECK(commands.finish());
  std::vector<float> volume(4 * count);
  std::vector<std::uint16_t> opaque;
  if (rays) {
    CATENA_TRY(volume, bytes_of<float>(*p.device, target, volume.size()));
  }
  if (frame.has(target::opaque_color)) {
    CATENA_TRY(opaque, bytes_of<std::uint16_t>(*p.device, p.targets.opaque_color, 4 * std::size_t(packet.width) * packet.height));
  }

  // volume over opaque over background
  picture.rgba.assign(4 * count, 0);
  const auto to_byte = [](float x) { return std::uint8_t(std::lround(255 * std::clamp(x, 0.0f, 1.0f))); };
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t pixel = spacing * (i / picture.width * packet.width + i % picture.width);
    const float behind = opaque.empty() ? 1 : 1 - float_from_half(opaque[4 * pixel + 3]), through = 1 - volume[4 * i + 3];
    for (std::size_t c = 0; c < 3; ++c) {
      const float sum = behind * packet.background[c] + (opaque.empty() ? 0 : float_from_half(opaque[4 * pixel + c]));
      picture.rgba[4 * i + c] = to_byte(volume[4 * i + c] + through * sum);
    }
    picture.rgba[4 * i + 3] = to_byte(1 - through * behind);
  }
  return picture;
}

Result<DepthPicture> Renderer::read_depth() {
  Parts& p = *parts_;
  CATENA_ASSERT(p.drawn != 0);
  DepthPicture picture;
  picture.width = p.view_width;
  picture.height = p.view_height;
  picture.depth.assign(std::size_t(picture.width) * picture.height, std::numeric_limits<float>::infinity());
  if ((p.drawn & target::opaque_depth) == 0) return picture;
  CATENA_TRY(const std::vector<float> relative,
             p.kept_or_dropped(bytes_of<float>(*p.device, p.targets.opaque_depth, picture.depth.size())));
  for (std::size_t i = 0; i < relative.size(); ++i)
    if (relative[i] < NO_DEPTH) picture.depth[i] = float(double(relative[i]) + p.reference_depth);
  return picture;
}

Result<IdPicture> Renderer::read_ids() {
  Parts& p = *parts_;
  CATENA_ASSERT(p.drawn != 0);
  IdPicture picture;
  picture.width = p.view_width;
  picture.height = p.view_height;
  picture.ids.assign(std::size_t(picture.width) * picture.height, 0);
  if ((p.drawn & target::opaque_id) == 0) return picture;
  CATENA_TRY(picture.ids, p.kept_or_dropped(bytes_of<std::uint32_t>(*p.device, p.targets.opaque_id, picture.ids.size())));
  return picture;
}

/// Texels of an R8_UINT image that are 1.
Result<std::uint64_t> Renderer::Parts::count_marks(vk::Image& marks) {
  const VkExtent3D& size = marks.info().extent;
  CATENA_TRY(const auto bytes, kept_or_dropped(bytes_of<std::uint8_t>(*device, marks, std::size_t(size.width) * size.height)));
  return std::uint64_t(std::ranges::count(bytes, std::uint8_t(1)));
}

Result<MarchedTiles> Renderer::marched_tiles() {
  Parts& p = *parts_;
  constexpr std::uint32_t kTile = 16;
  MarchedTiles tiles;
  tiles.all = tiles.marched = (p.view_width + kTile - 1) / kTile * ((p.view_height + kTile - 1) / kTile);
  for (Pass* pass : p.active()) {
    RayProbe* rays = pass->probe();
    if (!rays || !rays->has_kept()) continue;
    tiles.marched = 0;
    if (vk::Image* changed = rays->changed_tiles()) {
      CATENA_TRY(const std::uint64_t marked, p.count_marks(*changed));
      tiles.marched = std::uint32_t(marked);
    }
  }
  return tiles;
}

Result<std::array<std::uint64_t, 2>> Renderer::refined_rays() {
  Parts& p = *parts_;
  std::array<std::uint64_t, 2> rays{};
  for (Pass* pass : p.active()) {
    if (!pass->probe()) continue;
    const std::array<vk::Image*, 2> blocks = pass->probe()->marked_blocks();
    for (std::size_t k = 0; k < blocks.size(); ++k) {
      if (blocks[k] == nullptr) continue;
      CATENA_TRY(const std::uint64_t marked, p.count_marks(*blocks[k]));
      rays[k] += 16 * marked;
    }
  }
  return rays;
}

Result<Picked> Renderer::pick(std::uint32_t x, std::uint32_t y) {
  Parts& p = *parts_;
  CATENA_ASSERT(p.drawn != 0 && x < p.view_width && y < p.view_height);
  Picked picked{0, std::numeric_limits<double>::infinity()};
  constexpr TargetSet kBoth = target::opaque_depth | target::opaque_id;
  if ((p.drawn & kBoth) != kBoth) return picked;
  const auto read = [&]() -> Outcome {
    CATENA_TRY(const vk::Buffer buffer, vk::Buffer::create(*p.device, 8, VK_BUFFER_USAGE_TRANSFER_DST_BIT, vk::Memory::readback));
    CATENA_TRY(vk::Commands commands, vk::Commands::begin(*p.device));
    copy_texel(commands, p.targets.opaque_depth, x, y, buffer, 0);
    copy_texel(commands, p.targets.opaque_id, x, y, buffer, 4);
    commands.barrier(buffer, vk::kTransferWrite, vk::kHostRead);
    CATENA_CHECK(commands.finish());
    float relative = 0;
    std::memcpy(&relative, buffer.bytes().data(), 4);
    std::memcpy(&picked.id, buffer.bytes().data() + 4, 4);
    if (relative < NO_DEPTH) picked.depth = double(relative) + p.reference_depth;
    return Done{};
  };
  CATENA_CHECK(p.kept_or_dropped(read()));
  return picked;
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

Result<Picture> Renderer::read_back_window() {
  Parts& p = *parts_;
  CATENA_ASSERT(p.ui && p.ui->window());
  vk::Image& window = p.ui->window();
  Picture picture;
  picture.width = window.info().extent.width;
  picture.height = window.info().extent.height;
  CATENA_TRY(picture.rgba, p.kept_or_dropped(bytes_of<std::uint8_t>(*p.device, window, std::size_t(4) * picture.width * picture.height)));
  for (std::size_t i = 3; i < picture.rgba.size(); i += 4) picture.rgba[i] = 255;
  return picture;
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
