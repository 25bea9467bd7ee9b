// SPDX-License-Identifier: MIT
/// Reads the haptic sections "chain", "modes", "coupling", "workspace", "device".
#include "engine/base/haptic_state.h"
#include "engine/base/text.h"
#include "engine/scene/readers.h"

namespace catena::scene {
namespace {

constexpr auto kMaxLinkCount = static_cast<std::size_t>(kMaxSceneLinks);

/// Checks the names and types of the links, and the names of their fields. The constraint of a link's type checks the other keys when the
/// haptic program is built.
Outcome read_chain(Scene& scene, const json::Node& node) {
  if (node.kind != json::Kind::array) return json::error_at(node, "\"chain\" is not an array; an array of links was expected");
  for (std::size_t i = 0; i < node.items.size(); ++i) {
    const json::Node& item = node.items[i];
    if (i >= kMaxLinkCount)
      return json::error_at(item, "\"chain\" has " + std::to_string(node.items.size()) + " links; at most " +
                                      std::to_string(kMaxLinkCount) + " were expected");
    CATENA_CHECK(json::expect_object(item, item.label));
    CATENA_TRY(const std::string name, json::require_string(item, "name"));
    const json::Node& name_node = *item.find("name");
    CATENA_CHECK(check_name("link", name, name_node));
    if (name == "t" || name == "probe" || name == "force")
      return json::error_at(name_node,
                            "link name " + in_quotes(name) + " is taken by the tick CSV; another name than t, probe, force was expected");
    bool repeated = false;
    scene.entities.each<Link>([&](Entity, const Link& other) { repeated = repeated || other.name == name; });
    if (repeated) return json::error_at(name_node, "duplicate link name " + in_quotes(name) + "; unique names were expected");
    CATENA_TRY(const std::string type, json::require_string(item, "type"));
    if (const json::Node* field = item.find("field"); field != nullptr) CATENA_CHECK(read_field_name(scene, item));
    scene.entities.emplace<Link>(scene.entities.create(), {name, type, item});
  }
  return Done{};
}

Keys modes_keys() {
  return {schema::identifier("name", "Unique name of the mode, shown by `--details`.").required(),
          schema::texts("links", "Names of the links that run in this mode, in order.").required(),
          schema::object("active_when", {}, "Switch of the mode, with the keys of a link's `active_when`.").required()};
}

/// Reads the modes. Whether their links exist is checked when the haptic program is built, because a link may stand for several.
Outcome read_modes(Scene& scene, const json::Node& node) {
  if (node.kind != json::Kind::array) return json::error_at(node, "\"modes\" is not an array; an array of modes was expected");
  for (const json::Node& item : node.items) {
    CATENA_CHECK(json::expect_object(item, item.label));
    CATENA_CHECK(json::check_known_keys(item, schema::key_names(modes_keys())));
    CATENA_TRY(const std::string name, json::require_string(item, "name"));
    CATENA_CHECK(check_name("mode", name, *item.find("name")));
    bool repeated = false;
    scene.entities.each<Mode>([&](Entity, const Mode& other) { repeated = repeated || other.name == name; });
    if (repeated) return json::error_at(*item.find("name"), "duplicate mode name " + in_quotes(name) + "; unique names were expected");
    const json::Node* links = item.find("links");
    if (links == nullptr || links->kind != json::Kind::array)
      return json::error_at(links ? *links : item, "a mode needs \"links\": an array of link names, in the order in which they run");
    if (item.find("active_when") == nullptr)
      return json::error_at(item, "a mode needs \"active_when\": {\"button\": n} or {\"force_above\": N}");
    Mode mode{name, {}, item};
    for (const json::Node& link : links->items) {
      CATENA_TRY(std::string link_name, json::as_string(link, "links"));
      mode.links.push_back(std::move(link_name));
    }
    scene.entities.emplace<Mode>(scene.entities.create(), std::move(mode));
  }
  return Done{};
}

const Table<Coupling>& coupling_table() {
  static const auto table = [] {
    Table<Coupling> t;
    t.bind(schema::number("stiffness", "N/m", "Stiffness of links that do not specify one.").non_negative(), &Coupling::stiffness_n_per_m);
    t.bind(schema::number("damping", "N s/m", "Damping of the probe's velocity.").non_negative(), &Coupling::damping_ns_per_m);
    t.bind(schema::number("max_force", "N", "Maximum magnitude of the force; a limited force keeps its direction.").non_negative(),
           &Coupling::max_force_n);
    t.bind(schema::number("rotational_stiffness", "N m/rad", "Rotational stiffness of links with `align` that do not specify one.")
               .non_negative(),
           &Coupling::rotational_stiffness_nm_per_rad);
    t.bind(schema::number("rotational_damping", "N m s/rad", "Damping of the tool's angular velocity.").non_negative(),
           &Coupling::rotational_damping_nms_per_rad);
    t.bind(schema::number("ramp_s", "s", "Time over which a step of the force by `max_force` is spread, whatever causes the step.")
               .non_negative()
               .with_default("0 in `replay`, 0.02 with a device"),
           &Coupling::ramp_s);
    t.bind(schema::choice("method", {"chain", "pipe", "balance", "closest", "linear"},
                          "Method: `chain` with one proxy per link, or a baseline method with a single proxy."),
           &Coupling::method);
    t.bind(schema::choice("force", {"paper", "conservative"},
                          "Force law of `chain`: the paper's sum of the links' forces, or a force by virtual work, from which slow motion "
                          "in a closed loop gains no energy."),
           &Coupling::force);
    t.custom(schema::number("max_proxy_error", "world",
                            "Maximum distance of a streamline link's proxy from the streamline; links that do not specify their "
                            "settings use the fastest ones within it.")
                 .positive()
                 .with_default("none"),
             [](Scene& scene, const json::Node& node, Coupling&) -> Outcome {
               CATENA_TRY(scene.tuning.max_proxy_error, json::get_optional_number(node, "max_proxy_error", json::NumberRange::positive));
               return Done{};
             });
    t.custom(
        schema::number("max_tick_us", "us",
                       "Maximum time of a tick; streamline links that do not specify their settings use the most accurate ones within it.")
            .positive()
            .with_default("none"),
        [](Scene& scene, const json::Node& node, Coupling&) -> Outcome {
          CATENA_TRY(scene.tuning.max_tick_us, json::get_optional_number(node, "max_tick_us", json::NumberRange::positive));
          if (!scene.tuning.max_proxy_error || !scene.tuning.max_tick_us) return Done{};
          return json::error_at(*node.find("max_tick_us"),
                                "\"max_proxy_error\" and \"max_tick_us\" exclude each other; one of them was expected");
        });
    t.check([](Scene&, const json::Node& node, Coupling& coupling) -> Outcome {
      if (coupling.force == CouplingForce::conservative && coupling.method != CouplingMethod::chain)
        return json::error_at(*node.find("force"), "a \"conservative\" force needs a chain; \"method\": \"chain\" was expected");
      return Done{};
    });
    return t;
  }();
  return table;
}

const Table<Workspace>& workspace_table() {
  static const auto table = [] {
    Table<Workspace> t;
    t.bind(schema::number("metres_per_unit", "m", "Workspace metres per world unit.")
               .positive()
               .with_default("1 in `replay`; fitted to the device in `view` and `feel`"),
           &Workspace::meters_per_unit);
    t.bind(schema::vec3("origin", "world", "World position of the centre of the device's workspace."), &Workspace::origin);
    t.bind(schema::rotation(
               "rotation",
               "Rotation from workspace axes to world axes: three rows of three numbers, nine numbers, or `{\"axis\", \"angle_deg\"}`.")
               .with_default("none"),
           &Workspace::rotation);
    t.check([](Scene&, const json::Node& node, Workspace& workspace) -> Outcome {
      workspace.is_explicit = node.find("metres_per_unit") != nullptr;
      return Done{};
    });
    return t;
  }();
  return table;
}

using schema::Section;

}  // namespace

Part chain_part() {
  return {{"chain", "Links of the haptic chain, in order.", Section::Layout::list, {}, static_cast<int>(kMaxLinkCount)}, read_chain};
}

Part modes_part() {
  return {
      {"modes", "Modes, at most eight. While the switch of a mode is on, only its links run, in its order; the first such mode applies.",
       Section::Layout::list, modes_keys(), 8},
      read_modes};
}

Part coupling_part() {
  return {{"coupling", "Parameters of the force: stiffness, damping, limits and the force law.", Section::Layout::object,
           coupling_table().keys()},
          [](Scene& scene, const json::Node& node) -> Outcome {
            CATENA_CHECK(json::expect_object(node, "coupling"));
            return coupling_table().read(scene, node, scene.coupling);
          }};
}

Part workspace_part() {
  return {{"workspace", "Mapping from the device's workspace, in metres, to the world.", Section::Layout::object, workspace_table().keys()},
          [](Scene& scene, const json::Node& node) -> Outcome {
            CATENA_CHECK(json::expect_object(node, "workspace"));
            return workspace_table().read(scene, node, scene.workspace);
          }};
}

/// The "device" section. Its keys are read by haptics/device, which defines the device types; one key names a file.
Part device_part() {
  return {{"device", "Haptic device.", Section::Layout::object, {}}, [](Scene& scene, const json::Node& node) -> Outcome {
            CATENA_CHECK(json::expect_object(node, "device"));
            scene.device = node;
            return Done{};
          }};
}

}  // namespace catena::scene
