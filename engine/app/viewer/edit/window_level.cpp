// SPDX-License-Identifier: MIT
#include "engine/app/viewer/edit/window_level.h"

#include <algorithm>

#include "engine/app/viewer/edit/histogram_cache.h"
#include "engine/app/viewer/edit/transfer_editing.h"
#include "engine/field/field_display_range.h"
#include "engine/scene/color_maps.h"
#include "engine/scene/labels.h"
#include "engine/scene/to_json.h"
#include "engine/scene/visibility.h"

namespace catena::app {

namespace {

using Range = std::array<double, 2>;

/// Rendered scalar grid of a field; nullptr: not loaded, or a label map, whose values have colors of their own.
const field::ScalarGrid* valued_grid(const scene::Scene& scene, scene::Entity field) {
  const field::AnyField& any = scene.entities.get<scene::FieldSource>(field).rendered;
  return any.scalar && scene::find_label_map(scene, field) == nullptr ? any.scalar->grid() : nullptr;
}

Range changed_range(const Range& range, const DisplayRange& data, double wider, double higher) {
  const double whole = data.lo < data.hi ? data.hi - data.lo : 1;
  const double width = std::max(1e-3 * whole, range[1] - range[0] + wider * whole);
  const double level = 0.5 * (range[0] + range[1]) + higher * whole;
  return {round_within(level - 0.5 * width, data.lo, data.lo + whole), round_within(level + 0.5 * width, data.lo, data.lo + whole)};
}

}  // namespace

TextEdits make_window_level_edits(const scene::Scene& scene, double wider, double higher) {
  for (const scene::Entity e : scene::visible_entities<scene::Volume>(scene.entities)) {
    const scene::Volume& volume = scene.entities.get<scene::Volume>(e);
    const field::ScalarGrid* grid = valued_grid(scene, volume.field);
    const auto edit = grid != nullptr ? make_transfer_edit(volume, grid->mapping().min_voxel_edge()) : std::nullopt;
    const auto range = edit ? value_range(edit->colors, edit->opacities) : std::nullopt;
    if (!range) continue;
    const Range now = changed_range(*range, field::display_range(*grid), wider, higher);
    return make_range_edits(volume, *edit, now[0], now[1]);
  }
  for (const scene::Entity e : scene::visible_entities<scene::Slice>(scene.entities)) {
    const scene::Slice& slice = scene.entities.get<scene::Slice>(e);
    const field::ScalarGrid* grid = valued_grid(scene, slice.color_by.field);
    if (grid == nullptr || !slice.color_by.colors.empty()) continue;
    const DisplayRange& data = field::display_range(*grid);
    const Range now = changed_range(slice.color_by.named.range.value_or(Range{data.lo, data.hi}), data, wider, higher);
    if (!scene::is_color_range(now[0], now[1])) return {};
    return {{item_pointer(slice.where) + "/range", scene::to_json(now)}};
  }
  return {};
}

}  // namespace catena::app
