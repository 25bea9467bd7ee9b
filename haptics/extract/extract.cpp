#include "haptics/extract/extract.h"

#include <algorithm>
#include <atomic>
#include <string>

#include "engine/base/hash.h"
#include "haptics/constraints/read_parameter.h"
#include "haptics/constraints/registry.h"

namespace catena::haptics {
namespace {

std::atomic<std::uint64_t> newest_epoch{0};

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
    return json::error_at(*other, button ? "\"force_below\" belongs to \"force_above\", not to \"button\""
                                         : "\"toggle\" belongs to \"button\", not to \"force_above\"");
  CATENA_TRY(on.button, json::get_integer(*node, "button", 0, 1, 32));
  CATENA_TRY(on.toggle, json::get_boolean(*node, "toggle", false));
  CATENA_TRY(on.force_above_n, json::get_number(*node, "force_above", 0, json::Range::positive));
  CATENA_TRY(on.force_below_n, json::get_number(*node, "force_below", on.force_above_n, json::Range::not_negative));
  if (on.force_below_n > on.force_above_n)
    return json::error_at(*node->find("force_below"), "\"force_below\" is above \"force_above\"; a number up to it was expected");
  return on;
}

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
  CATENA_TRY(out.amplitude_n, json::get_number(*node, "amplitude", out.amplitude_n, json::Range::not_negative));
  CATENA_TRY(out.frequency_hz, json::get_number(*node, "frequency", out.frequency_hz, json::Range::positive));
  CATENA_TRY(out.duration_s, json::get_number(*node, "duration", out.duration_s, json::Range::positive));
  return out;
}

/// What a link was built from: its text, and the versions of its fields and meshes.
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

Result<Link> make_link(const scene::Link& from, const Coupling& coupling, const BuildContext& context) {
  Link link;
  Fnv1a recipe;
  add_recipe(from.node, recipe);
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
  link.name = from.name;
  CATENA_TRY(link.stiffness_n_per_m, get_parameter(from.node, "stiffness", coupling.stiffness_n_per_m, json::Range::not_negative, noting));
  CATENA_TRY(link.on, read_switch(from.node));
  CATENA_TRY(link.indication, read_indication(from.node));
  CATENA_TRY(link.constraint, build_constraint(from.node, noting));
  link.recipe = recipe.value;
  return link;
}

Result<Mode> make_mode(const scene::Mode& from, const std::vector<Link>& links) {
  Mode mode{from.name, {}, {}};
  CATENA_TRY(mode.on, read_switch(from.node));
  const std::vector<json::Node>& items = from.node.find("links")->items;
  for (std::size_t k = 0; k < from.links.size(); ++k) {
    int found = -1;
    for (std::size_t i = 0; i < links.size(); ++i)
      if (links[i].name == from.links[k]) found = static_cast<int>(i);
    if (found < 0)
      return json::error_at(items[k], "mode \"" + from.name + "\" names \"" + from.links[k] + "\", which is no link of the chain");
    if (std::find(mode.links.begin(), mode.links.end(), found) != mode.links.end())
      return json::error_at(items[k], "mode \"" + from.name + "\" names \"" + from.links[k] + "\" twice");
    mode.links.push_back(found);
  }
  return mode;
}

}  // namespace

Result<std::shared_ptr<const Program>> extract_program(scene::Scene& scene) {
  BuildContext context;
  context.field = [&scene](const json::Node& where, const std::string& name) { return scene::use_field(scene, name, where); };
  context.curve = [&scene](const json::Node& where, const std::string&, const flow::Flow& flow, const Vec3& seed) {
    return scene::use_curve(scene, flow, seed, where);
  };
  context.mesh = [&scene](const json::Node& where, const std::string& name) { return scene::use_mesh(scene, name, where); };

  auto program = std::make_shared<Program>();
  program->coupling.stiffness_n_per_m = scene.coupling.stiffness_n_per_m;
  program->coupling.damping_ns_per_m = scene.coupling.damping_ns_per_m;
  program->coupling.max_force_n = scene.coupling.max_force_n;
  program->coupling.ramp_s = scene.coupling.ramp_s.value_or(0);
  program->metres_per_unit = scene.workspace.metres_per_unit;
  program->workspace_origin = scene.workspace.origin;
  program->workspace_rotation = scene.workspace.rotation;

  // links in the order of the scene, then the modes that order them
  std::vector<scene::Link> links;
  scene.world.each<scene::Link>([&](scene::Entity, const scene::Link& link) { links.push_back(link); });
  for (const scene::Link& from : links) {
    if (program->links.size() >= static_cast<std::size_t>(kMaxLinks))
      return json::error_at(from.node, "the chain is too long; at most " + std::to_string(kMaxLinks) + " links were expected");
    CATENA_TRY(Link link, make_link(from, program->coupling, context));
    program->links.push_back(std::move(link));
  }
  std::vector<scene::Mode> modes;
  scene.world.each<scene::Mode>([&](scene::Entity, const scene::Mode& mode) { modes.push_back(mode); });
  for (const scene::Mode& from : modes) {
    if (program->modes.size() >= static_cast<std::size_t>(kMaxModes))
      return json::error_at(from.node, "too many modes; at most " + std::to_string(kMaxModes) + " were expected");
    CATENA_TRY(Mode mode, make_mode(from, program->links));
    program->modes.push_back(std::move(mode));
  }
  program->epoch = ++newest_epoch;
  return std::shared_ptr<const Program>(std::move(program));
}

}  // namespace catena::haptics
