// SPDX-License-Identifier: MIT
#include "render/raycast/projection.h"

#include <algorithm>
#include <cmath>

#include "render/vk/commands.h"

namespace catena::render {
namespace {

constexpr std::uint32_t kProjectionVertexShader[] = {
#include "spirv/fullscreen.vert.inc"
};
constexpr std::uint32_t kProjectionFragmentShader[] = {
#include "spirv/projection.frag.inc"
};
constexpr int kBoundCodes = 254;

/// Returns the range of the signed value: -value for a minimum projection, value otherwise.
BrickRange signed_range(const BrickRange& r, Projection projection) {
  return projection == Projection::minimum ? BrickRange{-r.max, -r.min} : r;
}

/// Returns a code per brick. 0: no valid cell. 1 + n: its signed values are at most all.min + n / kBoundCodes of the range `all`.
std::vector<std::uint8_t> bounds_of_bricks(const ResidentGrid& resident, const BrickRange& all, Projection projection) {
  std::vector<std::uint8_t> codes(resident.brick_ranges.size());
  const double per_value = all.max > all.min ? kBoundCodes / (double(all.max) - all.min) : 0;
  for (std::size_t i = 0; i < codes.size(); ++i) {
    const BrickRange& r = resident.brick_ranges[i];
    if (r.empty()) continue;
    const double n = std::ceil((double(signed_range(r, projection).max) - all.min) * per_value);
    codes[i] = std::uint8_t(1 + std::clamp(n, 0.0, double(kBoundCodes)));
  }
  return codes;
}

}  // namespace

Result<ProjectionRaycast> ProjectionRaycast::create(vk::Device& device) {
  ProjectionRaycast self;
  self.device_ = &device;
  CATENA_TRY(self.linear_, vk::Sampler::create(device, vk::Filter::linear));
  return self;
}

Outcome ProjectionRaycast::prepare(const VolumeItem& item, std::shared_ptr<const ResidentGrid> resident) {
  const bool same_bounds = map_.image && resident_ == resident && item_.projection == item.projection;
  const bool same = same_bounds && item_.transfer == item.transfer;
  item_ = item;
  resident_ = std::move(resident);
  if (same) return Done{};
  const BrickRange range = value_range(*resident_);
  opacity_length_ = item.transfer.opacity_length > 0 ? item.transfer.opacity_length : item.grid->mapping().min_voxel_edge();
  lut_ = make_transfer_lut(item.transfer, range, opacity_length_);
  const std::vector<glm::vec4> words = lut_.pack_for_shader();
  CATENA_TRY(table_, vk::upload_buffer(*device_, std::as_bytes(std::span(words)), VK_BUFFER_USAGE_STORAGE_BUFFER_BIT));
  if (same_bounds) return Done{};
  signed_range_ = signed_range(range, item.projection);
  CATENA_TRY(map_, make_brick_word_map(*device_, *resident_, bounds_of_bricks(*resident_, signed_range_, item.projection)));
  return Done{};
}

Outcome ProjectionRaycast::record(vk::Commands& commands, const CameraRays& rays, const RaySettings& settings, const VkRect2D& area,
                                  const RayScene& scene) {
  const field::Mapping& mapping = item_.grid->mapping();
  shared::FrameData data = rays.frame_data();
  data.step_world = float(settings.step_voxels * mapping.min_voxel_edge());
  shared::GridData& grid = data.grids[0];
  grid = rays.grid_data(*resident_, mapping);
  grid.is_clipped = item_.is_clipped;
  grid.value_table = table_data(lut_, 0);
  grid.opacity = float(opacity_length_);
  grid.bound_lo = signed_range_.min;
  grid.bound_per_code = (signed_range_.max - signed_range_.min) / kBoundCodes;
  CATENA_CHECK(vk::write_uniform(*device_, uniform_, data));

  const GridBinding bound{resident_, &map_, false, false};
  const std::uint32_t kind = item_.projection == Projection::maximum ? 1 : item_.projection == Projection::minimum ? 2 : 3;
  vk::Pipeline& pipeline = pipelines_[{grid_flags({&bound, 1}), scene.opaque_depth != nullptr, kind + 4 * table_flags(lut_)}];
  if (!pipeline) {
    vk::GraphicsInfo info;
    info.vertex = kProjectionVertexShader;
    info.fragment = kProjectionFragmentShader;
    info.layout_bindings = {{0, vk::DescriptorKind::uniform}, {1, vk::DescriptorKind::buffer}, {2, vk::DescriptorKind::texture}};
    add_grid_layout(info.layout_bindings, 1);
    info.constants = {grid_flags({&bound, 1}), scene.opaque_depth != nullptr, kind};
    add_table_flags(info.constants, lut_);
    info.colors = {kVolumeFormat};
    CATENA_TRY(pipeline, vk::Pipeline::create(*device_, info));
  }
  std::vector<vk::Binding> bindings{
      {0, vk::DescriptorKind::uniform, &uniform_, nullptr, nullptr},
      {1, vk::DescriptorKind::buffer, &table_, nullptr, nullptr},
      {2, vk::DescriptorKind::texture, nullptr, scene.opaque_depth ? scene.opaque_depth : scene.placeholder, nullptr}};
  add_grid_bindings(bindings, {&bound, 1}, 1, linear_);
  commands.set_scissor(area);
  commands.bind(pipeline, bindings);
  commands.draw_triangle();
  return Done{};
}

}  // namespace catena::render
