// SPDX-License-Identifier: MIT
#include "engine/scene/labels.h"

#include <algorithm>
#include <cmath>

#include "engine/base/numbers.h"
#include "engine/base/system_failure.h"
#include "engine/base/text.h"
#include "engine/scene/color_maps.h"
#include "engine/scene/label_palette.h"

namespace catena::scene {

const LabelEntry* LabelMap::find(double value) const {
  const auto it = std::lower_bound(labels.begin(), labels.end(), value, [](const LabelEntry& l, double v) { return l.value < v; });
  return it != labels.end() && it->value == value ? &*it : nullptr;
}

std::shared_ptr<const LabelMap> make_label_map(const field::ScalarGrid& grid, const LabelTable& table) {
  auto counts = field::count_labels(grid);
  if (!counts) return nullptr;
  auto map = std::make_shared<LabelMap>();
  map->counts = std::move(*counts);
  std::size_t palette_index =
      table.size();  // the first colors are reserved for the rows of the table, including rows that are not in this map
  for (const field::LabelCount& count : map->counts) {
    if (count.value == 0) continue;
    LabelEntry label{count.value, {}, {}, count.voxels};
    const auto row = std::lower_bound(table.begin(), table.end(), count.value, [](const LabelRow& l, double v) { return l.value < v; });
    const bool known = row != table.end() && row->value == count.value;
    if (known) label.name = row->name;
    if (known && row->color)
      label.color = *row->color;
    else
      label.color = palette_color(known ? static_cast<std::size_t>(row - table.begin()) : palette_index++);
    map->labels.push_back(std::move(label));
  }
  return map;
}

void load_label_map(FieldSource& source) {
  const field::ScalarGrid* grid = source.loaded.scalar ? source.loaded.scalar->grid() : nullptr;
  if (grid != nullptr && grid->interpolation() == field::Interpolation::nearest && !source.labels)
    source.labels = make_label_map(*grid, source.labels_table);
}

const LabelMap* find_label_map(const Scene& scene, Entity field) { return scene.entities.get<FieldSource>(field).labels.get(); }

std::string describe_label(const LabelMap& map, double value) {
  if (value == 0) return "no label";
  const LabelEntry* label = map.find(value);
  return label == nullptr || label->name.empty() ? to_text(value) : label->name + " (" + to_text(value) + ")";
}

namespace {

/// Returns the label map from which a surface is extracted; a null entity: the scene has none of that name.
Entity map_of(const Scene& scene, const LabelSource& source) { return find_field(scene, source.label_map); }

/// Returns the label values that the source selects, by number or by name.
Result<std::vector<double>> values_of(const LabelSource& source, const LabelMap& map, const json::Node& where) {
  std::vector<double> values = source.values;
  for (const std::string& name : source.names) {
    const auto named = std::find_if(map.labels.begin(), map.labels.end(), [&](const LabelEntry& label) { return label.name == name; });
    if (named == map.labels.end()) {
      std::vector<std::string_view> names;
      for (const LabelEntry& label : map.labels)
        if (!label.name.empty()) names.push_back(label.name);
      return json::error_at(where, "label map " + in_quotes(source.label_map) + " has no label " + in_quotes(name) + "; one of the map's " +
                                       std::to_string(names.size()) + " names was expected" + suggestion(name, names));
    }
    values.push_back(named->value);
  }
  if (source.all_labels)
    for (const LabelEntry& label : map.labels) values.push_back(label.value);
  for (const double value : values)
    if (!std::ranges::binary_search(map.counts, value, {}, &field::LabelCount::value))
      return json::error_at(where, "no voxel of " + in_quotes(source.label_map) + " has the label " + to_text(value) +
                                       "; one of the map's " + std::to_string(map.labels.size()) + " labels was expected");
  if (values.empty()) return json::error_at(where, in_quotes(source.label_map) + " contains only 0; a map with labels was expected");
  return values;
}

}  // namespace

std::vector<double> labels_inside(const LabelSource& surface, const LabelMap& map) {
  std::vector<double> inside;
  const auto is_in = [](const auto& list, const auto& item) { return std::ranges::find(list, item) != list.end(); };
  for (const LabelEntry& label : map.labels)
    if (surface.all_labels || is_in(surface.values, label.value) || (!label.name.empty() && is_in(surface.names, label.name)))
      inside.push_back(label.value);
  return inside;
}

std::string surface_label_name(const Scene& scene, std::string_view field) {
  const Entity entity = find_field(scene, field);
  if (!entity) return {};
  const FieldSource& source = scene.entities.get<FieldSource>(entity);
  if (!source.label || source.label->all_labels || source.label->values.size() + source.label->names.size() != 1) return {};
  if (!source.label->names.empty()) return source.label->names.front();
  const Entity parent = map_of(scene, *source.label);
  const LabelMap* map = parent ? find_label_map(scene, parent) : nullptr;
  const LabelEntry* label = map == nullptr ? nullptr : map->find(source.label->values.front());
  return label == nullptr ? std::string() : label->name;
}

std::vector<TransferFunction::ColorPoint> make_label_colors(const LabelMap& map) {
  std::vector<TransferFunction::ColorPoint> rows;
  for (const LabelEntry& label : map.labels) {
    rows.push_back({label.value - 0.5, label.color});
    rows.push_back({label.value + 0.5, label.color});
  }
  return rows;
}

bool shows_labels(const Scene& scene, Entity field, const std::vector<TransferFunction::ColorPoint>& colors, const NamedColors& named) {
  const LabelMap* map = find_label_map(scene, field);
  return map != nullptr && !map->labels.empty() && colors.empty() && named.map.empty() && !named.range;
}

std::vector<TransferFunction::ColorPoint> make_display_color_table(const Scene& scene, Entity field,
                                                                   const std::vector<TransferFunction::ColorPoint>& colors,
                                                                   const NamedColors& named, double lo, double hi) {
  return shows_labels(scene, field, colors, named) ? make_label_colors(*find_label_map(scene, field))
                                                   : make_color_table(colors, named, lo, hi);
}

Result<field::AnyField> resolve_label_surface(Scene& scene, Entity field) {
  const FieldSource& source = scene.entities.get<FieldSource>(field);
  const LabelSource label = *source.label;
  const json::Node where = source.where;
  const std::string name = scene.entities.get<Name>(field).value;
  CATENA_TRY(const field::AnyField of, resolve_field(scene, label.label_map, json::member_or_parent(where, "of")));
  const field::ScalarGrid* grid = of.scalar ? of.scalar->grid() : nullptr;
  const Entity parent = map_of(scene, label);
  std::shared_ptr<const LabelMap> map = scene.entities.get<FieldSource>(parent).labels;
  if (grid != nullptr && !map) map = make_label_map(*grid, scene.entities.get<FieldSource>(parent).labels_table);
  if (!map)
    return json::error_at(json::member_or_parent(where, "of"),
                          in_quotes(label.label_map) + " is not a label map; a file with integer voxels was expected");
  CATENA_TRY(const std::vector<double> values, values_of(label, *map, json::member_or_parent(where, "label")));
  auto made = field::make_label_surface(*grid, map->counts, values, label.smoothing_voxels, name);
  if (!made) return with_cause(json::error_at(where, made.error().message), made.error());
  field::AnyField surface{*made, nullptr};
  if (of.paged)
    scene.notes.push_back(fmt::format("field {}: the surfaces of labels are made of the level of {} that is loaded, not of the finest one", in_quotes(name),
                                      in_quotes(label.label_map)));
  return surface;
}

}  // namespace catena::scene
