#include "engine/app/viewer/edit/chain_edit.h"

#include <algorithm>
#include <cmath>

#include "engine/app/viewer/edit/scene_items.h"
#include "engine/base/json_edit.h"
#include "engine/base/numbers.h"
#include "engine/base/text.h"
#include "engine/field/display_range.h"
#include "engine/scene/ruler.h"
#include "engine/scene/write_values.h"
#include "haptics/constraints/presets/modes.h"

namespace catena::app {

namespace {

using schema::Form;
using schema::Role;

/// The field if it can be loaded and is of that kind.
field::AnyField use(scene::Scene& scene, const std::string& name, bool vectors) {
  auto field = scene::use_field(scene, name, json::Node{});
  if (!field || (field->vector != nullptr) != vectors) return {};
  return *field;
}

std::string level_at(const field::ScalarField& field, const Vec3& probe) {
  field::Cursor cursor;
  const DisplayRange range = field::display_range(field);
  const double lo = range.lo, hi = range.hi, here = field.sample(probe, cursor).value;
  const double middle = std::isfinite(lo + hi) ? 0.5 * (lo + hi) : std::isfinite(lo) ? lo + 1 : std::isfinite(hi) ? hi - 1 : 0;
  // six digits: a level is a choice, not a measurement
  const double level = std::isfinite(here) && here > lo && here < hi ? here : middle;
  const double rounded = rounded_to(level, 6);
  return scene::text_of(rounded > lo && rounded < hi ? rounded : level);
}

}  // namespace

std::vector<ChainRow> chain_rows(const scene::Scene& scene, const std::vector<std::string>& link_names) {
  std::vector<ChainRow> rows;
  scene.world.each<scene::Link>([&](scene::Entity, const scene::Link& link) {
    ChainRow row{rows.size(), link.name, link.type, true, link.node, {}};
    if (const json::Node* enabled = link.node.find("enabled")) row.enabled = enabled->kind != json::Kind::boolean || enabled->boolean;
    std::vector<std::string> names{link.name};
    if (const haptics::ReadyMode* mode = haptics::find_ready_mode(link.type)) {
      names.clear();
      for (const auto& part : mode->parts) names.push_back(link.name + "_" + std::string(part.suffix));
    }
    for (const std::string& name : names)
      if (const auto found = std::find(link_names.begin(), link_names.end(), name); found != link_names.end())
        row.links.push_back(static_cast<std::size_t>(found - link_names.begin()));
    rows.push_back(std::move(row));
  });
  return rows;
}

schema::Keys keys_of(std::string_view type) {
  const haptics::ConstraintType* constraint = haptics::find_constraint(type);
  const haptics::ReadyMode* mode = haptics::find_ready_mode(type);
  if (constraint == nullptr && mode == nullptr) return {};
  schema::Keys keys = constraint != nullptr ? constraint->keys : mode->keys;
  for (const schema::Key& key : haptics::common_keys())
    if (key.form == Form::number) keys.push_back(key);
  return keys;
}

std::vector<std::string> link_types() {
  std::vector<std::string> out;
  for (const haptics::ConstraintType& type : haptics::registry()) out.push_back(type.type);
  for (const haptics::ReadyMode& mode : haptics::ready_modes()) out.push_back(mode.type);
  return out;
}

std::vector<std::string> fields_of(const scene::Scene& scene, bool vectors) {
  std::vector<std::string> out;
  scene.world.each<scene::FieldSource>([&](scene::Entity entity, const scene::FieldSource& source) {
    const bool known = source.loaded.get() != nullptr;
    if (!known || (source.loaded.vector != nullptr) == vectors) out.push_back(scene.world.get<scene::Name>(entity).value);
  });
  return out;
}

std::vector<std::string> meshes_of(const scene::Scene& scene) {
  std::vector<std::string> out;
  scene.world.each<scene::MeshSource>(
      [&](scene::Entity entity, const scene::MeshSource&) { out.push_back(scene.world.get<scene::Name>(entity).value); });
  return out;
}

namespace {
template <class T>
std::vector<std::string> names_of(const scene::Scene& scene) {
  std::vector<std::string> out;
  scene.world.each<T>([&](scene::Entity entity, const T&) { out.push_back(scene.world.get<scene::Name>(entity).value); });
  return out;
}
}  // namespace

std::vector<std::string> curves_of(const scene::Scene& scene) { return names_of<scene::DrawnCurves>(scene); }
std::vector<std::string> points_of(const scene::Scene& scene) { return names_of<scene::DrawnPoints>(scene); }

namespace {

/// "0.1 L" as a number, or JSON text; empty: it is words.
std::string length_or_json(const std::string& begin, double length) {
  if (begin.ends_with(" L"))
    if (const auto share = parse_double(std::string_view(begin).substr(0, begin.size() - 2))) return scene::text_of(*share * length);
  return json::parse(begin, "begin") ? begin : std::string();
}

std::string first_level(scene::Scene& scene, const json::Node& link, const Vec3& probe) {
  const json::Node* name = link.find(scene::level_field_key(link));
  if (name == nullptr) return {};
  const field::AnyField field = use(scene, name->string, false);
  if (!field.scalar) return {};
  field::Cursor cursor;
  // what is felt is what is seen
  const std::string seen = drawn_level(scene, name->string, field.scalar->sample(probe, cursor).value);
  return seen.empty() ? level_at(*field.scalar, probe) : seen;
}

std::string first_number(const scene::Scene& scene, const schema::Key& key, double length) {
  for (const std::string& begin : {key.begin, key.fallback})
    if (const std::string text = length_or_json(begin, length); !text.empty()) return text;
  return scene::text_of(key.unit == "N/m" ? scene.coupling.stiffness_n_per_m : 0.02 * length);
}

std::string first_vector(const schema::Key& key, const Vec3& probe, double length) {
  if (key.begin == "hand + 0.1 L") return scene::text_of(probe + Vec3(0.1 * length, 0, 0));
  const std::string text = length_or_json(key.begin, length);
  if (const auto edge = parse_double(text)) return scene::text_of(Vec3(*edge));
  return text.empty() ? scene::text_of(probe) : text;
}

/// The name of a field, a mesh or curves that fit, as JSON text.
std::string first_name(scene::Scene& scene, Role role) {
  if (role == Role::mesh) {
    const auto meshes = meshes_of(scene);
    return meshes.empty() ? "" : scene::text_of(meshes.front());
  }
  if (role == Role::curves || role == Role::points) {
    const auto all = role == Role::curves ? curves_of(scene) : points_of(scene);
    return all.empty() ? "" : scene::text_of(all.front());
  }
  const bool vectors = role == Role::vector_field;
  if (const std::string seen = drawn_field(scene); !vectors && use(scene, seen, false).get() != nullptr) return scene::text_of(seen);
  for (const std::string& name : fields_of(scene, vectors))
    if (use(scene, name, vectors).get() != nullptr) return scene::text_of(name);
  return {};
}

}  // namespace

std::string first_value(scene::Scene& scene, const schema::Key& key, const json::Node& link, const Vec3& probe, double length) {
  if (key.role == Role::level) return first_level(scene, link, probe);
  if (key.role == Role::scalar_field || key.role == Role::vector_field || key.role == Role::mesh || key.role == Role::curves ||
      key.role == Role::points)
    return first_name(scene, key.role);
  switch (key.form) {
    case Form::number:
      return first_number(scene, key, length);
    case Form::vector:
      return first_vector(key, probe, length);
    case Form::word:
      return scene::text_of(key.words.front());
    case Form::boolean:
      return "true";
    case Form::places:
      return scene::text_of(std::vector<Vec3>{probe, probe + Vec3(0.1 * length, 0, 0), probe + Vec3(0.1 * length, 0.1 * length, 0)});
    default:
      return {};
  }
}

Result<std::string> new_link(scene::Scene& scene, std::string_view type, const Vec3& probe, double length,
                             const std::vector<std::pair<std::string, std::string>>& given) {
  // a name that is free
  std::vector<std::string> taken{"t", "probe", "force"};
  scene.world.each<scene::Link>([&](scene::Entity, const scene::Link& link) { taken.push_back(link.name); });
  const std::string name =
      free_name(std::string(type), [&](const std::string& n) { return std::find(taken.begin(), taken.end(), n) != taken.end(); });

  json::Node link;
  link.kind = json::Kind::object;
  std::string text = "\"name\": " + scene::text_of(name) + ", \"type\": " + scene::text_of(type);
  for (const schema::Key& key : keys_of(type)) {
    const auto known = std::ranges::find(given, key.name, &std::pair<std::string, std::string>::first);
    if (known == given.end() && !key.is_required && !key.is_stated) continue;
    const std::string value = known != given.end() ? known->second : first_value(scene, key, link, probe, length);
    if (value.empty() && (key.role == Role::curves || key.role == Role::points))
      return Error{key.name + " cannot be felt, for the scene has none"};
    if (value.empty())
      return Error{"a " + std::string(type) + " needs a " +
                   (key.role == Role::vector_field   ? "vector field"
                    : key.role == Role::scalar_field ? "scalar field"
                    : key.role == Role::mesh         ? "mesh"
                                                     : key.name) +
                   ", which the scene does not have"};
    if (auto node = json::parse(value, "link")) link.members.emplace_back(key.name, std::move(*node));
    text += ", " + scene::text_of(key.name) + ": " + value;
  }
  return "{" + text + "}";
}

std::vector<scene::Document::Edit> added_key(scene::Scene& scene, const ChainRow& row, const schema::Key& key, const Vec3& probe,
                                             double length) {
  const std::string value = first_value(scene, key, row.node, probe, length);
  if (value.empty()) return {};
  std::vector<scene::Document::Edit> edits{{row.pointer(key.name), value}};
  // a surface is one at a level
  if (key.name != "surface" || row.node.find("level") != nullptr) return edits;
  json::Node link = row.node;
  if (auto surface = json::parse(value, "surface")) link.members.emplace_back("surface", std::move(*surface));
  for (const schema::Key& other : keys_of(row.type))
    if (other.role == Role::level)
      if (const std::string level = first_value(scene, other, link, probe, length); !level.empty())
        edits.push_back({row.pointer("level"), level});
  return edits;
}

std::vector<scene::Document::Edit> changed_field(scene::Scene& scene, const ChainRow& row, const schema::Key& key, const std::string& name,
                                                 const Vec3& probe) {
  std::vector<scene::Document::Edit> edits{{row.pointer(key.name), scene::text_of(name)}};
  if (scene::field_of_level(row.node).empty() || key.name != scene::level_field_key(row.node)) return edits;
  // another surface has another level
  json::Node link = row.node;
  for (auto& [member, value] : link.members)
    if (member == key.name) value.string = name;
  for (const schema::Key& other : keys_of(row.type))
    if (other.role == Role::level)
      if (const std::string level = first_value(scene, other, link, probe, 1); !level.empty())
        edits.push_back({row.pointer("level"), level});
  return edits;
}

std::vector<std::string> levels_along(const scene::Scene& scene, const ChainRow& row) {
  const std::string field = scene::field_of_level(row.node);
  if (field.empty() || row.node.find("level")->kind != json::Kind::number) return {};
  const double level = row.node.find("level")->number;
  std::vector<std::string> along = seen_levels(scene, field, level);
  if (along.empty()) return {};
  for (const std::string& pointer : felt_levels(scene, field, level))
    if (pointer != row.pointer("level")) along.push_back(pointer);
  return along;
}

std::vector<scene::Document::Edit> swapped(const ChainRow& a, const ChainRow& b) {
  return {{a.pointer(), json::node_text(b.node)}, {b.pointer(), json::node_text(a.node)}};
}

}  // namespace catena::app
