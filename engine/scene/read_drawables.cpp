// SPDX-License-Identifier: MIT
/// Reads the rendered objects "volumes", "isosurfaces", "meshes", and the "cursor".
#include <filesystem>

#include "engine/base/numbers.h"
#include "engine/base/output_file.h"
#include "engine/base/text.h"
#include "engine/io/formats.h"
#include "engine/io/volume/unsupported_formats.h"
#include "engine/scene/reader_bindings.h"

namespace catena::scene {
namespace {

const Table<Volume>& volume_table() {
  static const auto table = [] {
    Table<Volume> t;
    bind_field(t, schema::reference("field", Role::scalar_field, "Scalar field that the volume shows.").required(), &Volume::field);
    t.group(
        transfer_keys(),
        [](Scene& scene, const json::Node& item, Volume& volume) -> Outcome {
          CATENA_TRY(volume.transfer, read_transfer(scene.path, item));
          return Done{};
        },
        [](const Scene&, const Volume& v) { return transfer_members(v.transfer); });
    t.bind(schema::boolean("shade", "Lighting by the gradient of the field."), &Volume::shaded);
    t.bind(schema::number("albedo", "", "Factor on the colour of the light that is scattered; with `\"look\": \"lit\"`.").within(0, 1),
           &Volume::albedo);
    t.bind(schema::number("anisotropy", "", "Henyey and Greenstein's g: above 0, light is scattered forwards; with `\"look\": \"lit\"`.")
               .within(-0.99, 0.99),
           &Volume::anisotropy);
    t.bind(schema::number("reflected_share", "",
                          "With `shade`, share of the light that the gradient reflects; the rest is scattered; with `\"look\": \"lit\"`.")
               .within(0, 1),
           &Volume::reflected_share);
    t.bind(clip_key(), &Volume::clipped);
    t.companion(visible_key());
    t.bind(schema::choice("projection", {"composite", "maximum", "minimum", "average"},
                          "Combination of the values along a ray; `composite`: emission and absorption."),
           &Volume::projection);
    bind_color_by(t, ColorTarget::rays, &Volume::color_by);
    t.check([](Scene&, const json::Node& item, Volume& volume) -> Outcome {
      if (volume.projection == Volume::Projection::composite) return Done{};
      const std::string beside =
          " is given with the projection " + in_quotes(item.find("projection")->string) + "; \"composite\" was expected";
      if (volume.color_by) return json::error_at(volume.color_by->where, "\"color_by\"" + beside);
      if (volume.transfer.gradient_factors.empty()) return Done{};
      return json::error_at(*item.find("projection"), "\"gradient_opacity\"" + beside);
    });
    return t;
  }();
  return table;
}

const Table<Isosurface>& isosurface_table() {
  static const auto table = [] {
    Table<Isosurface> t;
    bind_field(t, schema::reference("field", Role::scalar_field, "Scalar field of the isosurface.").required(), &Isosurface::field);
    const Key level = schema::number("level", "value", "Field value on the isosurface, or an isolevel widget that sets it.")
                          .required()
                          .with_range_text("in the field's range")
                          .with_role(Role::level)
                          .or_widget();
    t.custom(
        level,
        [](Scene& scene, const json::Node& item, Isosurface& surface) -> Outcome {
          if (const json::Node* node = item.find("level"); node != nullptr && node->kind == json::Kind::object) {
            CATENA_CHECK(json::check_known_keys(*node, {"widget"}));
            CATENA_TRY(surface.level_widget, read_widget_name(scene, *node, {widget::Kind::isolevel}, "an isolevel"));
          } else {
            CATENA_TRY(surface.level, json::require_number(item, "level"));
          }
          return Done{};
        },
        [](const Scene& scene, const Isosurface& s) {
          return s.level_widget ? "{\"widget\": " + schema::write_value(scene.entities.get<Name>(s.level_widget).value) + "}"
                                : schema::write_value(s.level);
        });
    t.bind(schema::color("color", "Colour of the isosurface if there is no `color_by`."), &Isosurface::color);
    t.bind(opacity_key("Opacity of each layer of the isosurface."), &Isosurface::opacity);
    t.bind(clip_key(), &Isosurface::clipped);
    t.companion(visible_key());
    bind_color_by(t, ColorTarget::rays, &Isosurface::color_by);
    return t;
  }();
  return table;
}

/// An item of "meshes": the mesh, used by haptics and rendering, and its appearance.
struct MeshItem {
  std::string name;
  MeshSource source;
  SurfaceMesh surface;
};

const Table<MeshItem>& mesh_table() {
  static const auto table = [] {
    Table<MeshItem> t;
    t.custom(schema::identifier("name", "Unique name, by which links and glyphs refer to the mesh.").required(),
             [](Scene& scene, const json::Node& item, MeshItem& mesh) -> Outcome {
               CATENA_TRY(mesh.name, read_new_name<MeshSource>(scene, item, "mesh"));
               return Done{};
             });
    t.custom(schema::file("file", "Mesh file: " + join_alternatives(io::readable_extensions(io::DataKind::mesh)) + ".").required(),
             [](Scene& scene, const json::Node& item, MeshItem& mesh) -> Outcome {
               CATENA_TRY(mesh.source.path,
                          read_path(scene, item, "mesh", mesh.name, io::readable_extensions(io::DataKind::mesh), mesh.source.steps));
               return Done{};
             });
    t.bind(
        schema::number("scale", "", "World units per unit of the file.").positive(),
        [](auto& m) -> auto& { return m.source.placement.scale; });
    t.bind(
        schema::vec3("offset", "world", "Translation, applied after `scale`."), [](auto& m) -> auto& { return m.source.placement.offset; });
    t.custom(
        schema::color("color", "Colour of the surface if there is no `color_by`.").with_default(schema::write_value(SurfaceMesh{}.color)),
        [](Scene&, const json::Node& item, MeshItem& mesh) { return read_plain_color(item, mesh.surface.color); });
    bind_color_by(
        t, ColorTarget::surfaces, [](auto& m) -> auto& { return m.surface.color_by; });
    t.bind(
        opacity_key("Opacity of each layer of the surface."), [](auto& m) -> auto& { return m.surface.opacity; });
    t.bind(
        schema::choice("shading", {"flat", "smooth"},
                       "Shading of the triangles; `smooth`: with interpolated normals. Haptics uses the flat triangles in either case."),
        [](auto& m) -> auto& { return m.surface.smooth_shading; });
    t.bind(
        schema::boolean("edges", "Rendering of the triangle edges."), [](auto& m) -> auto& { return m.surface.show_edges; });
    t.bind(
        clip_key(), [](auto& m) -> auto& { return m.surface.clipped; });
    t.companion(visible_key());
    return t;
  }();
  return table;
}

const Table<Cursor>& cursor_table() {
  static const auto table = [] {
    Table<Cursor> t;
    t.custom(
        schema::vec3("probe", "world",
                     "Position of the probe in images without a device or a replay. The cursor is shown there only if this key is given."),
        [](Scene&, const json::Node& node, Cursor& cursor) -> Outcome {
          CATENA_TRY(const auto probe, json::get_optional_vec3(node, "probe"));
          if (probe) cursor.probe = *probe;
          cursor.visible = cursor.visible || probe;
          return Done{};
        });
    t.bind(schema::number("size", "world", "Radius of the probe's ball, or half the length of the crosshair's rods.")
               .positive()
               .with_default("fitted to the scene"),
           &Cursor::size);
    t.bind(schema::boolean("show_occluded", "Visibility of the probe, the proxies and the force through objects that occlude them."),
           &Cursor::show_occluded);
    t.bind(schema::choice("shape", {"ball", "crosshair"},
                          "Shape of the cursor. `crosshair`: three thin rods that cross at the probe, without proxies and force, so that "
                          "the image does not show the haptic contact."),
           &Cursor::crosshair);
    t.bind(schema::boolean(
               "drop_line",
               "Depth cue: a thin line from the probe down to the ground, or else to the bottom of the rendered domain, with a small "
               "cross at its end."),
           &Cursor::drop_line);
    return t;
  }();
  return table;
}

template <class T>
Outcome read_items(Scene& scene, const json::Node& node, const Table<T>& table) {
  return each_item(node, [&](const json::Node& item) -> Outcome {
    T made;
    made.where = item;
    CATENA_CHECK(table.read(scene, item, made));
    const Entity e = scene.entities.create();
    scene.entities.emplace<T>(e, std::move(made));
    return read_visible(scene, e, item);
  });
}

Outcome read_meshes(Scene& scene, const json::Node& node) {
  return each_item(node, [&](const json::Node& item) -> Outcome {
    MeshItem mesh;
    mesh.source.where = mesh.surface.where = item;
    CATENA_CHECK(mesh_table().read(scene, item, mesh));
    mesh.surface.mesh = scene.entities.create();
    scene.entities.emplace<Name>(mesh.surface.mesh, {mesh.name});
    scene.entities.emplace<MeshSource>(mesh.surface.mesh, std::move(mesh.source));
    const Entity e = scene.entities.create();
    scene.entities.emplace<SurfaceMesh>(e, std::move(mesh.surface));
    return read_visible(scene, e, item);
  });
}

Outcome read_cursor(Scene& scene, const json::Node& node) {
  CATENA_CHECK(json::expect_object(node, "cursor"));
  return cursor_table().read(scene, node, scene.entities.get<Cursor>(scene.cursor));
}

}  // namespace

std::string file_problem(const std::string& path, bool known, const std::string& expected, bool folders) {
  namespace fs = std::filesystem;
  std::error_code code;
  const auto problem = [&](const char* what) { return in_quotes(path) + what + "; " + expected + " was expected"; };
  if (const std::string conversion = known ? "" : field::conversion_hint(path); !conversion.empty())
    return in_quotes(path) + " is " + conversion;
  if (!known) return problem(" has an unknown kind");
  if (!fs::exists(path, code)) return problem(" does not exist");
  if (!fs::is_regular_file(path, code) && !(folders && fs::is_directory(path, code))) return problem(" is not a file");
  return {};
}

bool is_known_file(const Scene& scene, const std::string& path) {
  return std::ranges::any_of(scene.known_files, [&](const std::string& known) { return is_same_file(known, path); });
}

Result<Entity> read_field_name(const Scene& scene, const json::Node& object, std::string_view key) {
  return read_named<FieldSource>(scene, object, key, "field", "fields");
}

std::string to_json(const Scene& scene, const Volume& volume) { return volume_table().write(scene, volume); }
std::string to_json(const Scene& scene, const Isosurface& surface) { return isosurface_table().write(scene, surface); }

/// Loads the fields of the isosurfaces or volumes that are rendered by raycast, and the fields that color them.
template <class T>
static Outcome load_ray_items(Scene& scene) {
  return load_visible<T>(scene, [&](Entity, const T& item) -> Outcome {
    CATENA_CHECK(resolve_rendered_field(scene, item.field, item.where));
    if (item.color_by) CATENA_CHECK(resolve_rendered_field(scene, item.color_by->field, item.color_by->where));
    return Done{};
  });
}

static Part volumes_part() {
  return {make_list_component("volumes", "Scalar fields rendered as volumes, at most four.", volume_table()),
          [](Scene& scene, const json::Node& node) { return read_items(scene, node, volume_table()); }};
}

Drawable volumes() { return make_drawable<Volume>(volumes_part, "volumes", "volume", "volumes", "volume", load_ray_items<Volume>); }

static Part isosurfaces_part() {
  return {make_list_component("isosurfaces", "Isosurfaces of scalar fields. At most eight can be translucent.", isosurface_table()),
          [](Scene& scene, const json::Node& node) { return read_items(scene, node, isosurface_table()); }};
}

Drawable isosurfaces() {
  return make_drawable<Isosurface>(isosurfaces_part, "isosurfaces", "isosurface", "isosurfaces", {}, load_ray_items<Isosurface>);
}

static Part meshes_part() {
  return {make_list_component("meshes", "Triangle meshes, for rendering and haptics.", mesh_table()), read_meshes};
}

static Outcome load_meshes(Scene& scene) {
  return load_visible<SurfaceMesh>(scene, [&](Entity, const SurfaceMesh& surface) -> Outcome {
    CATENA_CHECK(resolve_mesh(scene, surface.mesh));
    if (surface.color_by) CATENA_CHECK(resolve_field(scene, surface.color_by->field, surface.where));
    return Done{};
  });
}

Drawable meshes() { return make_drawable<SurfaceMesh>(meshes_part, "meshes", "mesh", "meshes", {}, load_meshes); }

Part cursor_part() {
  return {{"cursor",
           "Appearance of the probe, the proxies and the force, and the position of the probe in images without a device or a replay.",
           schema::Section::Layout::object, cursor_table().keys()},
          read_cursor};
}

}  // namespace catena::scene
