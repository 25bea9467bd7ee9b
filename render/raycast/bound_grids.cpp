#include "render/raycast/bound_grids.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace catena::render {
namespace {

constexpr std::uint32_t kValues = 3, kMaps = kValues + MAX_GRIDS, kMasks = kMaps + MAX_GRIDS;

}  // namespace

std::uint32_t grid_flags(std::span<const BoundGrid> grids) {
  static_assert(3 * MAX_GRIDS + 2 * MAX_VOLUMES <= 32);
  std::uint32_t flags = 0;
  for (std::size_t i = 0; i < grids.size(); ++i) {
    const BoundGrid& g = grids[i];
    flags |= ((g.mirror->atlas ? 1u : 0u) | (g.mirror->masked ? 2u : 0u) | (g.mirror->cubic ? 4u : 0u)) << (3 * i);
    if (i < MAX_VOLUMES) flags |= ((g.shaded ? 1u : 0u) | (g.skips ? 2u : 0u)) << (3 * MAX_GRIDS + 2 * i);
  }
  return flags;
}

bool any_cubic(std::uint32_t grid_flags) {
  bool any = false;
  for (std::uint32_t i = 0; i < MAX_GRIDS; ++i) any = any || (grid_flags >> (3 * i) & 4u) != 0;
  return any;
}

void add_grid_slots(std::vector<vk::Slot>& slots, std::uint32_t count) {
  for (std::uint32_t i = 0; i < count; ++i) {
    slots.push_back({kValues + i, vk::Resource::sampled});
    slots.push_back({kMaps + i, vk::Resource::texture});
    slots.push_back({kMasks + i, vk::Resource::texture});
  }
}

void add_grid_bindings(std::vector<vk::Binding>& bindings, std::span<const BoundGrid> grids, std::uint32_t count,
                       const vk::Sampler& linear) {
  for (std::uint32_t i = 0; i < count; ++i) {
    const BoundGrid& g = grids[i < grids.size() ? i : 0];
    const vk::Sampler& sampler = g.mirror->nearest ? g.mirror->one : linear;
    bindings.push_back({kValues + i, vk::Resource::sampled, nullptr, &g.mirror->values, &sampler});
    bindings.push_back({kMaps + i, vk::Resource::texture, nullptr, &g.map->image, nullptr});
    // without a mask the binding is never read; the map has the right type
    bindings.push_back({kMasks + i, vk::Resource::texture, nullptr, g.mirror->masked ? &g.mirror->mask : &g.map->image, nullptr});
  }
}

Outcome SurfaceState::update(vk::Device& device, const field::ScalarGrid& grid, std::shared_ptr<const GridMirror> next_mirror,
                             double next_level) {
  const auto rounded = float(next_level);
  if (mirror == next_mirror && level == rounded && map.image) return Done{};
  mirror = std::move(next_mirror);
  level = rounded;
  if (mirror->cubic) {
    map = {};
    cells = make_cell_map(mirror->source(grid), *mirror, level, std::numeric_limits<std::uint64_t>::max());
    CATENA_TRY(map.image, upload_cell_map(device, cells));
    cells.texels = {};
    return Done{};
  }
  CATENA_TRY(map, make_brick_map(device, *mirror, [this](const BrickRange& r) { return r.least <= level && level <= r.greatest; }));
  return Done{};
}

shared::GridData surface_data(const CameraRays& rays, const SurfaceState& state, const IsosurfaceItem& item) {
  shared::GridData data = rays.grid(*state.mirror, item.grid->mapping());
  data.level = state.level;
  data.opacity = item.opacity;
  data.color = {item.color.r, item.color.g, item.color.b};
  data.id = item.id;
  data.clipped = item.clipped;
  return data;
}

BrickRange range_of(const GridMirror& mirror) {
  BrickRange all;
  for (const BrickRange& r : mirror.ranges) {
    if (r.empty()) continue;
    all = all.empty() ? r : BrickRange{std::min(all.least, r.least), std::max(all.greatest, r.greatest)};
  }
  return all.empty() ? BrickRange{0, 0} : all;
}

std::uint32_t table_flags(const TransferLut& lut) { return (lut.has_points() ? 1u : 0u) | (lut.is_scaled() ? 2u : 0u); }

void add_table_flags(std::vector<std::uint32_t>& constants, const TransferLut& lut) {
  constants.resize(11);
  constants.push_back(table_flags(lut));
}

shared::TableData table_data(const TransferLut& lut, std::uint32_t start) {
  const float first = lut.has_points() ? lut.values.front() : 0, last = lut.has_points() ? lut.values.back() : 1;
  const float per_linear = lut.is_scaled() ? float(1 / lut.linear_below) : 0.0f;
  return {start, lut.last(), std::uint32_t(lut.points.size()), per_linear, lut.lo, lut.per_unit, first, last};
}

Result<bool> ColorGrid::update(vk::Device& device, std::shared_ptr<const GridMirror> next_mirror, const ColorSource& next) {
  const bool same_grid = mirror == next_mirror && map.image;
  if (same_grid && source.colors == next.colors && source.labels == next.labels && source.linear_below == next.linear_below) return false;
  mirror = std::move(next_mirror);
  source = next;
  // alpha says where there is a colour: of labels everywhere but at 0
  TransferTable table{next.colors, {}, {}, 0, next.labels, next.linear_below};
  if (next.labels) table.extinctions = {{-0.5, 1}, {-0.5, 0}, {0.5, 0}, {0.5, 1}};
  lut = make_transfer_lut(table, range_of(*mirror), 1);
  if (!next.labels)
    for (std::vector<glm::vec4>* looks : {&lut.entries, &lut.points})
      for (glm::vec4& look : *looks) look.a = std::copysign(1.0f, look.a);
  if (!same_grid) {
    CATENA_TRY(map, make_word_map(device, *mirror, std::vector<std::uint8_t>(mirror->ranges.size())));
  }
  return true;
}

shared::GridData color_data(const CameraRays& rays, const ColorGrid& colors, std::uint32_t start) {
  shared::GridData data = rays.grid(*colors.mirror, colors.source.grid->mapping());
  data.look = table_data(colors.lut, start);
  data.spread = colors.source.spread ? 0.5f : 0;
  return data;
}

}  // namespace catena::render
