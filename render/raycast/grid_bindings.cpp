// SPDX-License-Identifier: MIT
#include "render/raycast/grid_bindings.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace catena::render {
namespace {

constexpr std::uint32_t kValues = 3, kMaps = kValues + MAX_GRIDS, kMasks = kMaps + MAX_GRIDS;

}  // namespace

std::uint32_t grid_flags(std::span<const GridBinding> grids) {
  static_assert(3 * MAX_GRIDS + 2 * MAX_VOLUMES <= 32);
  std::uint32_t flags = 0;
  for (std::size_t i = 0; i < grids.size(); ++i) {
    const GridBinding& g = grids[i];
    flags |= ((g.resident->atlas ? 1u : 0u) | (g.resident->masked ? 2u : 0u) | (g.resident->cubic ? 4u : 0u)) << (3 * i);
    if (i < MAX_VOLUMES) flags |= ((g.is_shaded ? 1u : 0u) | (g.skips_empty ? 2u : 0u)) << (3 * MAX_GRIDS + 2 * i);
  }
  return flags;
}

bool has_cubic_grid(std::uint32_t grid_flags) {
  bool any = false;
  for (std::uint32_t i = 0; i < MAX_GRIDS; ++i) any = any || (grid_flags >> (3 * i) & 4u) != 0;
  return any;
}

void add_grid_layout(std::vector<vk::LayoutBinding>& slots, std::uint32_t count) {
  for (std::uint32_t i = 0; i < count; ++i) {
    slots.push_back({kValues + i, vk::DescriptorKind::sampled});
    slots.push_back({kMaps + i, vk::DescriptorKind::texture});
    slots.push_back({kMasks + i, vk::DescriptorKind::texture});
  }
}

void add_grid_bindings(std::vector<vk::Binding>& bindings, std::span<const GridBinding> grids, std::uint32_t count,
                       const vk::Sampler& linear) {
  for (std::uint32_t i = 0; i < count; ++i) {
    const GridBinding& g = grids[i < grids.size() ? i : 0];
    const vk::Sampler& sampler = g.resident->nearest ? g.resident->point_sampler : linear;
    bindings.push_back({kValues + i, vk::DescriptorKind::sampled, nullptr, &g.resident->values, &sampler});
    bindings.push_back({kMaps + i, vk::DescriptorKind::texture, nullptr, &g.map->image, nullptr});
    // without a mask the shader does not read the binding; the map has the right type
    bindings.push_back({kMasks + i, vk::DescriptorKind::texture, nullptr, g.resident->masked ? &g.resident->mask : &g.map->image, nullptr});
  }
}

Outcome SurfaceState::update(vk::Device& device, const field::ScalarGrid& grid, std::shared_ptr<const ResidentGrid> next_resident,
                             double next_level) {
  const auto rounded = float(next_level);
  if (resident == next_resident && level == rounded && map.image) return Done{};
  resident = std::move(next_resident);
  level = rounded;
  if (resident->cubic) {
    map = {};
    cells = make_cell_map(resident->source(grid), *resident, level, std::numeric_limits<std::uint64_t>::max());
    CATENA_TRY(map.image, upload_cell_map(device, cells));
    cells.texels = {};
    return Done{};
  }
  CATENA_TRY(map, make_brick_map(device, *resident, [this](const BrickRange& r) { return r.min <= level && level <= r.max; }));
  return Done{};
}

shared::GridData surface_data(const CameraRays& rays, const SurfaceState& state, const IsosurfaceItem& item) {
  shared::GridData data = rays.grid_data(*state.resident, item.grid->mapping());
  data.level = state.level;
  data.opacity = item.opacity;
  data.color = {item.color.r, item.color.g, item.color.b};
  data.id = item.id;
  data.is_clipped = item.is_clipped;
  return data;
}

BrickRange value_range(const ResidentGrid& grid) {
  BrickRange all;
  for (const BrickRange& r : grid.brick_ranges) {
    if (r.empty()) continue;
    all = all.empty() ? r : BrickRange{std::min(all.min, r.min), std::max(all.max, r.max)};
  }
  return all.empty() ? BrickRange{0, 0} : all;
}

std::uint32_t table_flags(const TransferLut& lut) { return (lut.has_control_points() ? 1u : 0u) | (lut.has_nonlinear_scale() ? 2u : 0u); }

void add_table_flags(std::vector<std::uint32_t>& constants, const TransferLut& lut) {
  constants.resize(11);
  constants.push_back(table_flags(lut));
}

shared::TableData table_data(const TransferLut& lut, std::uint32_t start) {
  const float first = lut.has_control_points() ? lut.control_values.front() : 0,
              last = lut.has_control_points() ? lut.control_values.back() : 1;
  const float per_linear = lut.has_nonlinear_scale() ? float(1 / lut.linear_below) : 0.0f;
  return {start, lut.last_index(), std::uint32_t(lut.control_points.size()), per_linear, lut.lo, lut.entries_per_unit, first, last};
}

Result<bool> ColorGrid::update(vk::Device& device, std::shared_ptr<const ResidentGrid> next_resident, const ColorSource& next) {
  const bool same_grid = resident == next_resident && map.image;
  ColorSource on_this_grid = next;
  on_this_grid.grid = source.grid;
  if (same_grid && source == on_this_grid) return false;
  resident = std::move(next_resident);
  source = next;
  // alpha marks values that have a color
  TransferTable table{next.colors, {}, {}, 0, next.is_categorical, next.linear_below};
  if (next.is_categorical && next.labels.empty()) table.extinctions = {{-0.5, 1}, {-0.5, 0}, {0.5, 0}, {0.5, 1}};
  for (const double label : next.labels)
    table.extinctions.insert(table.extinctions.end(), {{label - 0.5, 0}, {label - 0.5, 1}, {label + 0.5, 1}, {label + 0.5, 0}});
  lut = make_transfer_lut(table, value_range(*resident), 1);
  if (!next.is_categorical)
    for (std::vector<glm::vec4>* looks : {&lut.entries, &lut.control_points})
      for (glm::vec4& look : *looks) look.a = std::copysign(1.0f, look.a);
  if (!same_grid) {
    CATENA_TRY(map, make_brick_word_map(device, *resident, std::vector<std::uint8_t>(resident->brick_ranges.size())));
  }
  return true;
}

shared::GridData color_data(const CameraRays& rays, const ColorGrid& colors, std::uint32_t start) {
  shared::GridData data = rays.grid_data(*colors.resident, colors.source.grid->mapping());
  data.value_table = table_data(colors.lut, start);
  data.spread_labels = colors.source.spread_labels ? 0.5f : 0;
  return data;
}

}  // namespace catena::render
