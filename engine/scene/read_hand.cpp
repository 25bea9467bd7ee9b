#include "engine/base/text.h"
#include "engine/exchange/haptic_state.h"
#include "engine/scene/read_parts.h"

namespace catena::scene {
namespace {

constexpr std::size_t kMostLinks = exchange::kMaxSceneLinks;

}  // namespace

/// Names, types and the field that a link names are checked here; its other keys by the constraint of its type, where the
/// program for the hand is made.
Outcome read_chain(Scene& scene, const json::Node& node) {
  if (node.kind != json::Kind::array) return json::error_at(node, "\"chain\" is no array; an array of links was expected");
  for (std::size_t i = 0; i < node.items.size(); ++i) {
    const json::Node& item = node.items[i];
    if (i >= kMostLinks)
      return json::error_at(
          item, "\"chain\" has " + std::to_string(node.items.size()) + " links; at most " + std::to_string(kMostLinks) + " were expected");
    CATENA_CHECK(json::expect_object(item, item.label));
    CATENA_TRY(const std::string name, json::require_string(item, "name"));
    const json::Node& name_node = *item.find("name");
    if (!is_name(name))
      return json::error_at(name_node, "link name " + in_quotes(name) + " is not allowed; a name like [a-z][a-z0-9_]* was expected");
    if (name == "t" || name == "probe" || name == "force")
      return json::error_at(name_node,
                            "link name " + in_quotes(name) + " is taken by the tick CSV; another name than t, probe, force was expected");
    bool twice = false;
    scene.world.each<Link>([&](Entity, const Link& other) { twice = twice || other.name == name; });
    if (twice) return json::error_at(name_node, "duplicate link name " + in_quotes(name) + "; unique names were expected");
    CATENA_TRY(const std::string type, json::require_string(item, "type"));
    if (const json::Node* field = item.find("field"); field != nullptr) CATENA_CHECK(read_field_name(scene, item));
    scene.world.emplace<Link>(scene.world.create(), {name, type, item});
  }
  return Done{};
}

/// Whether its links exist is checked where the program is made: a link may stand for several.
Outcome read_modes(Scene& scene, const json::Node& node) {
  if (node.kind != json::Kind::array) return json::error_at(node, "\"modes\" is no array; an array of modes was expected");
  for (const json::Node& item : node.items) {
    CATENA_CHECK(json::expect_object(item, item.label));
    CATENA_CHECK(json::only_keys(item, {"name", "links", "on"}));
    CATENA_TRY(const std::string name, json::require_string(item, "name"));
    if (!is_name(name))
      return json::error_at(*item.find("name"),
                            "mode name " + in_quotes(name) + " is not allowed; a name like [a-z][a-z0-9_]* was expected");
    bool twice = false;
    scene.world.each<Mode>([&](Entity, const Mode& other) { twice = twice || other.name == name; });
    if (twice) return json::error_at(*item.find("name"), "duplicate mode name " + in_quotes(name) + "; unique names were expected");
    const json::Node* links = item.find("links");
    if (links == nullptr || links->kind != json::Kind::array)
      return json::error_at(links ? *links : item, "a mode needs \"links\": an array of link names, in the order of the chain");
    if (item.find("on") == nullptr) return json::error_at(item, "a mode needs \"on\": {\"button\": n} or {\"force_above\": N}");
    Mode mode{name, {}, item};
    for (const json::Node& link : links->items) {
      CATENA_TRY(std::string link_name, json::as_string(link, "links"));
      mode.links.push_back(std::move(link_name));
    }
    scene.world.emplace<Mode>(scene.world.create(), std::move(mode));
  }
  return Done{};
}

Outcome read_coupling(Scene& scene, const json::Node& node) {
  CATENA_CHECK(json::expect_object(node, "coupling"));
  CATENA_CHECK(
      json::only_keys(node, {"stiffness", "damping", "max_force", "ramp_s", "rotational_stiffness", "rotational_damping", "method"}));
  Coupling& c = scene.coupling;
  CATENA_TRY(c.stiffness_n_per_m, json::get_number(node, "stiffness", c.stiffness_n_per_m, json::Range::not_negative));
  CATENA_TRY(c.damping_ns_per_m, json::get_number(node, "damping", c.damping_ns_per_m, json::Range::not_negative));
  CATENA_TRY(c.max_force_n, json::get_number(node, "max_force", c.max_force_n, json::Range::not_negative));
  CATENA_TRY(c.rotational_stiffness_nm_per_rad,
             json::get_number(node, "rotational_stiffness", c.rotational_stiffness_nm_per_rad, json::Range::not_negative));
  CATENA_TRY(c.rotational_damping_nms_per_rad,
             json::get_number(node, "rotational_damping", c.rotational_damping_nms_per_rad, json::Range::not_negative));
  CATENA_TRY(c.ramp_s, json::get_optional_number(node, "ramp_s", json::Range::not_negative));
  CATENA_TRY(const int method, json::get_choice(node, "method", 0, {"chain", "pipe", "balance", "closest", "linear"}));
  c.method = static_cast<CouplingMethod>(method);
  return Done{};
}

Outcome read_workspace(Scene& scene, const json::Node& node) {
  CATENA_CHECK(json::expect_object(node, "workspace"));
  CATENA_CHECK(json::only_keys(node, {"metres_per_unit", "origin", "rotation"}));
  Workspace& w = scene.workspace;
  CATENA_TRY(w.metres_per_unit, json::get_number(node, "metres_per_unit", w.metres_per_unit, json::Range::positive));
  w.given = node.find("metres_per_unit") != nullptr;
  CATENA_TRY(w.origin, json::get_vec3(node, "origin", w.origin));
  if (const json::Node* rotation = node.find("rotation")) {
    CATENA_TRY(w.rotation, json::as_rotation(*rotation, "rotation"));
  }
  return Done{};
}

/// Its keys are read by haptics/device, which knows the devices.
Outcome read_device(Scene& scene, const json::Node& node) {
  CATENA_CHECK(json::expect_object(node, "device"));
  scene.device = node;
  return Done{};
}

}  // namespace catena::scene
