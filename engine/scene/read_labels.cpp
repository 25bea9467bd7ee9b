// SPDX-License-Identifier: MIT
/// Reads keys of "fields": interpolation between voxels, names and colors of a label map, and label surfaces as fields.
#include <algorithm>
#include <cmath>

#include "engine/base/numbers.h"
#include "engine/base/system_failure.h"
#include "engine/field/derived/label_surface.h"
#include "engine/io/volume/downsample.h"
#include "engine/scene/readers.h"

namespace catena::scene {
namespace {

constexpr int kMaxNames = 65536;

Keys labels_keys() {
  return {schema::file(
              "file", "Label table of FreeSurfer or ITK-SNAP, comma-separated with column names, or with a number and a name in each row."),
          schema::numbers("values", "", "Values of the labels, together with `names`; instead of `file`.").with_size(1, kMaxNames),
          schema::texts("names", "Names of the labels, one for each of `values`.").with_size(1, kMaxNames),
          schema::points("colors", "", "Colours of the labels, one for each of `values`: red, green and blue from 0 to 1."),
          schema::text("package", "Debian package that contains the file; named in the error message when the file cannot be read.")};
}

/// Returns an Error unless the node is an integer that floats represent exactly.
Outcome check_label(const json::Node& node) {
  const double value = node.number;
  if (node.kind == json::Kind::number && value == std::nearbyint(value) && std::fabs(value) <= kMaxLabelValue) return Done{};
  return json::error_at(node, "a label is not an integer of at most 16777216 in magnitude; such a number was expected");
}

Result<LabelTable> read_rows(const json::Node& node) {
  const json::Node *values = node.find("values"), *names = node.find("names"), *colors = node.find("colors");
  if (values == nullptr || values->kind != json::Kind::array)
    return json::error_at(node, "\"labels\" has no list of \"values\"; \"file\", or \"values\" with \"names\", was expected");
  const std::size_t count = values->items.size();
  if (names == nullptr || names->kind != json::Kind::array || names->items.size() != count)
    return json::error_at(names == nullptr ? node : *names,
                          "\"names\" and \"values\" differ in number; a name for each value was expected");
  std::vector<std::vector<double>> rows;
  if (colors != nullptr) {
    CATENA_TRY(rows, json::as_rows(*colors, "colors", 3));
    if (rows.size() != count)
      return json::error_at(*colors, "\"colors\" and \"values\" differ in number; a colour for each value was expected");
  }
  LabelTable table;
  for (std::size_t i = 0; i < count; ++i) {
    CATENA_CHECK(check_label(values->items[i]));
    LabelRow label{values->items[i].number, {}, {}};
    CATENA_TRY(label.name, json::as_string(names->items[i], "names"));
    if (colors != nullptr) {
      CATENA_TRY(const Color color, schema::as_color(Vec3(rows[i][0], rows[i][1], rows[i][2]), colors->items[i], "colors"));
      label.color = color;
    }
    table.push_back(std::move(label));
  }
  std::sort(table.begin(), table.end(), [](const LabelRow& a, const LabelRow& b) { return a.value < b.value; });
  for (std::size_t i = 1; i < table.size(); ++i)
    if (table[i].value == table[i - 1].value)
      return json::error_at(*values, "\"values\" holds " + to_text(table[i].value) + " twice; different labels were expected");
  return table;
}

Outcome read_labels_table(const std::string& scene_path, const json::Node& node, FieldSource& source) {
  CATENA_CHECK(json::expect_object(node, "labels"));
  CATENA_CHECK(json::check_known_keys(node, schema::key_names(labels_keys())));
  const json::Node* file = node.find("file");
  if (file == nullptr) {
    CATENA_TRY(source.labels_table, read_rows(node));
    return Done{};
  }
  for (const char* key : {"values", "names", "colors"})
    if (const json::Node* other = node.find(key))
      return json::error_at(*other, in_quotes(key) + " is given beside \"file\", which holds the labels; one of them was expected");
  CATENA_TRY(const std::string name, json::require_string(node, "file"));
  source.labels_file = resolve_path(scene_path, name);
  auto table = read_label_table(source.labels_file);
  CATENA_TRY(const std::string package, json::get_string(node, "package", {}));
  if (!table)
    return with_cause(json::error_at(*file, "field " + in_quotes(source.where.label) + ": " + table.error().message +
                                                (package.empty() ? "" : "; the Debian package " + in_quotes(package) + " contains it")),
                      table.error());
  source.labels_table = std::move(*table);
  return Done{};
}

}  // namespace

Keys crop_keys() {
  return {schema::vec3("min", "world", "Minimum corner of the box.").required(),
          schema::vec3("max", "world", "Maximum corner of the box, greater than `min` on every axis.").required()};
}

Outcome read_crop(const json::Node& node, std::optional<field::Box>& crop) {
  CATENA_CHECK(json::expect_object(node, "crop"));
  CATENA_CHECK(json::check_known_keys(node, schema::key_names(crop_keys())));
  field::Box& box = crop.emplace();
  CATENA_TRY(box.lo, json::require_vec3(node, "min"));
  CATENA_TRY(box.hi, json::require_vec3(node, "max"));
  if (box.lo.x < box.hi.x && box.lo.y < box.hi.y && box.lo.z < box.hi.z) return Done{};
  return json::error_at(*node.find("max"), "\"max\" is not above \"min\"; a corner above it along each axis was expected");
}

Keys grid_source_keys() {
  return {
      schema::choice(
          "interpolation", {"linear", "nearest", "cubic"},
          "Interpolation between voxel centres: of the 8 nearest voxels; of the nearest one, for label maps; or of the 64 nearest, with a "
          "continuous gradient, more accurate for smooth data, and slower.")
          .with_default("`linear`; with `labels` `nearest`"),
      schema::integer("level_of_detail", "",
                      "Reduction of the grid for rendering and haptics: 1, 2 or 3 keeps every 2nd, 4th or 8th voxel along each axis.", 0,
                      field::kMaxLevels)
          .with_default("0: all voxels"),
      schema::object("crop", crop_keys(),
                     "Box to which the grid is cropped for rendering and haptics. Of a `.vdb` file only the blocks of voxels that the box "
                     "meets are read.")
          .with_default("the whole grid"),
      transform_key(), schema::object("labels", labels_keys(), "Names and colours of the labels of a label map.").with_default("none")};
}

Outcome read_grid_source(const std::string& scene_path, const json::Node& node, FieldSource& source) {
  const json::Node* labels = node.find("labels");
  if (labels != nullptr) CATENA_CHECK(read_labels_table(scene_path, *labels, source));
  const Keys keys = grid_source_keys();
  field::Interpolation interpolation = labels != nullptr ? field::Interpolation::nearest : field::Interpolation::linear;
  CATENA_CHECK(schema::read_value(*schema::find(keys, "interpolation"), node, interpolation));
  source.file->interpolation = interpolation;
  CATENA_CHECK(schema::read_value(*schema::find(keys, "level_of_detail"), node, source.file->level));
  CATENA_CHECK(read_transform(scene_path, node, source.file->transform));
  const json::Node* crop = node.find("crop");
  return crop != nullptr ? read_crop(*crop, source.file->crop) : Done{};
}

Keys label_keys() {
  return {
      schema::any_of("label",
                     {schema::integer("", "", "", -int(kMaxLabelValue), int(kMaxLabelValue)), schema::text("", ""),
                      schema::numbers("", "", ""), schema::texts("", "")},
                     "Number or name of the label; a list: the union of several labels; `\"*\"`: all labels but 0.")
          .required(),
      schema::reference("of", Role::scalar_field, "Label map that holds the labels: a field from a file.").required(),
      schema::number("smooth", "voxels",
                     "Standard deviation of the Gaussian that smooths the surface; every voxel centre stays on its side of the surface.")
          .within(0, field::kMaxLabelSmoothing)
          .with_default(to_text(field::kDefaultLabelSmoothing))};
}

Outcome read_label_source(const json::Node& node, FieldSource& source) {
  CATENA_CHECK(json::check_known_keys(node, schema::key_names(label_keys())));
  LabelSource& label = source.label.emplace();
  CATENA_TRY(label.label_map, json::require_string(node, "of"));
  const json::Node& smoothing = *node.find("label");
  const auto add = [&](const json::Node& item) -> Outcome {
    if (item.kind == json::Kind::string && !item.string.empty()) {
      label.names.push_back(item.string);
      return Done{};
    }
    CATENA_CHECK(check_label(item));
    label.values.push_back(item.number);
    return Done{};
  };
  if (smoothing.kind == json::Kind::string && smoothing.string == "*") {
    label.all_labels = true;
  } else if (smoothing.kind == json::Kind::array) {
    if (smoothing.items.empty()) return json::error_at(smoothing, "\"label\" is an empty list; at least one label was expected");
    for (const json::Node& item : smoothing.items) CATENA_CHECK(add(item));
  } else {
    CATENA_CHECK(add(smoothing));
  }
  CATENA_TRY(label.smoothing_voxels, json::get_number(node, "smooth", field::kDefaultLabelSmoothing, json::NumberRange::non_negative));
  if (label.smoothing_voxels > field::kMaxLabelSmoothing)
    return json::error_at(*node.find("smooth"), "\"smooth\" is " + to_text(label.smoothing_voxels) + "; a number from 0 to 4 was expected");
  return Done{};
}

Outcome check_label_sources(const Scene& scene) {
  Outcome outcome = Done{};
  scene.entities.each<FieldSource>([&](Entity, const FieldSource& source) {
    if (!outcome || !source.label) return;
    const json::Node& where = json::member_or_parent(source.where, "of");
    const Entity of = find_field(scene, source.label->label_map);
    if (of && (scene.entities.get<FieldSource>(of).file || scene.entities.get<FieldSource>(of).loaded.get() != nullptr)) return;
    std::vector<std::string_view> names;
    scene.entities.each<FieldSource>([&](Entity e, const FieldSource& other) {
      if (other.file) names.push_back(scene.entities.get<Name>(e).value);
    });
    outcome = json::error_at(where, in_quotes(source.label->label_map) + " is not a field from a file; one of " +
                                        (names.empty() ? "the scene's label maps" : join_words(names)) + " was expected" +
                                        suggestion(source.label->label_map, names));
  });
  return outcome;
}

}  // namespace catena::scene
