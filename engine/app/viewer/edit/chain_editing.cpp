// SPDX-License-Identifier: MIT
#include "engine/app/viewer/edit/chain_editing.h"

#include <algorithm>
#include <cmath>

#include "engine/app/viewer/edit/scene_items.h"
#include "engine/base/json_edit.h"
#include "engine/base/numbers.h"
#include "engine/base/text.h"
#include "engine/field/field_display_range.h"
#include "engine/scene/ruler.h"
#include "engine/scene/to_json.h"
#include "engine/scene/unsteady_lines.h"
#include "haptics/constraints/presets/mode_presets.h"

namespace catena::app {

namespace {

using schema::Role;
using schema::ValueType;

/// The named field if it can be loaded and has the requested kind (vectors or scalars).
field::AnyField use(scene::Scene& scene, const std::string& name, bool vectors) {
  auto field = scene::resolve_field(scene, name, json::Node{});
  if (!field || (field->vector != nullptr) != vectors) return {};
  return *field;
}

std::string level_at(const field::ScalarField& field, const Vec3& probe) {
  field::Cursor cursor;
  const DisplayRange range = field::display_range(field);
  const double lo = range.lo, hi = range.hi, here = field.sample(probe, cursor).value;
  const double middle = std::isfinite(lo + hi) ? 0.5 * (lo + hi) : std::isfinite(lo) ? lo + 1 : std::isfinite(hi) ? hi - 1 : 0;
  // rounded to six digits: a level is a choice, not a measurement
  const double level = std::isfinite(here) && here > lo && here < hi ? here : middle;
  const double rounded = round_to_digits(level, 6);
  return scene::to_json(rounded > lo && rounded < hi ? rounded : level);
}

}  // namespace

std::vector<ChainRow> make_chain_rows(const scene::Scene& scene, const std::vector<std::string>& link_names) {
  std::vector<ChainRow> rows;
  scene.entities.each<scene::Link>([&](scene::Entity, const scene::Link& link) {
    ChainRow row{rows.size(), link.name, link.type, true, link.node, {}};
    if (const json::Node* enabled = link.node.find("enabled")) row.enabled = enabled->kind != json::Kind::boolean || enabled->boolean;
    std::vector<std::string> names{link.name};
    if (const haptics::ModePreset* mode = haptics::find_mode_preset(link.type)) {
      names.clear();
      for (const auto& part : mode->link_templates) names.push_back(link.name + "_" + std::string(part.suffix));
    }
    for (const std::string& name : names)
      if (const auto found = std::find(link_names.begin(), link_names.end(), name); found != link_names.end())
        row.links.push_back(static_cast<std::size_t>(found - link_names.begin()));
    rows.push_back(std::move(row));
  });
  return rows;
}

schema::Keys link_type_keys(std::string_view type) {
  const haptics::ConstraintType* constraint = haptics::find_constraint_type(type);
  const haptics::ModePreset* mode = haptics::find_mode_preset(type);
  if (constraint == nullptr && mode == nullptr) return {};
  schema::Keys keys = constraint != nullptr ? constraint->keys : mode->keys;
  for (const schema::Key& key : haptics::common_keys())
    if (key.value_type == ValueType::number) keys.push_back(key);
  return keys;
}

std::vector<std::string> link_types() {
  std::vector<std::string> out;
  for (const haptics::ConstraintType& type : haptics::constraint_types()) out.push_back(type.type);
  for (const haptics::ModePreset& mode : haptics::mode_presets()) out.push_back(mode.type);
  return out;
}

std::vector<std::string> list_field_names(const scene::Scene& scene, bool vectors) {
  std::vector<std::string> out;
  scene.entities.each<scene::FieldSource>([&](scene::Entity entity, const scene::FieldSource& source) {
    const bool known = source.loaded.get() != nullptr;
    if (!known || (source.loaded.vector != nullptr) == vectors) out.push_back(scene.entities.get<scene::Name>(entity).value);
  });
  return out;
}

std::vector<std::string> list_mesh_names(const scene::Scene& scene) {
  std::vector<std::string> out;
  scene.entities.each<scene::MeshSource>(
      [&](scene::Entity entity, const scene::MeshSource&) { out.push_back(scene.entities.get<scene::Name>(entity).value); });
  return out;
}

namespace {
template <class T>
std::vector<std::string> names_of(const scene::Scene& scene) {
  std::vector<std::string> out;
  scene.entities.each<T>([&](scene::Entity entity, const T&) { out.push_back(scene.entities.get<scene::Name>(entity).value); });
  return out;
}
}  // namespace

std::vector<std::string> list_curve_names(const scene::Scene& scene) { return names_of<scene::CurvesSource>(scene); }
std::vector<std::string> list_point_set_names(const scene::Scene& scene) { return names_of<scene::PointsSource>(scene); }

namespace {

/// Returns "0.1 L" as a number, or JSON text; empty if the input is neither and is taken as plain text.
std::string length_or_json(const std::string& begin, double length) {
  if (begin.ends_with(" L"))
    if (const auto share = parse_double(std::string_view(begin).substr(0, begin.size() - 2))) return scene::to_json(*share * length);
  return json::parse(begin, "begin") ? begin : std::string();
}

std::string first_level(scene::Scene& scene, const json::Node& link, const Vec3& probe) {
  const json::Node* name = link.find(scene::level_field_key(link));
  if (name == nullptr) return {};
  const field::AnyField field = use(scene, name->string, false);
  if (!field.scalar) return {};
  field::Cursor cursor;
  // use the level of the visible surface, so that haptics and image agree
  const std::string visible_level = visible_surface_level(scene, name->string, field.scalar->sample(probe, cursor).value);
  return visible_level.empty() ? level_at(*field.scalar, probe) : visible_level;
}

std::string first_number(const scene::Scene& scene, const schema::Key& key, double length) {
  for (const std::string& begin : {key.initial_value, key.default_text})
    if (const std::string text = length_or_json(begin, length); !text.empty()) return text;
  return scene::to_json(key.unit == "N/m" ? scene.coupling.stiffness_n_per_m : 0.02 * length);
}

std::string first_vector(const schema::Key& key, const Vec3& probe, double length) {
  if (key.initial_value == "hand + 0.1 L") return scene::to_json(probe + Vec3(0.1 * length, 0, 0));
  const std::string text = length_or_json(key.initial_value, length);
  if (const auto edge = parse_double(text)) return scene::to_json(Vec3(*edge));
  return text.empty() ? scene::to_json(probe) : text;
}

/// Name of a field, mesh or curves of the given role, as JSON text.
std::string first_name(scene::Scene& scene, Role role) {
  if (role == Role::mesh) {
    const auto meshes = list_mesh_names(scene);
    return meshes.empty() ? "" : scene::to_json(meshes.front());
  }
  if (role == Role::curves || role == Role::points) {
    const auto all = role == Role::curves ? list_curve_names(scene) : list_point_set_names(scene);
    return all.empty() ? "" : scene::to_json(all.front());
  }
  const bool vectors = role == Role::vector_field;
  if (const std::string visible_name = visible_surface_field(scene); !vectors && use(scene, visible_name, false).get() != nullptr)
    return scene::to_json(visible_name);
  for (const std::string& name : list_field_names(scene, vectors))
    if (use(scene, name, vectors).get() != nullptr) return scene::to_json(name);
  return {};
}

/// All times of the link's field.
std::string all_times(const scene::Scene& scene, const json::Node& link) {
  const json::Node* name = link.find("field");
  const scene::Entity field = name != nullptr ? scene::find_field(scene, name->string) : scene::Entity();
  const std::vector<double> times = field ? scene::times_of_field(scene, field) : std::vector<double>();
  return scene::to_json(times.size() > 1 ? std::array{times.front(), times.back()} : scene.time.range);
}

}  // namespace

std::string default_key_value(scene::Scene& scene, const schema::Key& key, const json::Node& link, const Vec3& probe, double length) {
  if (key.role == Role::level) return first_level(scene, link, probe);
  if (key.role == Role::scalar_field || key.role == Role::vector_field || key.role == Role::mesh || key.role == Role::curves ||
      key.role == Role::points)
    return first_name(scene, key.role);
  switch (key.value_type) {
    case ValueType::number:
      return first_number(scene, key, length);
    case ValueType::vector:
      if (key.name == "times") return all_times(scene, link);
      return first_vector(key, probe, length);
    case ValueType::choice:
      return scene::to_json(key.options.front());
    case ValueType::boolean:
      return "true";
    case ValueType::points:
      return scene::to_json(std::vector<Vec3>{probe, probe + Vec3(0.1 * length, 0, 0), probe + Vec3(0.1 * length, 0.1 * length, 0)});
    default:
      return {};
  }
}

Result<std::string> make_link_json(scene::Scene& scene, std::string_view type, const Vec3& probe, double length,
                                   const std::vector<std::pair<std::string, std::string>>& known_keys) {
  // find an unused name
  std::vector<std::string> taken{"t", "probe", "force"};
  scene.entities.each<scene::Link>([&](scene::Entity, const scene::Link& link) { taken.push_back(link.name); });
  const std::string name =
      make_unique_name(std::string(type), [&](const std::string& n) { return std::find(taken.begin(), taken.end(), n) != taken.end(); });

  json::Node link;
  link.kind = json::Kind::object;
  std::string text = "\"name\": " + scene::to_json(name) + ", \"type\": " + scene::to_json(type);
  for (const schema::Key& key : link_type_keys(type)) {
    const auto known = std::ranges::find(known_keys, key.name, &std::pair<std::string, std::string>::first);
    if (known == known_keys.end() && !key.is_required && !key.is_recommended) continue;
    const std::string value = known != known_keys.end() ? known->second : default_key_value(scene, key, link, probe, length);
    if (value.empty() && (key.role == Role::curves || key.role == Role::points))
      return Error{key.name + " cannot be felt: the scene has none"};
    if (value.empty())
      return Error{"a " + std::string(type) + " needs a " +
                   (key.role == Role::vector_field   ? "vector field"
                    : key.role == Role::scalar_field ? "scalar field"
                    : key.role == Role::mesh         ? "mesh"
                                                     : key.name) +
                   ", which the scene does not have"};
    if (auto node = json::parse(value, "link")) link.members.emplace_back(key.name, std::move(*node));
    text += ", " + scene::to_json(key.name) + ": " + value;
  }
  return "{" + text + "}";
}

std::vector<scene::Document::Edit> make_add_key_edits(scene::Scene& scene, const ChainRow& row, const schema::Key& key, const Vec3& probe,
                                                      double length) {
  const std::string value = default_key_value(scene, key, row.node, probe, length);
  if (value.empty()) return {};
  std::vector<scene::Document::Edit> edits{{row.pointer(key.name), value}};
  // a surface key must come with a level
  if (key.name != "surface" || row.node.find("level") != nullptr) return edits;
  json::Node link = row.node;
  if (auto surface = json::parse(value, "surface")) link.members.emplace_back("surface", std::move(*surface));
  for (const schema::Key& other : link_type_keys(row.type))
    if (other.role == Role::level)
      if (const std::string level = default_key_value(scene, other, link, probe, length); !level.empty())
        edits.push_back({row.pointer("level"), level});
  return edits;
}

std::vector<scene::Document::Edit> make_change_field_edits(scene::Scene& scene, const ChainRow& row, const schema::Key& key,
                                                           const std::string& name, const Vec3& probe) {
  std::vector<scene::Document::Edit> edits{{row.pointer(key.name), scene::to_json(name)}};
  if (scene::level_field_name(row.node).empty() || key.name != scene::level_field_key(row.node)) return edits;
  // another surface has another level
  json::Node link = row.node;
  for (auto& [member, value] : link.members)
    if (member == key.name) value.string = name;
  for (const schema::Key& other : link_type_keys(row.type))
    if (other.role == Role::level)
      if (const std::string level = default_key_value(scene, other, link, probe, 1); !level.empty())
        edits.push_back({row.pointer("level"), level});
  return edits;
}

std::vector<std::string> find_coupled_levels(const scene::Scene& scene, const ChainRow& row) {
  const std::string field = scene::level_field_name(row.node);
  if (field.empty() || row.node.find("level")->kind != json::Kind::number) return {};
  const double level = row.node.find("level")->number;
  std::vector<std::string> along = find_isosurface_levels(scene, field, level);
  if (along.empty()) return {};
  for (const std::string& pointer : find_link_levels(scene, field, level))
    if (pointer != row.pointer("level")) along.push_back(pointer);
  return along;
}

std::vector<scene::Document::Edit> make_swap_edits(const ChainRow& a, const ChainRow& b) {
  return {{a.pointer(), json::serialize_node(b.node)}, {b.pointer(), json::serialize_node(a.node)}};
}

}  // namespace catena::app
