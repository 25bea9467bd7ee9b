// SPDX-License-Identifier: MIT
#include "render/raycast/paged_projection.h"

#include <algorithm>

#include "engine/field/field_display_range.h"

namespace catena::render {
namespace {

constexpr std::uint32_t kPagedProjectionVertexShader[] = {
#include "spirv/fullscreen.vert.inc"
};
constexpr std::uint32_t kPagedProjectionFragmentShader[] = {
#include "spirv/projection_paged.frag.inc"
};

/// Returns the display range of the level in memory, extended to the transfer function's points.
BrickRange table_range(const VolumeItem& item) {
  const DisplayRange& shown = display_range(*item.grid);
  BrickRange range{float(shown.lo), float(shown.hi)};
  const auto extend = [&range](double value) { range = {std::min(range.min, float(value)), std::max(range.max, float(value))}; };
  for (const auto& row : item.transfer.extinctions) extend(row[0]);
  for (const auto& row : item.transfer.colors) extend(row[0]);
  return range;
}

}  // namespace

Outcome PagedProjection::prepare(const VolumeItem& item, std::uint64_t max_bytes, bool loads) {
  const bool other_grid = !pages_ || pages_->grid().version() != item.paged->version();
  if (other_grid) {
    pages_.reset();
    CATENA_TRY(pages_, PagedVolume::create(*device_, {item.paged}, PageFormat::numbers, max_bytes));
  }
  const bool other_table = other_grid || !(item_.transfer == item.transfer);
  const BrickRange range = table_range(item);
  if (other_table || item_.projection != item.projection)
    CATENA_CHECK(pages_->set_codes(number_scale(*item.paged, {range.min, range.max}),
                                   item.projection == Projection::minimum ? SubBrickTexels::minima : SubBrickTexels::maxima));
  if (other_table) {
    opacity_length_ = item.transfer.opacity_length > 0 ? item.transfer.opacity_length : item.paged->mapping().min_voxel_edge();
    lut_ = make_transfer_lut(item.transfer, range, opacity_length_);
    const std::vector<glm::vec4> words = lut_.pack_for_shader();
    CATENA_TRY(table_, vk::upload_buffer(*device_, std::as_bytes(std::span(words)), VK_BUFFER_USAGE_STORAGE_BUFFER_BIT));
  }
  item_ = item;
  return loads ? pages_->update() : Outcome(Done{});
}

Outcome PagedProjection::record(vk::Commands& commands, const CameraRays& rays, const RaySettings& settings, const VkRect2D& area,
                                const RayScene& scene) {
  const field::Mapping& mapping = item_.paged->mapping();
  const CodeScale& codes = pages_->codes().front();
  shared::FrameData data = rays.frame_data();
  data.step_world = float(settings.step_voxels * mapping.min_voxel_edge());
  shared::GridData& grid = data.grids[0];
  grid = rays.grid_data(pages_->local_geometry(), mapping);
  grid.is_clipped = item_.is_clipped;
  grid.value_table = table_data(lut_, 0);
  grid.value_offset = float(codes.lo);
  grid.value_scale = float(codes.per_code);
  grid.opacity = float(opacity_length_);
  const bool is_minimum = item_.projection == Projection::minimum;
  grid.bound_per_code = float(codes.range_step);
  grid.bound_lo = is_minimum ? -float(codes.range_lo + 255 * codes.range_step) : float(codes.range_lo);
  CATENA_CHECK(vk::write_uniform(*device_, uniform_, data));
  pages_->begin_image(rays, false);

  const std::uint32_t kind = item_.projection == Projection::maximum ? 1 : item_.projection == Projection::minimum ? 2 : 3;
  vk::Pipeline& pipeline = pipelines_[{pages_->is_masked(), scene.opaque_depth != nullptr, kind, table_flags(lut_)}];
  if (!pipeline) {
    vk::GraphicsInfo info;
    info.vertex = kPagedProjectionVertexShader;
    info.fragment = kPagedProjectionFragmentShader;
    info.layout_bindings = {{0, vk::DescriptorKind::uniform},
                            {1, vk::DescriptorKind::buffer},
                            {2, vk::DescriptorKind::texture},
                            {3, vk::DescriptorKind::texture},
                            {5, vk::DescriptorKind::texture}};
    add_page_layout(info.layout_bindings);
    info.constants = {0, scene.opaque_depth != nullptr, kind, 0, 0, 0, pages_->is_masked()};
    add_table_flags(info.constants, lut_);
    info.colors = {kVolumeFormat};
    CATENA_TRY(pipeline, vk::Pipeline::create(*device_, info));
  }
  std::vector<vk::Binding> bindings{
      {0, vk::DescriptorKind::uniform, &uniform_, nullptr, nullptr},
      {1, vk::DescriptorKind::buffer, &table_, nullptr, nullptr},
      {2, vk::DescriptorKind::texture, nullptr, scene.opaque_depth ? scene.opaque_depth : scene.placeholder, nullptr},
      {3, vk::DescriptorKind::texture, nullptr, &pages_->words(), nullptr},
      {5, vk::DescriptorKind::texture, nullptr, &pages_->map(), nullptr}};
  pages_->add_bindings(bindings);
  commands.set_scissor(area);
  commands.bind(pipeline, bindings);
  commands.draw_triangle();
  return Done{};
}

}  // namespace catena::render
