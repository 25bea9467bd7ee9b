// SPDX-License-Identifier: MIT
#include "render/raycast/fast_volume.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>

#include "engine/base/clock.h"
#include "render/vk/commands.h"
#include "shaders/shared/fast_volume.h"

namespace catena::render {

namespace {

constexpr std::uint32_t kUpsampleShader[] = {
#include "spirv/upsample.comp.inc"
};
constexpr std::uint32_t kGroupX = 16, kGroupY = 4;  // work group size, as in the shaders

}  // namespace

UpsampleDispatch make_upsample_dispatch(const VkRect2D& area, const VkExtent3D& image_size) {
  UpsampleDispatch groups;
  groups.data.first_x = std::uint32_t(area.offset.x) / 2;
  groups.data.first_y = std::uint32_t(area.offset.y) / 2;
  groups.data.width = image_size.width;
  groups.data.height = image_size.height;
  const auto points = [](std::int32_t first, std::uint32_t extent) {
    return extent == 0 ? 0 : (std::uint32_t(first) % 2 + extent + 1) / 2;
  };
  groups.x = (points(area.offset.x, area.extent.width) + kGroupX - 1) / kGroupX;
  groups.y = (points(area.offset.y, area.extent.height) + kGroupY - 1) / kGroupY;
  return groups;
}

Outcome Upsampler::record(vk::Commands& commands, vk::Image& half_grid, vk::Image* opaque, const vk::Image& none,
                          const std::array<float, 4>& background, bool is_linear, const VkRect2D& area, vk::Image& image_size) {
  vk::Pipeline& pipeline = pipelines_[opaque ? 1 : 0];
  if (!pipeline) {
    vk::ComputeInfo info;
    info.shader = kUpsampleShader;
    info.layout_bindings = {{0, vk::DescriptorKind::uniform},
                            {1, vk::DescriptorKind::texture},
                            {2, vk::DescriptorKind::texture},
                            {3, vk::DescriptorKind::storage_image}};
    info.constants = {opaque ? 1u : 0u};
    CATENA_TRY(pipeline, vk::Pipeline::create(*device_, info));
  }
  const VkExtent3D& size = image_size.info().extent;
  VkRect2D pixels = area;
  if (opaque) {
    pixels = {{0, 0}, {size.width, size.height}};
    commands.transition(*opaque, vk::kFragmentRead);
  } else {
    // outside the area, only the background is visible
    const bool is_opaque = background[3] > 0;
    const vk::ColorTarget target{&image_size, is_opaque ? background : std::array<float, 4>{0, 0, 0, 0}};
    commands.begin_pass({&target, 1}, {});
    commands.end_pass();
  }
  UpsampleDispatch groups = make_upsample_dispatch(pixels, size);
  groups.data.background = background_data(background, is_linear);
  groups.data.is_linear = is_linear ? 1 : 0;
  CATENA_CHECK(vk::write_uniform(*device_, uniform_, groups.data));
  commands.transition(half_grid, vk::kFragmentRead);
  commands.transition(image_size, vk::kComputeWrite);
  const vk::Binding bindings[] = {{0, vk::DescriptorKind::uniform, &uniform_, nullptr, nullptr},
                                  {1, vk::DescriptorKind::texture, nullptr, opaque ? opaque : &none, nullptr},
                                  {2, vk::DescriptorKind::texture, nullptr, &half_grid, nullptr},
                                  {3, vk::DescriptorKind::storage_image, nullptr, &image_size, nullptr}};
  commands.bind(pipeline, bindings);
  if (groups.x > 0 && groups.y > 0) commands.dispatch(groups.x, groups.y, 1);
  commands.transition(image_size, vk::kTransferRead);
  return Done{};
}

namespace {

constexpr std::uint32_t kFastVolumeVertexShader[] = {
#include "spirv/fullscreen.vert.inc"
};
constexpr std::uint32_t kFastVolumeFragmentShader[] = {
#include "spirv/volume_fast.frag.inc"
};
constexpr std::uint32_t kPagedVolumeFragmentShader[] = {
#include "spirv/volume_paged.frag.inc"
};
constexpr std::uint32_t kPagedChannelsFragmentShader[] = {
#include "spirv/channels_paged.frag.inc"
};
constexpr std::uint32_t kFastVolumeTilesShader[] = {
#include "spirv/ray_grid_tiles.vert.inc"
};
constexpr std::uint32_t kFastVolumeInterpolateShader[] = {
#include "spirv/interpolate.comp.inc"
};
constexpr std::uint32_t kFastVolumeMarkShader[] = {
#include "spirv/volume_blocks.frag.inc"
};

/// Distance, in tiles of 16 pixels, at which an opaque item affects a ray grid, by spacing: rays near it are marched and interpolated
/// between.
constexpr int kOpaqueReach[] = {0, 1, 3, 0, 6};
constexpr double kMinSkippableShare = 0.15;  // share of homogeneous bricks from which skipping them pays
constexpr std::uint32_t kBlock = 4, kTileBlocks = 4;
constexpr double kNoRefinement = 1e9;  // an error threshold that interpolation never exceeds
constexpr VkFormat kRayGridFormat = VK_FORMAT_R16G16B16A16_SFLOAT;

/// Returns the size of a ray grid. A coarse one has a margin of two texels before the image's first ray and of four after its last.
std::uint32_t ray_grid_size(std::uint32_t pixels, std::uint32_t spacing) {
  return spacing == 1 ? pixels : (pixels - 1 + spacing - 1) / spacing + 1 + COARSE_APRON + 4;
}

/// Gaze position in pixels, and the tangents that a pixel covers / tangent of the fovea.
struct Gaze {
  decltype(shared::RayGridData::gaze) at{}, per_fovea{};
};
Gaze gaze_of(const FastSettings& settings, const Camera& camera) {
  if (!(settings.fovea_tangent > 0) || camera.orthographic) return {};
  const double x = (settings.gaze_right - camera.center_x + camera.half_width) / (2 * camera.half_width),
               y = (camera.center_y + camera.half_height - settings.gaze_up) / (2 * camera.half_height);
  return {{float(x * camera.width), float(y * camera.height)},
          {float(2 * camera.half_width / (camera.width * settings.fovea_tangent)),
           float(2 * camera.half_height / (camera.height * settings.fovea_tangent))}};
}

/// Returns the texels of a ray grid that the pixels of an area read.
VkRect2D ray_grid_area(const VkRect2D& area, std::uint32_t spacing, const VkExtent3D& extent) {
  if (spacing == 1) return area;
  constexpr std::int32_t margin = 4, apron = COARSE_APRON;
  const auto s = std::int32_t(spacing);
  const auto from = [&](std::int32_t first) { return std::max(0, first / s + apron - margin); };
  const auto to = [&](std::int32_t last, std::uint32_t size) { return std::min(std::int32_t(size), last / s + apron + margin + 1); };
  const std::int32_t x = from(area.offset.x), y = from(area.offset.y);
  const std::int32_t x1 = to(area.offset.x + std::int32_t(area.extent.width), extent.width);
  const std::int32_t y1 = to(area.offset.y + std::int32_t(area.extent.height), extent.height);
  return {{x, y}, {std::uint32_t(std::max(0, x1 - x)), std::uint32_t(std::max(0, y1 - y))}};
}

}  // namespace

Result<FastVolumeRaycast> FastVolumeRaycast::create(vk::Device& device) {
  FastVolumeRaycast self(device);
  CATENA_TRY(self.linear_, vk::Sampler::create(device, vk::Filter::linear));
  CATENA_CHECK(vk::ensure_image(device, self.placeholder_tiles_, VK_FORMAT_R8_UINT, 1, 1));
  CATENA_TRY(self.placeholder_gradients_, vk::Image::create(device, vk::volume_image_info(kGradientFormat, 1, 1, 1)));
  CATENA_CHECK(vk::upload_planes(device, self.placeholder_gradients_, 1,
                                 [](std::uint32_t, std::uint32_t, std::byte* out) { std::memset(out, 0, kGradientBytes); }));
  return self;
}

Outcome FastVolumeRaycast::ensure(RayGrid& level, std::uint32_t spacing, const VkExtent3D& target) {
  const std::uint32_t width = ray_grid_size(target.width, spacing), height = ray_grid_size(target.height, spacing);
  if (spacing > 1) CATENA_CHECK(vk::ensure_image(*device_, level.color, kRayGridFormat, width, height));
  return vk::ensure_image(*device_, level.marks, VK_FORMAT_R8_UINT, (width + kBlock - 1) / kBlock, (height + kBlock - 1) / kBlock,
                          VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT | VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT);
}

Result<const vk::Pipeline*> FastVolumeRaycast::pipeline(const Constants& constants, bool tiles) {
  const bool is_paged = resources_.pages() != nullptr;
  vk::Pipeline& pipeline = pipelines_[{constants, tiles, is_paged}];
  if (!pipeline) {
    vk::GraphicsInfo info;
    info.vertex = tiles ? vk::Spirv(kFastVolumeTilesShader) : vk::Spirv(kFastVolumeVertexShader);
    const bool has_channels = resources_.items().size() > 1;
    info.fragment = has_channels ? vk::Spirv(kPagedChannelsFragmentShader)
                    : is_paged   ? vk::Spirv(kPagedVolumeFragmentShader)
                                 : vk::Spirv(kFastVolumeFragmentShader);
    info.layout_bindings = {{0, vk::DescriptorKind::uniform},
                            {1, vk::DescriptorKind::uniform},
                            {2, vk::DescriptorKind::texture},
                            {3, vk::DescriptorKind::texture},
                            {4, vk::DescriptorKind::texture},
                            {5, vk::DescriptorKind::texture},
                            {6, vk::DescriptorKind::texture},
                            {7, vk::DescriptorKind::texture},
                            {8, vk::DescriptorKind::sampled},
                            {9, vk::DescriptorKind::texture},
                            {vk::kSharedBinding, vk::DescriptorKind::sampled}};
    if (is_paged) add_page_layout(info.layout_bindings);
    info.constants.assign(constants.begin(), constants.end());
    // full resolution goes to the volume target, coarser ray grids to their own images
    info.colors = {constants[4] & 2u ? kVolumeFormat : kRayGridFormat};
    info.constants[4] &= 1u;
    CATENA_TRY(pipeline, vk::Pipeline::create(*device_, info));
  }
  return &pipeline;
}

Outcome FastVolumeRaycast::mark(vk::Commands& commands, RayGrid& level, vk::Image& coarser, bool opaque) {
  vk::Pipeline& pipe = mark_pipelines_[opaque];
  if (!pipe) {
    vk::GraphicsInfo info;
    info.vertex = kFastVolumeVertexShader;
    info.fragment = kFastVolumeMarkShader;
    info.layout_bindings = {{0, vk::DescriptorKind::uniform}, {1, vk::DescriptorKind::texture}, {2, vk::DescriptorKind::texture}};
    info.constants = {opaque};
    info.colors = {VK_FORMAT_R8_UINT};
    CATENA_TRY(pipe, vk::Pipeline::create(*device_, info));
  }
  const vk::ColorTarget target{&level.marks, std::array<float, 4>{0, 0, 0, 0}};
  commands.begin_pass({&target, 1}, {});
  const vk::Binding bindings[] = {
      {0, vk::DescriptorKind::uniform, &level.data, nullptr, nullptr},
      {1, vk::DescriptorKind::texture, nullptr, &coarser, nullptr},
      {2, vk::DescriptorKind::texture, nullptr, opaque ? &eye_state().opaque_tiles->opaque_tiles() : &placeholder_tiles_, nullptr}};
  commands.bind(pipe, bindings);
  commands.draw_triangle();
  commands.end_pass();
  commands.transition(level.marks, vk::kShaderRead);
  return Done{};
}

/// Writes the frame's data; grid 0 is relative to the origin of the packed grid.
Result<shared::FrameData> FastVolumeRaycast::write_frame(const CameraRays& rays, const FastSettings& settings) {
  shared::FrameData frame = rays.frame_data();
  const field::Mapping& mapping = resources_.domain().mapping();
  frame.grids[0] = rays.grid_data(resources_.local_geometry(), mapping);
  frame.grids[0].id = resources_.items().front().id;
  frame.grids[0].is_clipped = resources_.items().front().is_clipped;
  set_scattering(resources_.items().front().scattering, frame.grids[0]);
  frame.termination = float(settings.termination);
  frame.step_world = float(settings.step_voxels * mapping.min_voxel_edge());
  lights_ = rays.light_place.version > 0 || rays.illumination.is_linear ? 2
            : !rays.lights.empty() || !rays.illumination.is_default()   ? 1
                                                                        : 0;
  CATENA_CHECK(vk::write_uniform(*device_, frame_, frame));
  return frame;
}

std::uint32_t FastVolumeRaycast::shaded_channels() const {
  std::uint32_t bits = 0;
  for (std::size_t i = 0; i < resources_.items().size(); ++i) bits |= std::uint32_t{resources_.items()[i].is_shaded} << i;
  return bits;
}

bool FastVolumeRaycast::skips_empty_space() const { return resources_.skippable_share() > kMinSkippableShare; }

Outcome FastVolumeRaycast::draw(vk::Commands& commands, RayGrid& level, const DrawParams& draw) {
  const bool leaps = draw.skips_empty && this->skips_empty_space();
  CATENA_TRY(const vk::Pipeline* pipe,
             pipeline({draw.shading, leaps, draw.opaque_depth != nullptr, draw.coarser != nullptr,
                       (draw.marches ? 1u : 0u) | (draw.target->info().format == kVolumeFormat ? 2u : 0u), resources_.is_regular(),
                       resources_.is_masked(), draw.half_opacity_depth, std::uint32_t(resources_.items().size()), shaded_channels(),
                       resources_.is_dithered(), lights_},
                      draw.tiles != Tiles::all));
  vk::ColorTarget color{draw.target, std::array<float, 4>{0, 0, 0, 0}};
  if (draw.tiles != Tiles::all) color.clear.reset();
  commands.begin_pass({&color, 1}, {});
  std::vector<vk::Binding> bindings{
      {0, vk::DescriptorKind::uniform, &frame_, nullptr, nullptr},
      {1, vk::DescriptorKind::uniform, &level.data, nullptr, nullptr},
      {2, vk::DescriptorKind::texture, nullptr, draw.opaque_depth ? draw.opaque_depth : draw.placeholder, nullptr},
      {3, vk::DescriptorKind::texture, nullptr, &resources_.words(), nullptr},
      {4, vk::DescriptorKind::texture, nullptr, &resources_.table(), nullptr},
      {5, vk::DescriptorKind::texture, nullptr, &resources_.map(), nullptr},
      {6, vk::DescriptorKind::texture, nullptr, draw.coarser ? draw.coarser : draw.placeholder, nullptr},
      {7, vk::DescriptorKind::texture, nullptr, &level.marks, nullptr},
      {8, vk::DescriptorKind::sampled, nullptr,
       draw.shading == 2 && !resources_.pages() ? &resources_.gradients() : &placeholder_gradients_, &linear_},
      {9, vk::DescriptorKind::texture, nullptr, draw.tiles == Tiles::dirty ? &eye_state().opaque_tiles->dirty_tiles() : &placeholder_tiles_,
       nullptr}};
  if (const PagedVolume* pages = resources_.pages()) pages->add_bindings(bindings);
  commands.set_scissor(draw.area);
  commands.bind(*pipe, bindings);
  if (draw.tiles == Tiles::all) {
    commands.draw_triangle();
  } else {
    const VkExtent3D& texels = draw.target->info().extent;
    const auto tiles = [](std::uint32_t count) { return (count + kBlock * kTileBlocks - 1) / (kBlock * kTileBlocks); };
    commands.draw(6, tiles(texels.width) * tiles(texels.height));
  }
  commands.end_pass();
  return Done{};
}

Outcome FastVolumeRaycast::interpolate(vk::Commands& commands, vk::Image& half, vk::Image& target, const VkRect2D& area, bool keep) {
  vk::Pipeline& pipeline = interpolate_pipelines_[keep];
  if (!pipeline) {
    vk::ComputeInfo info;
    info.shader = kFastVolumeInterpolateShader;
    info.layout_bindings = {{0, vk::DescriptorKind::uniform},
                            {1, vk::DescriptorKind::texture},
                            {2, vk::DescriptorKind::storage_image},
                            {3, vk::DescriptorKind::texture}};
    info.constants = {keep};
    CATENA_TRY(pipeline, vk::Pipeline::create(*device_, info));
  }
  if (!keep) {
    const vk::ColorTarget empty{&target, std::array<float, 4>{0, 0, 0, 0}};
    commands.begin_pass({&empty, 1}, {});
    commands.end_pass();
  }
  const UpsampleDispatch groups = make_upsample_dispatch(area, target.info().extent);
  CATENA_CHECK(vk::write_uniform(*device_, interpolate_data_, groups.data));
  commands.transition(half, vk::kFragmentRead);
  commands.transition(target, vk::kComputeWrite);
  const vk::Binding bindings[] = {
      {0, vk::DescriptorKind::uniform, &interpolate_data_, nullptr, nullptr},
      {1, vk::DescriptorKind::texture, nullptr, &half, nullptr},
      {2, vk::DescriptorKind::storage_image, nullptr, &target, nullptr},
      {3, vk::DescriptorKind::texture, nullptr, keep ? &eye_state().opaque_tiles->dirty_tiles() : &placeholder_tiles_, nullptr}};
  commands.bind(pipeline, bindings);
  if (groups.x > 0 && groups.y > 0) commands.dispatch(groups.x, groups.y, 1);
  return Done{};
}

Outcome FastVolumeRaycast::record(vk::Commands& commands, const CameraRays& rays, const FastSettings& settings, const VkRect2D& area,
                                  const VkExtent3D& image_size, vk::Image* target, const vk::Image* opaque_depth, const vk::Image& none,
                                  bool keep) {
  CATENA_ASSERT(settings.spacing == 1 || settings.spacing == 2 || settings.spacing == 4);
  CATENA_ASSERT(target || (settings.ends_at_half_resolution() && !opaque_depth));
  CATENA_TRY(const shared::FrameData frame, write_frame(rays, settings));
  EyeState& eye = eye_state();
  const std::uint64_t version = resources_.version() + (resources_.pages() ? resources_.pages()->version() : 0);
  const ReuseState now{settings, {frame, version, 0, target, target ? target->handle() : VK_NULL_HANDLE, area, opaque_depth != nullptr}};
  const bool same = keep && target && eye.reuse && eye.reuse->state.matches(now.state);
  const bool reuses = reused_previous_ = same && eye.reuse->settings == settings;
  const bool first_is_marched = same && !opaque_depth && settings.spacing > 1 && eye.reuse->settings.marches_same_rays(settings);
  eye.reuse.reset();
  if (resources_.pages()) resources_.pages()->begin_image(rays, same);
  marched_half_ = marched_full_ = false;
  commands.transition(placeholder_tiles_, vk::kShaderRead);
  if (opaque_depth) {
    if (!eye.opaque_tiles) eye.opaque_tiles.emplace(*device_);
    CATENA_CHECK(eye.opaque_tiles->analyze(commands, *opaque_depth));
    if (reuses) CATENA_CHECK(eye.opaque_tiles->find_dirty(commands, kOpaqueReach[settings.spacing]));
  }
  if (reuses && !opaque_depth) {
    eye.reuse = now;
    return Done{};
  }

  // from the coarsest ray grid to full resolution
  const Gaze gaze = gaze_of(settings, rays.camera);
  vk::Image* coarser = nullptr;
  const std::uint32_t finest = target ? 1 : 2;
  for (std::uint32_t spacing = settings.spacing; spacing >= finest; spacing /= 2) {
    RayGrid& level = spacing == 4 ? eye.quarter : spacing == 2 ? eye.half : eye.full;
    CATENA_CHECK(ensure(level, spacing, image_size));
    vk::Image& image = spacing == 1 ? *target : level.color;
    double refine_255 = spacing == 2 ? settings.refine_half_255 : settings.refine_full_255;
    if (opaque_depth && refine_255 < 0) refine_255 = kNoRefinement;
    const bool marches = !coarser || refine_255 >= 0;
    const VkExtent3D from = coarser ? coarser->info().extent : VkExtent3D{1, 1, 1};
    const float apron = spacing == 1 ? 0.0f : float(COARSE_APRON);
    const VkExtent3D& size = image.info().extent;
    const bool refines = coarser && spacing == 1;
    const shared::RayGridData data{float(spacing), apron,       float(refine_255 / 255),     gaze.at,    gaze.per_fovea,
                                   from.width,     from.height, resources_.gradient_nodes(), size.width, size.height,
                                   refines,        reuses};
    CATENA_CHECK(vk::write_uniform(*device_, level.data, data));
    if (coarser && marches) {
      (spacing == 2 ? marched_half_ : marched_full_) = true;
      CATENA_CHECK(mark(commands, level, *coarser, opaque_depth != nullptr));
    } else {
      commands.transition(level.marks, vk::kFragmentRead);
    }
    // most pixels at full resolution are interpolated: first all of them, then the marked tiles are drawn
    if (refines) CATENA_CHECK(interpolate(commands, *coarser, image, area, reuses));
    if (refines && !marches) break;
    const Tiles tiles = reuses ? Tiles::dirty : refines ? Tiles::marked : Tiles::all;
    if (coarser || !first_is_marched)
      CATENA_CHECK(draw(commands, level,
                        {&image, coarser, marches, tiles, shading(settings), settings.skip_empty,
                         ray_grid_area(area, spacing, image.info().extent), opaque_depth, &none}));
    if (spacing > 1) commands.transition(image, vk::kFragmentRead);
    coarser = &image;
  }
  if (target) eye.reuse = now;
  if (resources_.pages()) resources_.pages()->finish_visits(commands);
  return Done{};
}

Outcome FastVolumeRaycast::record_ray_samples(vk::Commands& commands, const CameraRays& rays, const FastSettings& settings,
                                              std::uint32_t spacing, vk::Image& target, const vk::Image* opaque_depth,
                                              const vk::Image& none) {
  const VkExtent3D& extent = target.info().extent;
  return record_samples(commands, rays, settings, spacing,
                        {.target = &target,
                         .shading = shading(settings),
                         .area = {{0, 0}, {extent.width, extent.height}},
                         .opaque_depth = opaque_depth,
                         .placeholder = &none});
}

Outcome FastVolumeRaycast::record_half_opacity_depth(vk::Commands& commands, const CameraRays& rays, const FastSettings& settings,
                                                     std::uint32_t spacing, vk::Image& target, const VkRect2D& area,
                                                     const vk::Image* opaque_depth, const vk::Image& none) {
  return record_samples(commands, rays, settings, spacing,
                        {.target = &target, .area = area, .opaque_depth = opaque_depth, .placeholder = &none, .half_opacity_depth = true});
}

/// Draws rays of a single ray grid, without refinement.
Outcome FastVolumeRaycast::record_samples(vk::Commands& commands, const CameraRays& rays, const FastSettings& settings,
                                          std::uint32_t spacing, DrawParams params) {
  CATENA_ASSERT(params.target->info().format == kVolumeFormat);
  CATENA_CHECK(write_frame(rays, settings));
  CATENA_CHECK(vk::ensure_image(*device_, sample_grid_.marks, VK_FORMAT_R8_UINT, 1, 1));
  commands.transition(sample_grid_.marks, vk::kFragmentRead);
  CATENA_CHECK(vk::write_uniform(*device_, sample_grid_.data,
                                 shared::RayGridData{float(spacing), 0, 0, {}, {}, 1, 1, resources_.gradient_nodes(), 0, 0, 0, 0}));
  params.skips_empty = settings.skip_empty;
  if (resources_.pages()) resources_.pages()->begin_image(rays, false);
  CATENA_CHECK(draw(commands, sample_grid_, params));
  if (resources_.pages()) resources_.pages()->finish_visits(commands);
  return Done{};
}

}  // namespace catena::render
