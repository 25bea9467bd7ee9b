#include "render/raycast/projection.h"

#include <algorithm>
#include <cmath>

#include "render/vk/commands.h"

namespace catena::render {
namespace {

constexpr std::uint32_t kProjectionVertexShader[] = {
#include "spirv/screen.vert.inc"
};
constexpr std::uint32_t kProjectionFragmentShader[] = {
#include "spirv/projection.frag.inc"
};
constexpr int kBoundCodes = 254;

/// Of -value for a minimum.
BrickRange signed_range(const BrickRange& r, Projection projection) {
  return projection == Projection::minimum ? BrickRange{-r.greatest, -r.least} : r;
}

/// 0: no valid cell; 1 + n: no signed value is above the least one plus n / kBoundCodes of their range.
std::vector<std::uint8_t> bounds_of_bricks(const GridMirror& mirror, const BrickRange& all, Projection projection) {
  std::vector<std::uint8_t> codes(mirror.ranges.size());
  const double per_value = all.greatest > all.least ? kBoundCodes / (double(all.greatest) - all.least) : 0;
  for (std::size_t i = 0; i < codes.size(); ++i) {
    const BrickRange& r = mirror.ranges[i];
    if (r.empty()) continue;
    const double n = std::ceil((double(signed_range(r, projection).greatest) - all.least) * per_value);
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

Outcome ProjectionRaycast::prepare(const VolumeItem& item, std::shared_ptr<const GridMirror> mirror) {
  const bool same_bounds = map_.image && mirror_ == mirror && item_.projection == item.projection;
  const bool same = same_bounds && item_.transfer == item.transfer;
  item_ = item;
  mirror_ = std::move(mirror);
  if (same) return Done{};
  const BrickRange range = range_of(*mirror_);
  opacity_unit_ = item.transfer.opacity_unit > 0 ? item.transfer.opacity_unit : item.grid->mapping().smallest_edge();
  lut_ = make_transfer_lut(item.transfer, range, opacity_unit_);
  const std::vector<glm::vec4> words = lut_.words();
  CATENA_TRY(table_, vk::upload_buffer(*device_, std::as_bytes(std::span(words)), VK_BUFFER_USAGE_STORAGE_BUFFER_BIT));
  if (same_bounds) return Done{};
  bounds_ = signed_range(range, item.projection);
  CATENA_TRY(map_, make_word_map(*device_, *mirror_, bounds_of_bricks(*mirror_, bounds_, item.projection)));
  return Done{};
}

Outcome ProjectionRaycast::record(vk::Commands& commands, const CameraRays& rays, const RaySettings& settings, const VkRect2D& area,
                                  const RayScene& scene) {
  const field::Mapping& mapping = item_.grid->mapping();
  shared::FrameData data = rays.frame();
  data.step_world = float(settings.step_voxels * mapping.smallest_edge());
  shared::GridData& grid = data.grids[0];
  grid = rays.grid(*mirror_, mapping);
  grid.clipped = item_.clipped;
  grid.look = table_data(lut_, 0);
  grid.opacity = float(opacity_unit_);
  grid.bound_lo = bounds_.least;
  grid.bound_per_code = (bounds_.greatest - bounds_.least) / kBoundCodes;
  CATENA_CHECK(vk::write_uniform(*device_, uniform_, data));

  const BoundGrid bound{mirror_, &map_, false, false};
  const std::uint32_t kind = item_.projection == Projection::maximum ? 1 : item_.projection == Projection::minimum ? 2 : 3;
  vk::Pipeline& pipeline = pipelines_[{grid_flags({&bound, 1}), scene.opaque_depth != nullptr, kind + 4 * table_flags(lut_)}];
  if (!pipeline) {
    vk::GraphicsInfo info;
    info.vertex = kProjectionVertexShader;
    info.fragment = kProjectionFragmentShader;
    info.slots = {{0, vk::Resource::uniform}, {1, vk::Resource::buffer}, {2, vk::Resource::texture}};
    add_grid_slots(info.slots, 1);
    info.constants = {grid_flags({&bound, 1}), scene.opaque_depth != nullptr, kind};
    add_table_flags(info.constants, lut_);
    info.colors = {kVolumeFormat};
    CATENA_TRY(pipeline, vk::Pipeline::create(*device_, info));
  }
  std::vector<vk::Binding> bindings{{0, vk::Resource::uniform, &uniform_, nullptr, nullptr},
                                    {1, vk::Resource::buffer, &table_, nullptr, nullptr},
                                    {2, vk::Resource::texture, nullptr, scene.opaque_depth ? scene.opaque_depth : scene.none, nullptr}};
  add_grid_bindings(bindings, {&bound, 1}, 1, linear_);
  commands.scissor(area);
  commands.bind(pipeline, bindings);
  commands.draw_triangle();
  return Done{};
}

}  // namespace catena::render
