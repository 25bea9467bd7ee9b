// SPDX-License-Identifier: MIT
#include "render/passes/slice.h"

#include <algorithm>
#include <cfloat>
#include <cmath>
#include <numbers>

#include "engine/geometry/flow/lic.h"
#include "render/passes/passes.h"
#include "render/raycast/camera_rays.h"
#include "render/vk/commands.h"

namespace catena::render {
namespace {

constexpr std::uint32_t kSliceVertexShader[] = {
#include "spirv/fullscreen.vert.inc"
};
constexpr std::uint32_t kSliceFragmentShader[] = {
#include "spirv/slice.frag.inc"
};
constexpr std::uint32_t kSlice = 1, kColors = 2, kLevels = 4, kTexture = 36;
constexpr double kDepthResolution = 4e-6;  ///< share of the distance; resolution of a float depth buffer
constexpr int kSurfaceDepthBias =
    2;  ///< depth bias in units of kDepthResolution, before surfaces in the slice's plane, whose depths are rounded differently
constexpr double kClipSlack = 1e-3;  ///< share of the smallest voxel edge

bool is_opaque(const SliceItem& item) { return item.opacity >= 1; }

}  // namespace

bool is_translucent(const SliceItem& item) { return item.opacity < 1 && (item.opacity > 0 || !item.contour_levels.empty()); }

Result<bool> Slice::prepare(Frame& frame, SlabCache& slabs, const SliceItem& item) {
  grid_ = item.grid;
  if (item.paged) {
    CATENA_TRY(const auto slab, slabs.get(item.paged, item.point, item.normal, frame.settings.waits_for_pages));
    if (slab) grid_ = slab;
  }
  CATENA_TRY(auto resident, frame.resident_grid(*grid_));
  if (!resident->is_drawable) return false;
  if (resident_ != resident) {
    resident_ = std::move(resident);
    CATENA_TRY(map_, make_brick_map(frame.device, *resident_, [](const BrickRange&) { return true; }));
  }
  if (!colors_ || item.colors != item_.colors) {
    std::vector<glm::vec4> rows;
    for (const auto& row : item.colors) rows.emplace_back(float(row[0]), float(row[1]), float(row[2]), float(row[3]));
    CATENA_ASSERT(!rows.empty());
    CATENA_TRY(colors_, vk::upload_buffer(frame.device, std::as_bytes(std::span(rows)), VK_BUFFER_USAGE_STORAGE_BUFFER_BIT));
  }
  if (!levels_ || item.contour_levels != item_.contour_levels) {
    std::vector<float> levels(item.contour_levels.begin(), item.contour_levels.end());
    if (levels.empty()) levels.push_back(0);
    CATENA_TRY(levels_, vk::upload_buffer(frame.device, std::as_bytes(std::span(levels)), VK_BUFFER_USAGE_STORAGE_BUFFER_BIT));
  }
  if (!texture_ || item.texture != item_.texture) {
    static_assert(sizeof(flow::LicTexture::Texel) == 8);
    const std::vector<flow::LicTexture::Texel> none(1);
    const auto& texels = item.texture ? item.texture->texels : none;
    CATENA_TRY(texture_, vk::upload_buffer(frame.device, std::as_bytes(std::span(texels)), VK_BUFFER_USAGE_STORAGE_BUFFER_BIT));
  }
  item_ = item;
  return true;
}

Result<SliceDrawer> SliceDrawer::create(vk::Device& device) {
  SliceDrawer self;
  self.device_ = &device;
  CATENA_TRY(self.linear_, vk::Sampler::create(device, vk::Filter::linear));
  CATENA_TRY(self.placeholder_id_, create_placeholder_id(device));
  return self;
}

Result<const vk::Pipeline*> SliceDrawer::pipeline(std::uint32_t flags, std::uint32_t mode, bool has_opaque) {
  vk::Pipeline& pipeline = pipelines_[{flags, mode, has_opaque}];
  if (!pipeline) {
    vk::GraphicsInfo info;
    info.vertex = kSliceVertexShader;
    info.fragment = kSliceFragmentShader;
    info.layout_bindings = {{0, vk::DescriptorKind::uniform},
                            {kSlice, vk::DescriptorKind::uniform},
                            {kColors, vk::DescriptorKind::buffer},
                            {kLevels, vk::DescriptorKind::buffer},
                            {kTexture, vk::DescriptorKind::buffer}};
    add_grid_layout(info.layout_bindings, 1);
    info.constants = {flags};
    set_peel_stage(info, mode, has_opaque);
    CATENA_TRY(pipeline, vk::Pipeline::create(*device_, info));
  }
  return &pipeline;
}

Outcome SliceDrawer::draw(vk::Commands& commands, const CameraRays& rays, Slice& slice, const PeelState& peel) {
  const SliceItem& item = slice.item_;
  const field::ScalarGrid* grid = &slice.grid();
  // a plane through the camera is seen edge-on: the intersection with a ray is dominated by rounding
  const double away = std::fabs(dot(direction(item.normal), rays.camera.position - item.point));
  if (!rays.camera.orthographic && away < rays.depth_near) return Done{};

  shared::FrameData frame = rays.frame_data();
  frame.grids[0] = rays.grid_data(*slice.resident_, grid->mapping());
  frame.grids[0].id = item.id;
  frame.grids[0].is_clipped = item.is_clipped;
  CATENA_CHECK(vk::write_uniform(*device_, slice.frame_data_, frame));
  shared::SliceData data{};
  data.plane = rays.clip_data({item.point, item.normal});
  data.normal = glm::vec3(direction(item.normal));
  data.clip_slack = float(kClipSlack * grid->mapping().min_voxel_edge());
  data.is_lit = item.lit;
  data.color_last = std::uint32_t(item.colors.size() - 1);
  data.level_count = std::uint32_t(item.contour_levels.size());
  data.line_color = {item.line_color.r, item.line_color.g, item.line_color.b};
  data.half_width = 0.5f * item.line_width;
  data.depth_bias = float(kDepthResolution * (kSurfaceDepthBias + item.stack_order));
  data.hidden_label = item.hidden_label ? float(*item.hidden_label) : NAN;
  const auto to_float = [](double value) { return float(std::clamp(value, -double(FLT_MAX), double(FLT_MAX))); };
  const Threshold ranges = item.threshold.empty() ? Threshold{{-FLT_MAX, FLT_MAX}} : item.threshold;
  data.threshold = {to_float(ranges.front()[0]), to_float(ranges.front()[1]), to_float(ranges.back()[0]), to_float(ranges.back()[1])};
  if (item.texture) {
    const flow::LicPlane& plane = item.texture->plane;
    data.texture_u = rays.clip_data({plane.origin, plane.u});
    data.texture_v = rays.clip_data({plane.origin, plane.v});
    data.texels_per_unit = float(1 / plane.texel_size);
    data.texture_width = std::uint32_t(plane.width);
    data.texture_height = std::uint32_t(plane.height);
    data.texture_strength = item.texture_strength;
    const double angle = 2 * std::numbers::pi * double(item.texture_phase);
    data.texture_phase = {float(std::cos(angle)), float(std::sin(angle))};
  }
  CATENA_CHECK(vk::write_uniform(*device_, slice.slice_data_, data));
  CATENA_CHECK(vk::write_uniform(*device_, slice.layer_data_, layer_data(rays, item.opacity)));

  const GridBinding bound{slice.resident_, &slice.map_, false, true};
  CATENA_TRY(const vk::Pipeline* pipe, pipeline(grid_flags({&bound, 1}), peel.mode, peel.opaque_depth != nullptr));
  std::vector<vk::Binding> bindings{{0, vk::DescriptorKind::uniform, &slice.frame_data_, nullptr, nullptr},
                                    {kSlice, vk::DescriptorKind::uniform, &slice.slice_data_, nullptr, nullptr},
                                    {kColors, vk::DescriptorKind::buffer, &slice.colors_, nullptr, nullptr},
                                    {kLevels, vk::DescriptorKind::buffer, &slice.levels_, nullptr, nullptr},
                                    {kTexture, vk::DescriptorKind::buffer, &slice.texture_, nullptr, nullptr}};
  add_grid_bindings(bindings, {&bound, 1}, 1, linear_);
  add_peel_bindings(bindings, peel, slice.layer_data_);
  const field::Field* const domain = grid;
  commands.set_scissor(covered_area({&domain, 1}, rays.camera));
  commands.bind(*pipe, bindings);
  commands.draw_triangle();
  return Done{};
}

Outcome prepare_slices(Frame& frame, SlabCache& slabs, std::vector<Slice>& slices, bool (*chosen)(const SliceItem&)) {
  std::size_t count = 0;
  for (const SliceItem& item : frame.packet.slices) {
    if (!chosen(item)) continue;
    if (count == slices.size()) slices.emplace_back();
    CATENA_TRY(const bool drawn, slices[count].prepare(frame, slabs, item));
    if (drawn) ++count;
  }
  while (slices.size() > count) slices.pop_back();
  return Done{};
}

namespace {

/// Draws the opaque slices; LayersPass draws the translucent ones.
class SlicePass final : public Pass {
 public:
  static Result<std::unique_ptr<Pass>> create(vk::Device& device) {
    CATENA_TRY(SliceDrawer drawer, SliceDrawer::create(device));
    return std::unique_ptr<Pass>(new SlicePass(std::move(drawer)));
  }
  PassUse use(const Frame&) const override { return {0, target::opaque}; }
  Outcome prepare(Frame& frame) override { return prepare_slices(frame, slabs_, slices_, is_opaque); }
  bool has_new_data() const override { return slabs_.has_arrived(); }
  Bounds bounds() const override {
    Bounds all;
    for (const Slice& slice : slices_) all.extend(slice.grid().world_bounds());
    return all;
  }
  Outcome record(vk::Commands& commands, Frame& frame) override {
    PeelState peel;
    peel.placeholder = &frame.targets.placeholder;
    peel.placeholder_id = &drawer_.placeholder_id();
    for (Slice& slice : slices_) CATENA_CHECK(drawer_.draw(commands, frame.rays, slice, peel));
    return Done{};
  }

 private:
  explicit SlicePass(SliceDrawer drawer) : drawer_(std::move(drawer)) {}
  SliceDrawer drawer_;
  SlabCache slabs_;
  std::vector<Slice> slices_;
};

}  // namespace

const PassEntry kSlicePass{
    "slices", [](const Frame& frame) { return std::any_of(frame.packet.slices.begin(), frame.packet.slices.end(), is_opaque); },
    SlicePass::create};

}  // namespace catena::render
