// SPDX-License-Identifier: MIT
#include "engine/app/viewer/edit/haptic_binding.h"

#include <cmath>
#include <limits>

#include "engine/app/viewer/edit/chain_editing.h"
#include "engine/app/viewer/edit/remove_item.h"
#include "engine/base/json_edit.h"
#include "engine/base/numbers.h"
#include "engine/base/text.h"
#include "engine/scene/labels.h"
#include "engine/scene/streamlines.h"
#include "engine/scene/to_json.h"

namespace catena::app {

namespace {

constexpr double kSnapShare = 0.02;  // fraction of the diagonal of all lines or points

/// Returns the list of an item: "isosurfaces" for "isosurfaces[2]".
std::string part_of(const std::string& item) { return item.substr(0, item.find('[')); }

/// Side of a level on which the camera is: by the gradient at the picked point, otherwise by the field's corners, which count as outside.
const char* side_of_eye(const field::ScalarField& field, double level, const std::optional<Vec3>& at, const Vec3& camera_position) {
  field::Cursor cursor;
  if (at) {
    const double rises = dot(field.sample(*at, cursor).gradient, camera_position - *at);
    if (rises != 0) return rises > 0 ? "above" : "below";
  }
  int above = 0;
  for (int k = 0; k < 8; ++k) above += field.sample(field.corner(k), cursor).value > level ? 1 : -1;
  return above > 0 ? "above" : "below";
}

/// Keys, as JSON text, that an item contributes to the link on it, and the label shown for it.
struct Given {
  std::vector<std::pair<std::string, std::string>> keys;
  std::string words;
  std::optional<std::pair<std::string, std::string>> field{};
  bool is_label = false;
};

/// Converts a label's name to a field name that matches [a-z][a-z0-9_]*.
std::string field_name_of(const std::string& label) {
  std::string name;
  for (const char c : label)
    name += c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') ? c : '_';
  return !name.empty() && name[0] >= 'a' && name[0] <= 'z' ? name : "label_" + name;
}

/// Link keys for the surface of the label at a point of a label map; std::nullopt where there is none. `smooth`: smoothing of the surface;
/// if absent, the default.
std::optional<Given> given_by_label(const scene::Scene& scene, const std::string& map_name, const Vec3& at, std::optional<double> smooth) {
  const scene::Entity entity = scene::find_field(scene, map_name);
  const scene::LabelMap* map = entity ? scene::find_label_map(scene, entity) : nullptr;
  if (map == nullptr) return std::nullopt;
  const double value = field::label_at(*scene::loaded_field(scene, entity).scalar->grid(), at);
  const scene::LabelEntry* label = map->find(value);
  if (label == nullptr) return std::nullopt;
  scene::LabelSource requested{map_name, {value}, {}, false, smooth.value_or(field::kDefaultLabelSmoothing)};
  std::string name;
  scene.entities.each<scene::FieldSource>([&](scene::Entity e, const scene::FieldSource& source) {
    if (source.label == requested) name = entity_name(scene, e);
  });
  Given given;
  if (name.empty()) {
    name = make_unique_name(field_name_of(label->name.empty() ? to_text(value) : label->name),
                            [&](const std::string& taken) { return bool(scene::find_field(scene, taken)); });
    given.field = {"/fields/" + name,
                   "{\"label\": " + scene::to_json(value) + ", \"of\": " + scene::to_json(map_name) +
                       (smooth && *smooth != field::kDefaultLabelSmoothing ? ", \"smooth\": " + scene::to_json(*smooth) : "") + "}"};
  }
  given.is_label = true;
  given.words = "label " + scene::describe_label(*map, value);
  given.keys = {{"field", scene::to_json(name)}, {"level", scene::to_json(field::kLabelLevel)}, {"free", "\"below\""}};
  return given;
}

Result<Given> given_by(scene::Scene& scene, const scene::Isosurface& surface, const std::optional<Vec3>& at, const Vec3& camera_position) {
  const std::string name = entity_name(scene, surface.field);
  CATENA_TRY(const field::AnyField field, scene::resolve_field(scene, surface.field, surface.where));
  if (!field.scalar) return Error{in_quotes(name) + " is not a scalar field and has no surface to feel"};
  const auto& label = scene.entities.get<scene::FieldSource>(surface.field).label;
  if (at && label && (label->all_labels || label->values.size() + label->names.size() > 1))
    if (auto given = given_by_label(scene, label->label_map, *at, label->smoothing_voxels)) return *std::move(given);
  const std::string level = surface.level_widget ? "{\"widget\": " + scene::to_json(entity_name(scene, surface.level_widget)) + "}"
                                                 : scene::to_json(surface.level);
  return Given{{{"field", scene::to_json(name)},
                {"level", level},
                {"free", scene::to_json(std::string(side_of_eye(*field.scalar, surface.level, at, camera_position)))}},
               "isosurface " + name + " at " + to_text(surface.level)};
}

Result<Given> given_by(scene::Scene& scene, const scene::Volume& volume, const std::optional<Vec3>& at, const Vec3& camera_position) {
  const std::string name = entity_name(scene, volume.field);
  if (!at) return Error{"no point of volume " + name + " is selected: point at the volume in the image and press H"};
  CATENA_TRY(const field::AnyField field, scene::resolve_field(scene, volume.field, volume.where));
  if (!field.scalar) return Error{in_quotes(name) + " is not a scalar field and has no surface to feel"};
  if (scene::find_label_map(scene, volume.field) != nullptr) {
    if (auto given = given_by_label(scene, name, *at, {})) return *std::move(given);
    return Error{"volume " + name + " has no label under the pointer"};
  }
  field::Cursor cursor;
  const field::ScalarSample here = field.scalar->sample(*at, cursor);
  if (!here.inside || !std::isfinite(here.value)) return Error{"volume " + name + " has no value under the pointer"};
  if (!(field.scalar->min_value() < field.scalar->max_value()))
    return Error{"volume " + name + " has the same value everywhere and no surface to feel"};
  // rounded to four digits: a level is a choice, not a measurement
  const double rounded = round_to_digits(here.value, 4);
  const bool fits = rounded > field.scalar->min_value() && rounded < field.scalar->max_value();
  const double level = fits ? rounded : here.value;
  return Given{{{"field", scene::to_json(name)},
                {"level", scene::to_json(level)},
                {"free", scene::to_json(std::string(side_of_eye(*field.scalar, level, at, camera_position)))}},
               "isosurface of volume " + name + " at " + to_text(level)};
}

Result<Given> given_by(scene::Scene& scene, scene::Entity entity, const scene::StreamlineSet& set, const std::optional<Vec3>& at) {
  const std::string name = entity_name(scene, set.field);
  Given given{{{"field", scene::to_json(name)}}, "streamline of " + name};
  if (set.is_line_field) given.keys.emplace_back("kind", "\"line\"");
  if (set.min_speed > 0) given.keys.emplace_back("min_speed", scene::to_json(set.min_speed));
  if (set.seeds.widget && set.seeds.count == 1) {
    given.keys.emplace_back("seed", "{\"widget\": " + scene::to_json(entity_name(scene, set.seeds.widget)) + "}");
    return given;
  }
  CATENA_TRY(const std::vector<flow::CurvePtr> lines, scene::resolve_lines(scene, entity));
  const flow::Curve* nearest = nullptr;
  double minimum = std::numeric_limits<double>::infinity();
  for (const flow::CurvePtr& line : lines) {
    for (const flow::Knot& knot : line->knots()) {
      const Vec3 away = at ? knot.p - *at : Vec3(0.0);
      if (!(dot(away, away) < minimum)) continue;
      minimum = dot(away, away);
      nearest = line.get();
      if (!at) break;
    }
  }
  if (nearest == nullptr) return Error{"streamlines of " + name + " have no line to feel"};
  given.keys.emplace_back("seed", scene::to_json(nearest->position(0)));
  return given;
}

Result<Given> given_by(const scene::Scene& scene, const scene::Slice& slice) {
  if (slice.where.find("widget") != nullptr) return Error{"this slice follows a widget; grab the widget to feel its plane"};
  return Given{{{"point", scene::to_json(slice.point)}, {"normal", scene::to_json(slice.normal)}},
               "slice " + entity_name(scene, slice.color_by.field)};
}

/// Side of the mesh face at the picked point on which the camera is, "above" where its normal points; without a point: outside.
const char* side_of_eye(const mesh::TriangleMesh& mesh, const std::optional<Vec3>& at, const Vec3& camera_position) {
  if (!at) return "above";
  int budget = static_cast<int>(std::min<std::size_t>(4 * mesh.triangles().size() + 64, 1 << 30));
  const mesh::NearestResult nearest = mesh::nearest_point(mesh, *at, std::numeric_limits<double>::infinity(), budget);
  if (!nearest.found) return "above";
  return dot(mesh::normal_at(mesh, nearest.closest), camera_position - *at) >= 0 ? "above" : "below";
}

Result<Given> given_by(scene::Scene& scene, const scene::SurfaceMesh& surface, const std::optional<Vec3>& at, const Vec3& camera_position) {
  const std::string name = entity_name(scene, surface.mesh);
  CATENA_TRY(const mesh::MeshPtr mesh, scene::resolve_mesh(scene, surface.mesh));
  return Given{{{"mesh", scene::to_json(name)}, {"free", scene::to_json(std::string(side_of_eye(*mesh, at, camera_position)))}},
               "mesh " + name};
}

Result<Given> curves_given(scene::Scene& scene, scene::Entity entity) {
  const std::string name = entity_name(scene, entity);
  CATENA_TRY(const curves::CurveSetPtr set, scene::resolve_curves(scene, entity));
  const double snap = round_to_digits(kSnapShare * norm(set->max_corner - set->min_corner), 2);
  return Given{{{"curves", scene::to_json(name)}, {"snap", scene::to_json(snap)}}, "curves " + name};
}

Result<Given> points_given(scene::Scene& scene, scene::Entity entity) {
  const std::string name = entity_name(scene, entity);
  CATENA_TRY(const curves::PointSetPtr set, scene::resolve_points(scene, entity));
  const double diagonal = set->robust_bounds.box.diagonal();
  const double snap = round_to_digits(std::max(kSnapShare * (diagonal > 0 ? diagonal : 1), 0.5 * set->median_spacing), 2);
  return Given{{{"points", scene::to_json(name)}, {"snap", scene::to_json(snap)}}, "points " + name};
}

Result<Given> given_by(scene::Scene& scene, const std::string& item, const std::optional<Vec3>& at, const Vec3& camera_position) {
  if (const auto surface = find_item<scene::Isosurface>(scene, item)) return given_by(scene, *surface, at, camera_position);
  if (const auto volume = find_item<scene::Volume>(scene, item)) return given_by(scene, *volume, at, camera_position);
  scene::Entity entity;
  if (const auto set = find_item<scene::StreamlineSet>(scene, item, &entity)) return given_by(scene, entity, *set, at);
  if (const auto slice = find_item<scene::Slice>(scene, item)) return given_by(scene, *slice);
  if (find_item<scene::PointsSource>(scene, item, &entity)) return points_given(scene, entity);
  if (find_item<scene::CurvesSource>(scene, item, &entity)) return curves_given(scene, entity);
  if (const auto mesh = find_item<scene::SurfaceMesh>(scene, item)) return given_by(scene, *mesh, at, camera_position);
  return Error{item + " was removed from the scene"};
}

}  // namespace

const haptics::ConstraintType* find_constraint_type(std::string_view part) {
  if (part == "volumes") part = "isosurfaces";
  for (const haptics::ConstraintType& type : haptics::constraint_types())
    if (type.scene_section == part) return &type;
  return nullptr;
}

bool can_bind_haptics(std::string_view part) { return find_constraint_type(part) != nullptr; }

Result<HapticBinding> make_haptic_binding(scene::Scene& scene, const std::string& item, const std::optional<Vec3>& at,
                                          const Vec3& camera_position, double length) {
  const std::string part = part_of(item);
  const haptics::ConstraintType* type = find_constraint_type(part);
  if (type == nullptr) return Error{part + " cannot be felt"};
  CATENA_TRY(const Given given, given_by(scene, item, at, camera_position));
  CATENA_TRY(const std::string link, make_link_json(scene, type->type, at.value_or(camera_position), length, given.keys));
  return HapticBinding{link, given.words, given.field, given.is_label};
}

std::string find_bound_link(const scene::Scene& scene, const HapticBinding& binding) {
  const auto parsed_link = json::parse(binding.link_json, "link");
  std::string name;
  scene.entities.each<scene::Link>([&](scene::Entity, const scene::Link& link) {
    if (!name.empty() || !parsed_link) return;
    for (const auto& [key, value] : parsed_link->members) {
      if (key == "name" || key == "free" || key == "release" || key == "snap") continue;
      const json::Node* stated = link.node.find(key);
      if (stated == nullptr || json::serialize_node(*stated) != json::serialize_node(value)) return;
    }
    name = link.name;
  });
  return name;
}

TextEdits make_binding_edits(scene::Scene& scene, const std::string& item, const HapticBinding& binding) {
  TextEdits edits;
  if (binding.new_field) edits.push_back({binding.new_field->first, binding.new_field->second});
  // a different label of the same map counts as a different item
  const std::vector<std::string> before = binding.is_label ? std::vector<std::string>() : find_links_on(scene, item);
  const auto link = json::parse(binding.link_json, "link");
  if (before.empty() || !link) {
    edits.push_back({"/chain/-", binding.link_json});
    return edits;
  }
  for (const auto& [key, value] : link->members)
    if (key != "name") edits.push_back({before.back() + "/" + json::escape_pointer_token(key), json::serialize_node(value)});
  return edits;
}

std::vector<std::string> find_coplanar_links(const scene::Scene& scene, const Vec3& point, const Vec3& normal) {
  std::vector<std::string> pointers;
  const auto is = [](const json::Node* node, const Vec3& v) {
    if (node == nullptr) return false;
    const auto stated = json::as_vec3(*node, "plane");
    return stated && *stated == v;
  };
  const haptics::ConstraintType* type = find_constraint_type("slices");
  scene.entities.each<scene::Link>([&](scene::Entity, const scene::Link& link) {
    if (type == nullptr || link.type != type->type || !is(link.node.find("point"), point) || !is(link.node.find("normal"), normal)) return;
    if (const std::string pointer = item_pointer(link.node); !pointer.empty()) pointers.push_back(pointer);
  });
  return pointers;
}

}  // namespace catena::app
