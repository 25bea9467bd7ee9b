#include "haptics/extract/make_link.h"

#include <algorithm>
#include <string>

#include "engine/base/hash.h"
#include "engine/base/numbers.h"
#include "haptics/constraints/rules/read_parameter.h"

namespace catena::haptics {

Result<Switch> read_switch(const json::Node& holder) {
  Switch on;
  const json::Node* node = holder.find("on");
  if (node == nullptr) return on;
  CATENA_CHECK(json::expect_object(*node, "on"));
  CATENA_CHECK(json::only_keys(*node, {"button", "toggle", "force_above", "force_below"}));
  const bool button = node->find("button") != nullptr, force = node->find("force_above") != nullptr;
  if (button == force)
    return json::error_at(*node, std::string("\"on\" has ") + (button ? "both" : "neither") +
                                     " \"button\" and \"force_above\"; exactly one of them was expected");
  if (const json::Node* other = node->find(button ? "force_below" : "toggle"))
    return json::error_at(*other,
                          button ? "\"force_below\" belongs to \"force_above\", not to \"button\"; only \"toggle\" was expected beside it"
                                 : "\"toggle\" belongs to \"button\", not to \"force_above\"; only \"force_below\" was expected beside it");
  CATENA_TRY(on.button, json::get_integer(*node, "button", 0, 1, 32));
  CATENA_TRY(on.toggle, json::get_boolean(*node, "toggle", false));
  CATENA_TRY(on.force_above_n, json::get_number(*node, "force_above", 0, json::Range::positive));
  CATENA_TRY(on.force_below_n, json::get_number(*node, "force_below", on.force_above_n, json::Range::not_negative));
  if (on.force_below_n > on.force_above_n)
    return json::error_at(*node->find("force_below"), "\"force_below\" is above \"force_above\"; a number up to it was expected");
  return on;
}

namespace {

Result<Indication> read_indication(const json::Node& link) {
  Indication out;
  const json::Node* node = link.find("indicate");
  if (node == nullptr) return out;
  CATENA_CHECK(json::expect_object(*node, "indicate"));
  CATENA_CHECK(json::only_keys(*node, {"cue", "at", "from", "amplitude", "frequency", "duration"}));
  CATENA_TRY(const int cue, json::get_choice(*node, "cue", 0, {"none", "detent", "vibration"}));
  out.cue = static_cast<Indication::Cue>(cue);
  CATENA_TRY(out.at, json::get_number(*node, "at", out.at, json::Range::positive));
  CATENA_TRY(out.from, json::get_number(*node, "from", out.from, json::Range::not_negative));
  if (out.from > 1) return json::error_at(*node->find("from"), "\"from\" is " + to_text(out.from) + "; a number from 0 to 1 was expected");
  CATENA_TRY(out.amplitude_n, json::get_number(*node, "amplitude", out.amplitude_n, json::Range::not_negative));
  CATENA_TRY(out.frequency_hz, json::get_number(*node, "frequency", out.frequency_hz, json::Range::positive));
  CATENA_TRY(out.duration_s, json::get_number(*node, "duration", out.duration_s, json::Range::positive));
  return out;
}

/// The constraint is asked for an axis: a point has none, and friction and forces have no primitive at all.
Result<Align> read_align(const json::Node& link, const Coupling& coupling, const Constraint& constraint) {
  Align out;
  const json::Node* node = link.find("align");
  if (node == nullptr) return out;
  CATENA_CHECK(json::expect_object(*node, "align"));
  CATENA_CHECK(json::only_keys(*node, {"axis", "stiffness", "sign"}));
  const std::string& type = link.find("type")->string;
  if (!constraint.has_primitive() || type == "point")
    return json::error_at(
        *node, "a \"" + type + "\" link has no axis to align with; a surface (its normal) or a curve (its tangent) was expected");
  if (coupling.combination != Combination::chain)
    return json::error_at(*node, "\"align\" needs a proxy of the link's own; \"method\": \"chain\" was expected in \"coupling\"");
  out.on = true;
  CATENA_TRY(const Vec3 axis, json::get_vec3(*node, "axis", out.tool_axis));
  out.tool_axis = direction(axis);
  if (!(max_abs(out.tool_axis) > 0))
    return json::error_at(*node->find("axis"), "\"axis\" is zero; a vector of the tool's frame, of non-zero length, was expected");
  CATENA_TRY(out.stiffness_nm_per_rad,
             json::get_number(*node, "stiffness", coupling.rotational_stiffness_nm_per_rad, json::Range::not_negative));
  CATENA_TRY(const int sign, json::get_choice(*node, "sign", 0, {"either", "same"}));
  out.sign = static_cast<Align::Sign>(sign);
  return out;
}

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
Result<json::Node> node_for_baseline(const json::Node& from, Combination combination, Link& link) {
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
  if (const json::Node* side = from.find("free"); side != nullptr && has("free")) link.one_sided = side->string != "none";
  if (combination == Combination::linear && has("follow") && node.find("follow") == nullptr && node.find("method") == nullptr) {
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
  if (coupling.combination != Combination::chain) recipe.add(static_cast<int>(coupling.combination));
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
  if (coupling.combination == Combination::chain) {
    CATENA_TRY(link.constraint, build_constraint(from, noting));
  } else {
    CATENA_TRY(const json::Node node, node_for_baseline(from, coupling.combination, link));
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
