#include "haptics/extract/make_link.h"

#include <algorithm>
#include <string>

#include "engine/base/hash.h"
#include "engine/base/numbers.h"
#include "haptics/constraints/rules/link_keys.h"
#include "haptics/constraints/rules/read_parameter.h"

namespace catena::haptics {

namespace {

/// What a link was built from: its text but for "enabled" (one that is switched off and on again has not become another), and the versions
/// of its fields and meshes.
void add_recipe(const json::Node& node, Fnv1a& recipe) {
  recipe.add(static_cast<int>(node.kind));
  recipe.add(node.boolean);
  recipe.add(node.number);
  recipe.bytes(node.string.data(), node.string.size());
  for (const json::Node& item : node.items) add_recipe(item, recipe);
  for (const auto& [key, value] : node.members) {
    recipe.bytes(key.data(), key.size() + 1);
    add_recipe(value, recipe);
  }
}

/// A baseline lets go by itself (haptics/chain/baseline.h): "release" goes from the constraint's node to the link. Its linear
/// method knows of a streamline only what the field says at the proxy.
Result<json::Node> node_for_baseline(const json::Node& from, CouplingMethod method, Link& link) {
  json::Node node = from;
  const ConstraintType* type = find_constraint(from.find("type")->string);
  if (type == nullptr) return node;
  const auto has = [&](std::string_view key) {
    return std::any_of(type->keys.begin(), type->keys.end(), [&](const schema::Key& k) { return k.name == key; });
  };
  if (const json::Node* snap = from.find("snap"))
    return json::error_at(*snap, "\"snap\" needs a proxy of the link's own; \"method\": \"chain\" was expected in \"coupling\"");
  if (const json::Node* release = from.find("release"); release != nullptr) {
    if (release->kind == json::Kind::object)
      return json::error_at(*release,
                            "\"release\" follows a field; a number was expected, for \"coupling\" has a \"method\" other than chain");
    CATENA_TRY(link.release, json::as_number(*release, "release", json::Range::positive));
    std::erase_if(node.members, [](const auto& member) { return member.first == "release"; });
  }
  if (method == CouplingMethod::linear && has("follow") && node.find("follow") == nullptr && node.find("method") == nullptr) {
    json::Node online;
    online.kind = json::Kind::string;
    online.line = node.line;
    online.file = node.file;
    online.label = "follow";
    online.string = "online";
    node.members.emplace_back("follow", online);
  }
  return node;
}

}  // namespace

Result<Link> make_link(const json::Node& from, const Coupling& coupling, const BuildContext& context) {
  Link link;
  Fnv1a recipe;
  json::Node own = from;
  std::erase_if(own.members, [](const auto& member) { return member.first == "enabled"; });
  add_recipe(own, recipe);
  if (coupling.method != CouplingMethod::chain) recipe.add(static_cast<int>(coupling.method));
  BuildContext noting = context;
  noting.field = [&](const json::Node& where, const std::string& name) -> Result<field::AnyField> {
    CATENA_TRY(field::AnyField field, context.field(where, name));
    recipe.add(field.get()->version());
    return field;
  };
  noting.mesh = [&](const json::Node& where, const std::string& name) -> Result<mesh::MeshPtr> {
    CATENA_TRY(mesh::MeshPtr mesh, context.mesh(where, name));
    recipe.add(mesh->version());
    return mesh;
  };
  link.name = from.find("name")->string;
  CATENA_TRY(link.stiffness_n_per_m, get_parameter(from, "stiffness", coupling.stiffness_n_per_m, json::Range::not_negative, noting));
  CATENA_TRY(link.on, read_switch(from));
  CATENA_TRY(const bool enabled, json::get_boolean(from, "enabled", true));
  link.on.never = !enabled;
  CATENA_TRY(link.indication, read_indication(from));
  if (const json::Node* side = from.find("free")) link.one_sided = side->string != "none";
  if (coupling.method == CouplingMethod::chain) {
    CATENA_TRY(link.constraint, build_constraint(from, noting));
  } else {
    CATENA_TRY(const json::Node node, node_for_baseline(from, coupling.method, link));
    CATENA_TRY(link.constraint, build_constraint(node, noting));
    if (!link.constraint->has_primitive())
      return json::error_at(*from.find("type"), "a \"" + from.find("type")->string +
                                                    "\" link has no linear primitive, which the coupling's \"method\" needs; a chain "
                                                    "(\"method\": \"chain\") was expected");
  }
  CATENA_TRY(link.align, read_align(from, coupling, *link.constraint));
  link.recipe = recipe.value;
  return link;
}

}  // namespace catena::haptics
