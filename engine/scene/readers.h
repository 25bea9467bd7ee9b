// SPDX-License-Identifier: MIT
/// Sections of the scene file, one function per top-level key: its description (engine/schema) and its reader, which checks all keys and
/// values; errors are "FILE:LINE: what; what was expected". A new section is one file and one line in scene_file.cpp. Private to this
/// module.
#pragma once
#include <string>

#include "engine/base/json.h"
#include "engine/base/text.h"
#include "engine/scene/color_maps.h"
#include "engine/scene/components.h"
#include "engine/scene/drawable.h"
#include "engine/scene/scene.h"
#include "engine/scene/to_json.h"
#include "engine/scene/visibility.h"
#include "engine/schema/key.h"
#include "engine/schema/struct_schema.h"

namespace catena::scene {

using schema::Key;
using schema::Keys;
using schema::Role;

/// Loads the data of each visible item with the component T by `use`, and the field that colors it.
template <class T, class Use>
Outcome load_visible(Scene& scene, const Use& use) {
  for (const Entity e : visible_entities<T>(scene.entities)) CATENA_CHECK(use(e, T(scene.entities.get<T>(e))));
  return Done{};
}
/// Loads the field of "color_by" of lines, glyphs, curves or points.
inline Outcome load_color_field(Scene& scene, const std::optional<ColorBy>& by) {
  if (by && by->source == ColorBy::Source::field) CATENA_CHECK(resolve_field(scene, by->field, by->where));
  return Done{};
}

/// Calls read(item) for each object of an array. Error: the node is no array, or an item is no object.
template <class Read>
Outcome each_item(const json::Node& node, Read&& read) {
  if (node.kind != json::Kind::array)
    return json::error_at(node, in_quotes(node.label) + " is not an array; an array of objects was expected");
  for (const json::Node& item : node.items) {
    CATENA_CHECK(json::expect_object(item, item.label));
    CATENA_CHECK(read(item));
  }
  return Done{};
}

/// Reads true or false.
inline Outcome read_boolean(const json::Node& node, bool& out) {
  if (node.kind != json::Kind::boolean)
    return json::error_at(node, in_quotes(node.label) + " is not a boolean; true or false was expected");
  out = node.boolean;
  return Done{};
}

/// Returns the color of [r, g, b] with components from 0 to 1; nullopt: something else.
std::optional<Color> as_color(const json::Node& node);

/// Returns whether the text matches [a-z][a-z0-9_]*.
bool is_identifier(std::string_view text);
/// Checks that a name is an identifier. `kind` names the object in the message: "mesh".
Outcome check_name(const std::string& kind, const std::string& name, const json::Node& node);

/// Reads a plane: "axis" and "at", "point" and "normal", or "widget", which gives the widget's stated pose. `word` names the object on the
/// plane in messages ("slice").
Outcome read_plane(const Scene& scene, const json::Node& item, const std::string& word, Vec3& point, Vec3& normal, Entity& widget);
/// Returns an empty string if `path` is an existing file (or folder, with `folders`) and `known`, its type, is true; else the problem, with
/// `expected` as what was expected.
std::string file_problem(const std::string& path, bool known, const std::string& expected, bool folders = false);
/// Returns whether the scene may name the file although it does not exist at the moment (Scene::known_files).
bool is_known_file(const Scene& scene, const std::string& path);

/// Returns the path of a file named in the scene; relative paths start at the scene file's folder.
std::string resolve_path(const std::string& scene_path, const std::string& file);

/// Reads "time". Fields depend on it, so it is read before them.
Outcome read_time(Scene& scene, const json::Node& node);
/// Reads "fields" (null: the scene has none) and applies the overrides.
Outcome read_fields(Scene& scene, const json::Node* fields, const std::vector<FieldOverride>& overrides);
/// Keys of a grid's source besides those of its file: "interpolation" and "labels". The source already has its file.
Keys grid_source_keys();
/// Key "transform" of a field from a file: its matrix, or the file that holds it.
Key transform_key();
/// Reads "transform"; `out` is empty if the field has none.
Outcome read_transform(const std::string& scene_path, const json::Node& node, std::optional<field::FieldTransform>& out);
Outcome read_grid_source(const std::string& scene_path, const json::Node& node, FieldSource& source);
/// Key "unit" of a field. Keys "resolution" and "box" of a field that is sampled, as read by read_sampling().
Key unit_key();
Keys sampling_keys();
Outcome read_sampling(const json::Node& node, FieldSource& source);
/// Keys of a field that is derived from others, and of one that is an expression of them.
Keys derived_keys();
Keys expression_keys();
Outcome read_derived_source(const json::Node& node, FieldSource& source);
/// Checks, after all fields are read, that the sources of derived fields exist and that none is derived from itself.
Outcome check_derived_sources(const Scene& scene);
/// Keys of a label surface as a source: "label", "of", "smooth".
Keys label_keys();
Outcome read_label_source(const json::Node& node, FieldSource& source);
/// Checks, after all fields are read, that the label maps of label surfaces are fields from files.
Outcome check_label_sources(const Scene& scene);
/// Returns the field that member `key` of `object` names; an Error lists the known ones.
Result<Entity> read_field_name(const Scene& scene, const json::Node& object, std::string_view key = "field");

/// Reads rows [value, r, g, b], values rising.
Result<std::vector<TransferFunction::ColorPoint>> read_color_table(const json::Node& node, std::string_view what);

/// Returns the widget that member "widget" of `object` names. Error: unknown, or none of `kinds`, which `expected` states for the message
/// ("a cutting plane or a box").
Result<Entity> read_widget_name(const Scene& scene, const json::Node& object, std::initializer_list<widget::Kind> kinds,
                                std::string_view expected);

// Keys that several sections share, and the table type of this module.

template <class T>
using Table = schema::StructSchema<T, Scene>;

/// Reads true (defaults), false (none) or an object.
template <class T>
Outcome read_on_off(Scene& scene, const json::Node& node, const Table<T>& table, std::optional<T>& out) {
  if (node.kind == json::Kind::boolean && !node.boolean) return Done{};
  if (node.kind != json::Kind::boolean && node.kind != json::Kind::object)
    return json::error_at(node, in_quotes(node.label) + " is neither true, false nor an object; one of them was expected");
  T made;
  if constexpr (requires { made.where; }) made.where = node;
  if (node.kind == json::Kind::object) CATENA_CHECK(table.read(scene, node, made));
  out = std::move(made);
  return Done{};
}

/// Binds a key that names a field to the field's entity; if the key is optional and absent, the entity is none.
template <class T, class C, class Access>
void bind_field(schema::StructSchema<T, C>& table, const Key& key, Access access) {
  table.custom(
      key,
      [key, access](C& scene, const json::Node& object, T& out) -> Outcome {
        if (!key.is_required && object.find(key.name) == nullptr) return Done{};
        CATENA_TRY(std::invoke(access, out), read_field_name(scene, object, key.name));
        return Done{};
      },
      [access](const Scene& scene, const T& in) {
        const Entity field = std::invoke(access, in);
        return field ? schema::write_value(scene.entities.get<Name>(field).value) : std::string();
      });
}

/// Keys "clip" and "visible" of visible objects. read_visible (visibility.h), which has the entity, reads the second.
Key clip_key();
Key visible_key();
Key opacity_key(const std::string& help);
/// Key "threshold" of objects that leave out values; read_color_scale and read_transfer read it.
Key threshold_key();
/// Keys "point", "normal", "axis", "at" and "widget", as read by read_plane.
Keys plane_keys();
/// Returns the members that state a plane: its widget, else "axis" and "at" if it is across an axis, else "point" and "normal".
schema::Members plane_members(const Scene& scene, const Vec3& point, const Vec3& normal, Entity widget);
/// Keys "color", "range", "mapping", "linear_below" and "transfer" of objects that color by value.
Keys color_scale_keys(std::string_view map = kDefaultLineColorMap, const std::string& range = "the range of the values");
/// Returns the keys of color_scale_keys(), and the opacity keys of a volume.
Keys transfer_keys();

/// Returns the section of a list with the item keys of `table`. `max_count`: maximum number of items; 0: any number.
template <class T>
schema::Section make_list_component(const std::string& name, const std::string& help, const Table<T>& table, int max_count = 0) {
  return {name, help, schema::Section::Layout::list, table.keys(), max_count};
}

/// Kind of object that "color_by" colors, and the values that it allows: volumes and isosurfaces hit by rays (fields), surfaces (fields),
/// lines (fields, speed, arc length), glyphs (fields, speed), curves from a file (fields, arc length, values in the file), points (fields,
/// values in the file). For surfaces and lines "color_by" may also be a word.
enum class ColorTarget { rays, surfaces, lines, glyphs, curves, points };

/// Returns the key "color_by" for that kind of object.
Key color_by_key(ColorTarget subjects);
/// Reads "color_by"; `out` is empty if the item has none.
Outcome read_color_by(Scene& scene, const json::Node& item, ColorTarget subjects, std::optional<ColorBy>& out);
/// Reads "color" of an item that may have "color_by": one color. Error: a table or a color map, which belong into "color_by".
Outcome read_plain_color(const json::Node& item, Color& out);
/// Binds "color_by" to a member of T of type std::optional<ColorBy>.
template <class T, class Access>
void bind_color_by(Table<T>& table, ColorTarget subjects, Access access) {
  table.custom(
      color_by_key(subjects),
      [=](Scene& scene, const json::Node& item, T& out) { return read_color_by(scene, item, subjects, std::invoke(access, out)); },
      [=](const Scene& scene, const T& in) {
        const std::optional<ColorBy>& by = std::invoke(access, in);
        return by ? to_json(scene, *by) : std::string();
      });
}
/// Returns "color", "range" and "mapping" as members.
schema::Members color_scale_members(const std::vector<TransferFunction::ColorPoint>& colors, const NamedColors& named);

/// Returns a volume's colors and opacities as members.
schema::Members transfer_members(const TransferFunction& transfer);

/// Returns the index in member `key` of a list of `count` items. For messages `what` names the items and `referrer` the object with the
/// index.
Result<std::size_t> read_index(const json::Node& object, std::string_view key, std::string_view what, std::size_t count,
                               const std::string& referrer);
/// Returns the entity at the index in member `key`, counted among the entities that own a T.
template <class T>
Result<Entity> read_index(const Scene& scene, const json::Node& object, std::string_view key, const std::string& what,
                          const std::string& referrer) {
  std::vector<Entity> owners;
  scene.entities.each<T>([&](Entity e, const T&) { owners.push_back(e); });
  CATENA_TRY(const std::size_t index, read_index(object, key, what, owners.size(), referrer));
  return owners[index];
}

/// Key "seeds" of streamlines. read_seeds is in streamlines.h, because the command `trace` reads the same.
Key seeds_key();
/// Returns the JSON text of "seeds".
std::string write_seeds(const Scene& scene, const Seeds& seeds);

/// Colors and opacities of the scene file. An object that colors by value has the keys
///   "color"     a table [[value, r, g, b], ...], or the name of a color map (color_maps.h)
///   "range"     [min, max], the values between which a named map is stretched; default: the range of the data
///   "mapping"   "linear", "log" or "symlog", with "linear_below": the scale between the points, also of opacities
///   "threshold" [min, max], the values that are shown; not where "color_by" colors volumes and isosurfaces
///   "transfer"  instead of "color": a file, relative to the scene's. Either an object with a volume's keys, or a color map exported by
///               ParaView (read_paraview.cpp). "range" next to it stretches its tables from their own ends to the range
/// and a volume, or a transfer file, has also
///   "opacity" with "opacity_length", or "extinction", and "gradient_opacity": [[gradient, factor], ...], field units per world
///   unit, 0 <= factor <= 1, which multiplies the extinction.
/// Errors have the name and line of the scene file or the transfer file.
struct ColorScale {
  std::vector<TransferFunction::ColorPoint> colors;  ///< Color table, values rising; empty: a color map
  NamedColors named;                                 ///< Color map used if `colors` is empty; its mapping always applies
};

/// Reads the range of values [lo, hi] at `key`; nullopt: absent.
Result<std::optional<std::array<double, 2>>> read_range(const json::Node& object, std::string_view key);
/// Reads "color", "range", "mapping" and "transfer" of an object.
Result<ColorScale> read_color_scale(const std::string& scene_path, const json::Node& object);
/// Reads the colors and opacities of a volume.
Result<TransferFunction> read_transfer(const std::string& scene_path, const json::Node& object);

/// Parses the text of a transfer file; `path` is for messages.
Result<TransferFunction> parse_transfer(std::string_view text, const std::string& path);
/// Reads a color map of ParaView: an array of one object with "RGBPoints".
Result<TransferFunction> read_paraview_map(const json::Node& root);

}  // namespace catena::scene
