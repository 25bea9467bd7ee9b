// SPDX-License-Identifier: MIT
#include "render/extract/legends.h"

#include "engine/scene/color_maps.h"
#include "engine/scene/labels.h"
#include "engine/scene/units.h"
#include "render/extract/extract_internal.h"

namespace catena::render {
namespace {

using Source = scene::ColorBy::Source;

std::vector<std::array<double, 4>> rows_of(const ColorTable& points) {
  std::vector<std::array<double, 4>> rows;
  for (const auto& point : points) rows.push_back({point.value, point.color.r, point.color.g, point.color.b});
  return rows;
}

/// Returns a name with its unit, as "velocity (m/s)".
std::string with_unit(const std::string& name, const std::string& unit) { return unit.empty() ? name : name + " (" + unit + ")"; }

std::string field_name(const scene::Scene& scene, scene::Entity field) {
  return with_unit(entity_name(scene, field), scene::unit_of(scene, field));
}

/// Returns the labels whose colors "color_by" shows; null: none.
const scene::LabelMap* labels_of(const scene::Scene& scene, const scene::ColorBy& by) {
  return shows_labels(scene, by.field, by.colors, by.named) ? find_label_map(scene, by.field) : nullptr;
}

/// Makes the legend of colors by `by`, with the threshold of its scale.
Legend make_legend(std::vector<std::array<double, 4>> colors, std::string name, const scene::ColorBy& by,
                   const scene::LabelMap* labels = nullptr) {
  if (colors.empty()) return {};
  const double threshold = scene::linear_below(by.named.mapping, colors.front()[0], colors.back()[0]);
  return {std::move(colors), std::move(name), labels, threshold};
}

}  // namespace

Legend colored_legend(const scene::Scene& scene, const ColorTable* table, const std::optional<scene::ColorBy>& by, scene::Entity field) {
  if (table == nullptr || !by) return {};
  switch (by->source) {
    case Source::field:
      return make_legend(rows_of(*table), field_name(scene, by->field), *by, field ? labels_of(scene, *by) : nullptr);
    case Source::speed:
      return make_legend(rows_of(*table), with_unit("|" + entity_name(scene, field) + "|", scene::unit_of(scene, field)), *by);
    case Source::value:
      return make_legend(rows_of(*table), by->value_name, *by);
    case Source::arc_length:
      return make_legend(rows_of(*table), with_unit("arc length", scene::length_unit(scene)), *by);
  }
  return {};
}

Legend volume_legend(const scene::Scene& scene, scene::Entity item, const FramePacket&) {
  const scene::Volume& volume = scene.entities.get<scene::Volume>(item);
  const bool states = volume.where.find("color") != nullptr || volume.where.find("transfer") != nullptr;
  Legend legend{rows_of(volume.transfer.colors), field_name(scene, volume.field), states ? nullptr : find_label_map(scene, volume.field)};
  if (legend.colors.empty()) return legend;
  const scene::ValueMapping& mapping = volume.transfer.named.mapping;
  // the threshold of a volume's symlog scale follows from its opacities, too
  legend.linear_below = mapping.kind == scene::ValueMapping::Kind::symlog
                            ? scene::linear_below(volume.transfer)
                            : scene::linear_below(mapping, legend.colors.front()[0], legend.colors.back()[0]);
  return legend;
}

Legend isosurface_legend(const scene::Scene& scene, scene::Entity item, const FramePacket&) {
  const scene::ColorBy& by = *scene.entities.get<scene::Isosurface>(item).color_by;
  const field::AnyField& any = rendered_field(scene, by.field);
  if (!any.scalar) return {};
  const DisplayRange range = field::display_range(*any.scalar);
  return make_legend(rows_of(make_display_color_table(scene, by.field, by.colors, by.named, range.lo, range.hi)),
                     field_name(scene, by.field), by, labels_of(scene, by));
}

Legend slice_legend(const scene::Scene& scene, scene::Entity item, const FramePacket& packet) {
  // packet.slices are in the order of the entities, without the hidden ones
  std::size_t i = 0, found = packet.slices.size();
  scene.entities.each<scene::Slice>([&](scene::Entity e, const scene::Slice&) {
    if (is_hidden(scene.entities, e)) return;
    if (e == item) found = i;
    ++i;
  });
  if (found >= packet.slices.size()) return {};
  const scene::ColorBy& by = scene.entities.get<scene::Slice>(item).color_by;
  return make_legend(packet.slices[found].colors, field_name(scene, by.field), by, labels_of(scene, by));
}

}  // namespace catena::render
