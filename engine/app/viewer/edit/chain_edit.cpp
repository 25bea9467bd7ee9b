#include "engine/app/viewer/edit/chain_edit.h"

#include <algorithm>
#include <cmath>

#include "engine/app/viewer/edit/scene_items.h"
#include "engine/scene/link_feature.h"
#include "engine/scene/write_values.h"
#include "haptics/constraints/presets/modes.h"

namespace catena::app {

namespace {

using Kind = LinkKey::Kind;

LinkKey key_of(const schema::Key& key) {
  using schema::Form;
  using schema::Role;
  LinkKey out{key.name, key.help, Kind::other, key.is_required, false, key.words, key.is_stated};
  out.positive = key.limits.lo == 0.0;
  if (key.form == Form::number) out.kind = Kind::number;
  if (key.form == Form::boolean) out.kind = Kind::boolean;
  if (key.form == Form::vector && key.count == 3) out.kind = Kind::vector;
  if (key.form == Form::word) out.kind = Kind::choice;
  if (key.role == Role::scalar_field) out.kind = Kind::scalar_field;
  if (key.role == Role::vector_field) out.kind = Kind::vector_field;
  if (key.role == Role::mesh) out.kind = Kind::mesh;
  return out;
}

/// The field if it can be loaded and is of that kind.
field::AnyField use(scene::Scene& scene, const std::string& name, bool vectors) {
  auto field = scene::use_field(scene, name, json::Node{});
  if (!field || (field->vector != nullptr) != vectors) return {};
  return *field;
}

std::string level_at(const field::ScalarField& field, const Vec3& probe) {
  field::Cursor cursor;
  const double lo = field.min_value(), hi = field.max_value(), here = field.sample(probe, cursor).value;
  const double middle = std::isfinite(lo + hi) ? 0.5 * (lo + hi) : std::isfinite(lo) ? lo + 1 : std::isfinite(hi) ? hi - 1 : 0;
  // six digits: a level is a choice, not a measurement
  const double level = std::isfinite(here) && here > lo && here < hi ? here : middle;
  const double unit = level != 0 ? std::pow(10.0, std::floor(std::log10(std::abs(level))) - 5) : 1;
  const double rounded = std::round(level / unit) * unit;
  return scene::text_of(rounded > lo && rounded < hi ? rounded : level);
}

}  // namespace

std::string json_of(const json::Node& node) {
  std::string out;
  switch (node.kind) {
    case json::Kind::null:
      return "null";
    case json::Kind::boolean:
      return node.boolean ? "true" : "false";
    case json::Kind::number:
      return scene::text_of(node.number);
    case json::Kind::string:
      return scene::text_of(node.string);
    case json::Kind::array:
      for (const json::Node& item : node.items) out += (out.empty() ? "" : ", ") + json_of(item);
      return "[" + out + "]";
    case json::Kind::object:
      for (const auto& [key, value] : node.members) out += (out.empty() ? "" : ", ") + scene::text_of(key) + ": " + json_of(value);
      return "{" + out + "}";
  }
  return out;
}

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

std::vector<LinkKey> keys_of(std::string_view type) {
  std::vector<LinkKey> out;
  const haptics::ConstraintType* constraint = haptics::find_constraint(type);
  const haptics::ReadyMode* mode = haptics::find_ready_mode(type);
  if (constraint == nullptr && mode == nullptr) return out;
  for (const schema::Key& key : constraint != nullptr ? constraint->keys : mode->keys) out.push_back(key_of(key));
  for (const schema::Key& key : haptics::common_keys())
    if (key.name == "stiffness" || key.name == "snap" || key.name == "release") out.push_back(key_of(key));
  return out;
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

std::string first_value(scene::Scene& scene, const LinkKey& key, const json::Node& link, const Vec3& probe, double length) {
  const auto along = [&](double x) { return scene::text_of(probe + Vec3(x * length, 0, 0)); };
  switch (key.kind) {
    case Kind::vector:
      if (key.name == "normal") return "[0, 0, 1]";
      if (key.name == "direction") return "[1, 0, 0]";
      if (key.name == "size") return scene::text_of(Vec3(0.2 * length));
      return along(key.name == "to" ? 0.1 : 0);
    case Kind::number: {
      if (key.name == "level") {
        if (const json::Node* name = link.find(scene::level_field_key(link)); name != nullptr) {
          const field::AnyField field = use(scene, name->string, false);
          if (!field.scalar) return {};
          field::Cursor cursor;
          // what is felt is what is seen
          const std::string seen = drawn_level(scene, name->string, field.scalar->sample(probe, cursor).value);
          return seen.empty() ? level_at(*field.scalar, probe) : seen;
        }
        return {};
      }
      if (key.name == "radius") return scene::text_of(0.1 * length);
      if (key.name == "search") {
        const json::Node* radius = link.find("radius");
        return scene::text_of(std::max(0.1 * length, radius != nullptr ? 2 * radius->number : 0));
      }
      if (key.name == "stiffness") return scene::text_of(scene.coupling.stiffness_n_per_m);
      if (key.name == "time") return "0.05";
      if (key.name == "coefficient") return "2";
      if (key.name == "amplitude") return "0.5";
      if (key.name == "tolerance") return "1e-4";
      if (key.name == "min_speed") return "0";
      if (key.name == "release") return scene::text_of(0.05 * length);
      if (key.name == "tau_min") return scene::text_of(0.001 * length);
      if (key.name == "threshold") return scene::text_of(0.005 * length);
      if (key.name == "tau_max") return scene::text_of(0.01 * length);
      return scene::text_of(0.02 * length);
    }
    case Kind::choice:
      return key.words.empty() ? "" : scene::text_of(key.words.front());
    case Kind::boolean:
      return "true";
    case Kind::scalar_field:
      if (const std::string seen = drawn_field(scene); use(scene, seen, false).get() != nullptr) return scene::text_of(seen);
      [[fallthrough]];
    case Kind::vector_field:
      for (const std::string& name : fields_of(scene, key.kind == Kind::vector_field))
        if (use(scene, name, key.kind == Kind::vector_field).get() != nullptr) return scene::text_of(name);
      return {};
    case Kind::mesh: {
      const auto meshes = meshes_of(scene);
      return meshes.empty() ? "" : scene::text_of(meshes.front());
    }
    case Kind::other:
      if (key.name == "points")
        return scene::text_of(std::vector<Vec3>{probe, probe + Vec3(0.1 * length, 0, 0), probe + Vec3(0.1 * length, 0.1 * length, 0)});
      return {};
  }
  return {};
}

Result<std::string> new_link(scene::Scene& scene, std::string_view type, const Vec3& probe, double length) {
  // a name that is free
  std::vector<std::string> taken{"t", "probe", "force"};
  scene.world.each<scene::Link>([&](scene::Entity, const scene::Link& link) { taken.push_back(link.name); });
  std::string name(type);
  for (int n = 2; std::find(taken.begin(), taken.end(), name) != taken.end(); ++n) name = std::string(type) + "_" + std::to_string(n);

  json::Node link;
  link.kind = json::Kind::object;
  std::string text = "\"name\": " + scene::text_of(name) + ", \"type\": " + scene::text_of(type);
  for (const LinkKey& key : keys_of(type)) {
    if (!key.required && !key.stated) continue;
    const std::string value = first_value(scene, key, link, probe, length);
    if (value.empty())
      return Error{"a " + std::string(type) + " needs a " +
                   (key.kind == Kind::vector_field   ? "vector field"
                    : key.kind == Kind::scalar_field ? "scalar field"
                    : key.kind == Kind::mesh         ? "mesh"
                                                     : key.name) +
                   ", which the scene does not have"};
    if (auto node = json::parse(value, "link")) link.members.emplace_back(key.name, std::move(*node));
    text += ", " + scene::text_of(key.name) + ": " + value;
  }
  return "{" + text + "}";
}

std::vector<scene::Document::Edit> added_key(scene::Scene& scene, const ChainRow& row, const LinkKey& key, const Vec3& probe,
                                             double length) {
  const std::string value = first_value(scene, key, row.node, probe, length);
  if (value.empty()) return {};
  std::vector<scene::Document::Edit> edits{{row.pointer(key.name), value}};
  // a surface is one at a level
  if (key.name != "surface" || row.node.find("level") != nullptr) return edits;
  json::Node link = row.node;
  if (auto surface = json::parse(value, "surface")) link.members.emplace_back("surface", std::move(*surface));
  for (const LinkKey& other : keys_of(row.type))
    if (other.name == "level")
      if (const std::string level = first_value(scene, other, link, probe, length); !level.empty())
        edits.push_back({row.pointer("level"), level});
  return edits;
}

std::vector<scene::Document::Edit> changed_field(scene::Scene& scene, const ChainRow& row, const LinkKey& key, const std::string& name,
                                                 const Vec3& probe) {
  std::vector<scene::Document::Edit> edits{{row.pointer(key.name), scene::text_of(name)}};
  if (scene::field_of_level(row.node).empty() || key.name != scene::level_field_key(row.node)) return edits;
  // another surface has another level
  json::Node link = row.node;
  for (auto& [member, value] : link.members)
    if (member == key.name) value.string = name;
  for (const LinkKey& other : keys_of(row.type))
    if (other.name == "level")
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
  return {{a.pointer(), json_of(b.node)}, {b.pointer(), json_of(a.node)}};
}

}  // namespace catena::app
