/// The parts of the scene file, one function a top-level key: its description (engine/schema) and its reader, which checks keys and values
/// completely and answers "FILE:LINE: what; what was expected". A new part is one file and one line in scene_file.cpp. Inside this room
/// only.
#pragma once
#include <string>

#include "engine/base/json.h"
#include "engine/base/text.h"
#include "engine/scene/color_maps.h"
#include "engine/scene/components.h"
#include "engine/scene/scene.h"
#include "engine/scene/to_json.h"
#include "engine/schema/key.h"
#include "engine/schema/struct_schema.h"

namespace catena::scene {

using schema::Key;
using schema::Keys;
using schema::Role;

struct Part {
  schema::Section description;                 ///< of "chain", "modes" and "device" the keys are told by the rooms that read them
  Outcome (*read)(Scene&, const json::Node&);  ///< nullptr: read_root reads it before the others
};

// in the order of docs/scene.md
Part time_part();
Part fields_part();
Part chain_part();
Part modes_part();
Part coupling_part();
Part workspace_part();
Part device_part();
Part widgets_part();
Part volumes_part();
Part isosurfaces_part();
Part slices_part();
Part meshes_part();
Part streamlines_part();
Part glyphs_part();
Part curves_part();
Part points_part();
Part indicator_part();
Part clip_part();
Part camera_part();
Part lights_part();
Part stereo_part();
Part screens_part();
Part background_part();
Part quality_part();
Part jitter_part();
Part tuning_part();
Part cursor_part();
Part unit_length_part();
Part bounding_box_part();
Part axes_part();
Part ground_part();
Part fog_part();
Part scalar_bars_part();
Part labels_part();
Part title_part();
Part orientation_marker_part();
Part status_part();
Part overlay_part();

/// Calls read(item) for each object of an array.
template <class Read>
Outcome each_item(const json::Node& node, Read&& read) {
  if (node.kind != json::Kind::array) return json::error_at(node, in_quotes(node.label) + " is no array; an array of objects was expected");
  for (const json::Node& item : node.items) {
    CATENA_CHECK(json::expect_object(item, item.label));
    CATENA_CHECK(read(item));
  }
  return Done{};
}

/// [a-z][a-z0-9_]*
bool is_identifier(std::string_view text);
/// `kind` says in the message what is called so: "mesh".
Outcome check_name(const std::string& kind, const std::string& name, const json::Node& node);

/// A plane in one of three ways; `word` says what lies on it ("slice"). Of a widget, its pose as stated.
Outcome read_plane(const Scene& scene, const json::Node& item, const std::string& word, Vec3& point, Vec3& normal, Entity& widget);
/// Empty where `path` is a file, or folder, that is there and of a known kind; else what is wrong, and that `wanted` was expected.
std::string file_problem(const std::string& path, bool known, const std::string& wanted, bool folders = false);

/// Relative paths start at the scene file's folder.
std::string resolve_path(const std::string& scene_path, const std::string& file);

Outcome read_time(Scene& scene, const json::Node& node);
Outcome read_fields(Scene& scene, const json::Node* fields, const std::vector<FieldOverride>& overrides);
/// Of a grid's source, beside its own keys: "interpolation" and "labels"; the source has its file already.
Keys grid_source_keys();
Outcome read_grid_source(const std::string& scene_path, const json::Node& node, FieldSource& source);
/// The surface of labels as a source: "label", "of", "smooth".
Keys label_keys();
Outcome read_label_source(const json::Node& node, FieldSource& source);
/// Once all fields are read: what they are of are fields from files.
Outcome check_label_sources(const Scene& scene);
/// The entity of the field that member `key` of `object` names; an error lists the known ones.
Result<Entity> read_field_name(const Scene& scene, const json::Node& object, std::string_view key = "field");

/// Rows [value, r, g, b], values rising.
Result<std::vector<TransferFunction::ColorPoint>> read_color_table(const json::Node& node, std::string_view what);

/// The widget that member "widget" of `object` names, one of `kinds`; `wanted` says them in words ("a cutting plane or a box").
Result<Entity> read_widget_name(const Scene& scene, const json::Node& object, std::initializer_list<widget::Kind> kinds,
                                std::string_view wanted);

/// Keys that several components of a scene have, and how the types of this room are read and written. Inside this room only.

template <class T>
using Table = schema::StructSchema<T, Scene>;

/// Binds a key that names a field to the entity of it; absent and not required: none.
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

/// "clip" and "visible" of what is drawn. The second is read by read_visible (hidden.h), which knows the entity.
Key clip_key();
Key visible_key();
Key opacity_key(const std::string& help);
/// "point", "normal", "axis", "at", "widget" as read_plane takes them.
Keys plane_keys();
schema::Members plane_members(const Scene& scene, const Vec3& point, const Vec3& normal, Entity widget);
/// "color", "range", "mapping", "linear_below" and "transfer" where values become colours.
Keys color_scale_keys(std::string_view map = kDefaultLineColorMap, const std::string& range = "that of the values");
/// Those, and a volume's opacities.
Keys transfer_keys();

/// The keys of a list's item under `name`.
template <class T>
schema::Section make_list_component(const std::string& name, const std::string& help, const Table<T>& table, int most = 0) {
  return {name, help, schema::Section::Layout::list, table.keys(), most};
}

/// "color_by": colours that follow values, one shape wherever it stands. Inside this room only.

/// What is coloured: what rays meet (fields only, never as a word), surfaces (fields), lines (which know their speed and length, too),
/// glyphs (which know their speed, and are never a word), curves from a file (which know their length and the file's values), or points
/// (the file's values).
enum class ColorTarget { rays, surfaces, lines, glyphs, curves, points };

Key color_by_key(ColorTarget subjects);
/// Empty where the item says nothing. A word with the colours' keys beside it, as scenes were written once, is read with a note.
Outcome read_color_by(Scene& scene, const json::Node& item, ColorTarget subjects, std::optional<ColorBy>& out);
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
/// "color", "range" and "mapping" as members.
schema::Members color_scale_members(const std::vector<TransferFunction::ColorPoint>& colors, const NamedColors& named);

/// A volume's colours and opacities.
schema::Members transfer_members(const TransferFunction& transfer);

/// Member `key` as an index into the entities that own a T; `what` they are called, and `whose` the index is, for messages.
template <class T>
Result<Entity> read_index(const Scene& scene, const json::Node& object, std::string_view key, const std::string& what,
                          const std::string& whose) {
  std::vector<Entity> owners;
  scene.entities.each<T>([&](Entity e, const T&) { owners.push_back(e); });
  const json::Node& node = *object.find(key);
  if (owners.empty()) return json::error_at(node, "the scene has no " + what + "; one was expected for " + whose);
  CATENA_TRY(const int index, json::get_integer(object, key, 0, 0, static_cast<int>(owners.size()) - 1));
  return owners[static_cast<std::size_t>(index)];
}

/// "seeds" of streamlines; read_seeds itself is in lines.h, as `trace` reads the same. Inside this room only.
Key seeds_key();
std::string write_seeds(const Scene& scene, const Seeds& seeds);

/// Colours and opacities of the scene file, inside this room only. An object that colours by values takes
///   "color"     a table [[value, r, g, b], ...], or the name of a colour map (color_maps.h)
///   "range"     [lo, hi], the values between which a named map lies; without it those of the data
///   "mapping"   "linear", "log" or "symlog", with "linear_below": the scale between the points, of opacities, too
///   "transfer"  instead of "color": a file, relative to the scene's. Either an object with a volume's keys, or ParaView's
///               exported colour map (read_paraview.cpp). "range" beside it lays its tables anew, from their own ends to lo..hi
/// and a volume, or a transfer file, besides
///   "opacity" with "opacity_length", or "extinction", and "gradient_opacity": [[gradient, factor], ...], field units per world
///   unit, 0 <= factor <= 1, which multiplies the extinction.
/// Errors name the file, the scene's or the transfer file, and the line.
struct ColorScale {
  std::vector<TransferFunction::ColorPoint> colors;
  NamedColors named;  ///< where `colors` is empty; its mapping always
};

/// "color", "range", "mapping" and "transfer" of an object.
Result<ColorScale> read_color_scale(const std::string& scene_path, const json::Node& object);
/// The keys of a volume.
Result<TransferFunction> read_transfer(const std::string& scene_path, const json::Node& object);

/// A transfer file's text; `path` is for the messages.
Result<TransferFunction> parse_transfer(std::string_view text, const std::string& path);
/// ParaView's colour map: an array of one object with "RGBPoints".
Result<TransferFunction> read_paraview_map(const json::Node& root);

}  // namespace catena::scene
