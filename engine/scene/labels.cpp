#include "engine/scene/labels.h"

#include <algorithm>
#include <cmath>

#include "engine/base/machine_failure.h"
#include "engine/base/numbers.h"
#include "engine/base/text.h"
#include "engine/scene/color_maps.h"
#include "engine/scene/label_palette.h"

namespace catena::scene {

const MapLabel* LabelMap::find(double value) const {
  const auto it = std::lower_bound(labels.begin(), labels.end(), value, [](const MapLabel& l, double v) { return l.value < v; });
  return it != labels.end() && it->value == value ? &*it : nullptr;
}

std::shared_ptr<const LabelMap> make_label_map(const field::ScalarGrid& grid, const LabelTable& table) {
  auto counts = field::label_counts(grid);
  if (!counts) return nullptr;
  auto map = std::make_shared<LabelMap>();
  map->counts = std::move(*counts);
  std::size_t beyond = table.size();  // the table's rows have the first colours, whichever of them this map holds
  for (const field::LabelCount& count : map->counts) {
    if (count.value == 0) continue;
    MapLabel label{count.value, {}, {}, count.voxels};
    const auto said = std::lower_bound(table.begin(), table.end(), count.value, [](const LabelName& l, double v) { return l.value < v; });
    const bool known = said != table.end() && said->value == count.value;
    if (known) label.name = said->name;
    if (known && said->color)
      label.color = *said->color;
    else
      label.color = palette_color(known ? static_cast<std::size_t>(said - table.begin()) : beyond++);
    map->labels.push_back(std::move(label));
  }
  return map;
}

void find_labels(FieldSource& source) {
  const field::ScalarGrid* grid = source.loaded.scalar ? source.loaded.scalar->grid() : nullptr;
  if (grid != nullptr && grid->interpolation() == field::Interpolation::nearest && !source.labels)
    source.labels = make_label_map(*grid, source.labels_table);
}

const LabelMap* labels_of(const Scene& scene, Entity field) { return scene.world.get<FieldSource>(field).labels.get(); }

std::string label_words(const LabelMap& map, double value) {
  if (value == 0) return "no label";
  const MapLabel* label = map.find(value);
  return label == nullptr || label->name.empty() ? to_text(value) : label->name + " (" + to_text(value) + ")";
}

namespace {

/// The label map that a surface is of; none: the scene has none of that name.
Entity map_of(const Scene& scene, const LabelSource& source) { return find_field(scene, source.of); }

/// The values that the source names, by number or by name.
Result<std::vector<double>> values_of(const LabelSource& source, const LabelMap& map, const json::Node& where) {
  std::vector<double> values = source.values;
  for (const std::string& name : source.names) {
    const auto named = std::find_if(map.labels.begin(), map.labels.end(), [&](const MapLabel& label) { return label.name == name; });
    if (named == map.labels.end()) {
      std::vector<std::string_view> names;
      for (const MapLabel& label : map.labels)
        if (!label.name.empty()) names.push_back(label.name);
      return json::error_at(where, "label map " + in_quotes(source.of) + " has no label " + in_quotes(name) + "; one of its " +
                                       std::to_string(names.size()) + " names was expected" + suggestion(name, names));
    }
    values.push_back(named->value);
  }
  if (source.any)
    for (const MapLabel& label : map.labels) values.push_back(label.value);
  for (const double value : values)
    if (!std::ranges::binary_search(map.counts, value, {}, &field::LabelCount::value))
      return json::error_at(where, "no voxel of " + in_quotes(source.of) + " holds label " + to_text(value) + "; one of its " +
                                       std::to_string(map.labels.size()) + " labels was expected");
  if (values.empty()) return json::error_at(where, in_quotes(source.of) + " holds nothing but 0; a map with labels was expected");
  return values;
}

}  // namespace

std::string label_name(const Scene& scene, std::string_view field) {
  const Entity entity = find_field(scene, field);
  if (!entity) return {};
  const FieldSource& source = scene.world.get<FieldSource>(entity);
  if (!source.label || source.label->any || source.label->values.size() + source.label->names.size() != 1) return {};
  if (!source.label->names.empty()) return source.label->names.front();
  const Entity parent = map_of(scene, *source.label);
  const LabelMap* map = parent ? labels_of(scene, parent) : nullptr;
  const MapLabel* label = map == nullptr ? nullptr : map->find(source.label->values.front());
  return label == nullptr ? std::string() : label->name;
}

std::vector<TransferFunction::ColorPoint> label_colors(const LabelMap& map) {
  std::vector<TransferFunction::ColorPoint> rows;
  for (const MapLabel& label : map.labels) {
    rows.push_back({label.value - 0.5, label.color});
    rows.push_back({label.value + 0.5, label.color});
  }
  return rows;
}

bool shows_labels(const Scene& scene, Entity field, const std::vector<TransferFunction::ColorPoint>& colors, const NamedColors& named) {
  const LabelMap* map = labels_of(scene, field);
  return map != nullptr && !map->labels.empty() && colors.empty() && named.map.empty() && !named.range;
}

std::vector<TransferFunction::ColorPoint> shown_table(const Scene& scene, Entity field,
                                                      const std::vector<TransferFunction::ColorPoint>& colors, const NamedColors& named,
                                                      double lo, double hi) {
  return shows_labels(scene, field, colors, named) ? label_colors(*labels_of(scene, field)) : color_table(colors, named, lo, hi);
}

Result<field::AnyField> use_label_surface(Scene& scene, Entity field) {
  const FieldSource& source = scene.world.get<FieldSource>(field);
  const LabelSource label = *source.label;
  const json::Node where = source.where;
  const std::string name = scene.world.get<Name>(field).value;
  CATENA_TRY(const field::AnyField of, use_field(scene, label.of, json::member_or(where, "of")));
  const field::ScalarGrid* grid = of.scalar ? of.scalar->grid() : nullptr;
  const Entity parent = map_of(scene, label);
  std::shared_ptr<const LabelMap> map = scene.world.get<FieldSource>(parent).labels;
  if (grid != nullptr && !map) map = make_label_map(*grid, scene.world.get<FieldSource>(parent).labels_table);
  if (!map)
    return json::error_at(json::member_or(where, "of"),
                          in_quotes(label.of) + " is no label map; a file whose voxels hold whole numbers was expected");
  CATENA_TRY(const std::vector<double> values, values_of(label, *map, json::member_or(where, "label")));
  auto made = field::label_surface(*grid, map->counts, values, label.smooth, name);
  if (!made) return caused_by(json::error_at(where, made.error().message), made.error());
  return field::AnyField{*made, nullptr};
}

}  // namespace catena::scene
