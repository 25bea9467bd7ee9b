#include <filesystem>

#include "engine/base/numbers.h"
#include "engine/base/text.h"
#include "engine/scene/hidden.h"
#include "engine/scene/read_parts.h"
#include "engine/scene/read_transfer.h"

namespace catena::scene {
namespace {

Result<Rgb> get_color(const json::Node& object, std::string_view key, const Rgb& fallback) {
  const json::Node* node = object.find(key);
  if (node == nullptr) return fallback;
  CATENA_TRY(const Vec3 c, json::as_vec3(*node, key));
  return as_color(c, *node, key);
}

/// Empty where `path` is a mesh file that is there.
std::string mesh_fault(const std::string& path) {
  std::error_code code;
  if (!mesh::is_mesh_file(path)) return in_quotes(path) + " has an unknown kind; a .stl or .obj file was expected";
  if (!std::filesystem::exists(path, code)) return in_quotes(path) + " does not exist; a .stl or .obj file was expected";
  if (!std::filesystem::is_regular_file(path, code)) return in_quotes(path) + " is not a file; a .stl or .obj file was expected";
  return {};
}

/// "color", or "color_by": a field's name, and the colours of read_transfer.h.
Outcome read_mesh_color(const Scene& scene, const json::Node& item, SurfaceMesh& surface) {
  if (item.find("color_by") == nullptr) {
    for (const char* key : {"range", "transfer"})
      if (const json::Node* node = item.find(key))
        return json::error_at(*node, in_quotes(key) + " is given, but nothing says of what; \"color_by\": a field was expected beside it");
    CATENA_TRY(surface.color, get_color(item, "color", surface.color));
    return Done{};
  }
  surface.color_by.emplace();
  CATENA_TRY(surface.color_by->field, read_field_name(scene, item, "color_by"));
  CATENA_TRY(ColorScale scale, read_color_scale(scene.path, item));
  surface.color_by->colors = std::move(scale.colors);
  surface.color_by->named = std::move(scale.named);
  return Done{};
}

/// Calls read(item) for each object of an array.
template <class Read>
Outcome each_item(const json::Node& node, std::string_view what, Read&& read) {
  if (node.kind != json::Kind::array) return json::error_at(node, in_quotes(what) + " is no array; an array of objects was expected");
  for (const json::Node& item : node.items) {
    CATENA_CHECK(json::expect_object(item, item.label));
    CATENA_CHECK(read(item));
  }
  return Done{};
}

}  // namespace

Result<double> read_opacity(const json::Node& object, double fallback) {
  CATENA_TRY(const double opacity, json::get_number(object, "opacity", fallback, json::Range::not_negative));
  if (opacity > 1)
    return json::error_at(*object.find("opacity"), "\"opacity\" is " + to_text(opacity) + "; a number from 0 to 1 was expected");
  return opacity;
}

Result<Rgb> as_color(const Vec3& c, const json::Node& node, std::string_view what) {
  for (int i = 0; i < 3; ++i)
    if (!(c[i] >= 0 && c[i] <= 1))
      return json::error_at(node, in_quotes(what) + " holds " + to_text(c[i]) + "; colour components from 0 to 1 were expected");
  return Rgb{static_cast<float>(c.x), static_cast<float>(c.y), static_cast<float>(c.z)};
}

Result<Rgb> read_color(const json::Node& object, std::string_view key, const Rgb& fallback) { return get_color(object, key, fallback); }

Result<Entity> read_field_name(const Scene& scene, const json::Node& object, std::string_view key) {
  CATENA_TRY(const std::string name, json::require_string(object, key));
  if (const Entity field = find_field(scene, name)) return field;
  std::vector<std::string_view> names;
  scene.world.each<FieldSource>([&](Entity e, const FieldSource&) { names.push_back(scene.world.get<Name>(e).value); });
  return json::error_at(*object.find(key), "unknown field " + in_quotes(name) + "; known: " + (names.empty() ? "none" : joined(names)) +
                                               ", one of \"fields\" was expected" + suggestion(name, names));
}

Outcome read_volumes(Scene& scene, const json::Node& node) {
  return each_item(node, "volumes", [&](const json::Node& item) -> Outcome {
    CATENA_CHECK(json::only_keys(item, {"field", "color", "range", "transfer", "opacity", "opacity_unit", "extinction", "gradient_opacity",
                                        "shade", "clip", "visible", "projection", "color_by"}));
    Volume volume;
    volume.where = item;
    CATENA_TRY(volume.field, read_field_name(scene, item));
    CATENA_TRY(volume.transfer, read_transfer(scene.path, item));
    CATENA_TRY(volume.shade, json::get_boolean(item, "shade", false));
    CATENA_TRY(volume.clipped, json::get_boolean(item, "clip", true));
    CATENA_TRY(volume.color_by, read_field_colors(scene, item));
    CATENA_CHECK(read_projection(volume, item));
    const Entity e = scene.world.create();
    scene.world.emplace<Volume>(e, std::move(volume));
    return read_visible(scene, e, item);
  });
}

Outcome read_isosurfaces(Scene& scene, const json::Node& node) {
  return each_item(node, "isosurfaces", [&](const json::Node& item) -> Outcome {
    CATENA_CHECK(json::only_keys(item, {"field", "level", "color", "opacity", "clip", "visible", "color_by"}));
    Isosurface surface;
    surface.where = item;
    CATENA_TRY(surface.field, read_field_name(scene, item));
    CATENA_TRY(surface.clipped, json::get_boolean(item, "clip", true));
    CATENA_TRY(surface.color_by, read_field_colors(scene, item));
    if (const json::Node* level = item.find("level"); level != nullptr && level->kind == json::Kind::object) {
      CATENA_CHECK(json::only_keys(*level, {"widget"}));
      CATENA_TRY(surface.level_from, read_widget_name(scene, *level, {widget::Kind::isolevel}, "an isolevel"));
    } else {
      CATENA_TRY(surface.level, json::require_number(item, "level"));
    }
    CATENA_TRY(surface.color, get_color(item, "color", surface.color));
    CATENA_TRY(surface.opacity, read_opacity(item, surface.opacity));
    const Entity e = scene.world.create();
    scene.world.emplace<Isosurface>(e, std::move(surface));
    return read_visible(scene, e, item);
  });
}

Outcome read_meshes(Scene& scene, const json::Node& node) {
  return each_item(node, "meshes", [&](const json::Node& item) -> Outcome {
    CATENA_CHECK(json::only_keys(item, {"name", "file", "scale", "offset", "drawn", "color", "color_by", "range", "transfer", "opacity",
                                        "shading", "edges", "clip", "visible"}));
    CATENA_TRY(const std::string name, json::require_string(item, "name"));
    if (!is_name(name))
      return json::error_at(*item.find("name"),
                            "mesh name " + in_quotes(name) + " is not allowed; a name like [a-z][a-z0-9_]* was expected");
    if (find_mesh(scene, name))
      return json::error_at(*item.find("name"), "a second mesh is called " + in_quotes(name) + "; a name of its own was expected");
    MeshSource source;
    source.where = item;
    CATENA_TRY(const std::string file, json::require_string(item, "file"));
    source.path = resolved_path(scene.path, file);
    if (const std::string fault = mesh_fault(source.path); !fault.empty())
      return json::error_at(*item.find("file"), "mesh " + in_quotes(name) + ": file " + fault);
    CATENA_TRY(source.placement.scale, json::get_number(item, "scale", 1, json::Range::positive));
    CATENA_TRY(source.placement.offset, json::get_vec3(item, "offset", source.placement.offset));
    SurfaceMesh surface;
    surface.where = item;
    CATENA_CHECK(read_mesh_color(scene, item, surface));
    CATENA_TRY(surface.opacity, read_opacity(item, surface.opacity));
    CATENA_TRY(const int shading, json::get_choice(item, "shading", 0, {"flat", "smooth"}));
    surface.smooth = shading == 1;
    CATENA_TRY(surface.edges, json::get_boolean(item, "edges", false));
    CATENA_TRY(surface.clipped, json::get_boolean(item, "clip", true));
    CATENA_TRY(const bool drawn, json::get_boolean(item, "drawn", true));
    surface.mesh = scene.world.create();
    scene.world.emplace<Name>(surface.mesh, {name});
    scene.world.emplace<MeshSource>(surface.mesh, std::move(source));
    const Entity e = scene.world.create();
    if (drawn) scene.world.emplace<SurfaceMesh>(e, std::move(surface));
    return read_visible(scene, e, item);
  });
}

/// Where the glyph stands in a still picture; a device or a replay moves it.
Outcome read_cursor(Scene& scene, const json::Node& node) {
  CATENA_CHECK(json::expect_object(node, "cursor"));
  CATENA_CHECK(json::only_keys(node, {"probe", "size"}));
  Cursor& cursor = scene.world.get<Cursor>(scene.cursor);
  CATENA_TRY(const auto probe, json::get_optional_vec3(node, "probe"));
  if (probe) {
    cursor.probe = *probe;
    cursor.visible = true;
  }
  CATENA_TRY(cursor.size, json::get_number(node, "size", 0, json::Range::positive));
  return Done{};
}

}  // namespace catena::scene
