// SPDX-License-Identifier: MIT
/// Reads the haptic sections "chain", "modes", "coupling", "workspace", "device".
#include "engine/base/haptic_state.h"
#include "engine/base/text.h"
#include "engine/scene/readers.h"

namespace catena::scene {
namespace {

constexpr auto kMaxLinkCount = static_cast<std::size_t>(kMaxSceneLinks);

/// Checks the names and types of the links and the fields that they name; the other keys are checked by the constraint of the link's type
/// when the haptic program is built.
Outcome read_chain(Scene& scene, const json::Node& node) {
  if (node.kind != json::Kind::array) return json::error_at(node, "\"chain\" is no array; an array of links was expected");
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
    bool twice = false;
    scene.entities.each<Link>([&](Entity, const Link& other) { twice = twice || other.name == name; });
    if (twice) return json::error_at(name_node, "duplicate link name " + in_quotes(name) + "; unique names were expected");
    CATENA_TRY(const std::string type, json::require_string(item, "type"));
    if (const json::Node* field = item.find("field"); field != nullptr) CATENA_CHECK(read_field_name(scene, item));
    scene.entities.emplace<Link>(scene.entities.create(), {name, type, item});
  }
  return Done{};
}

Keys modes_keys() {
  return {schema::identifier("name", "Shown in `--details`.").required(),
          schema::texts("links", "Links of the chain, in the order of this mode.").required(),
          schema::object("active_when", {}, "A switch, as of a link.").required()};
}

/// Reads the modes. Whether their links exist is checked when the haptic program is built, because a link may stand for several.
Outcome read_modes(Scene& scene, const json::Node& node) {
  if (node.kind != json::Kind::array) return json::error_at(node, "\"modes\" is no array; an array of modes was expected");
  for (const json::Node& item : node.items) {
    CATENA_CHECK(json::expect_object(item, item.label));
    CATENA_CHECK(json::check_known_keys(item, schema::key_names(modes_keys())));
    CATENA_TRY(const std::string name, json::require_string(item, "name"));
    CATENA_CHECK(check_name("mode", name, *item.find("name")));
    bool twice = false;
    scene.entities.each<Mode>([&](Entity, const Mode& other) { twice = twice || other.name == name; });
    if (twice) return json::error_at(*item.find("name"), "duplicate mode name " + in_quotes(name) + "; unique names were expected");
    const json::Node* links = item.find("links");
    if (links == nullptr || links->kind != json::Kind::array)
      return json::error_at(links ? *links : item, "a mode needs \"links\": an array of link names, in the order of the chain");
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
    t.bind(schema::number("stiffness", "N/m", "Of every link that states none.").non_negative(), &Coupling::stiffness_n_per_m);
    t.bind(schema::number("damping", "N s/m", "Against the hand's velocity.").non_negative(), &Coupling::damping_ns_per_m);
    t.bind(schema::number("max_force", "N", "Limit of the force; its direction is kept.").non_negative(), &Coupling::max_force_n);
    t.bind(schema::number("rotational_stiffness", "N m/rad", "Of every link that aligns and states none.").non_negative(),
           &Coupling::rotational_stiffness_nm_per_rad);
    t.bind(schema::number("rotational_damping", "N m s/rad", "Against the tool's turning.").non_negative(),
           &Coupling::rotational_damping_nms_per_rad);
    t.bind(schema::number("ramp_s", "s", "In so long a step of the force as large as `max_force` is let in or out, whatever makes it.")
               .non_negative()
               .with_default("0 in `replay`, 0.02 with a device"),
           &Coupling::ramp_s);
    t.bind(schema::choice("method", {"chain", "pipe", "balance", "closest", "linear"}, "`chain`, or a method before it."),
           &Coupling::method);
    t.bind(schema::choice("force", {"paper", "conservative"},
                          "Of the chain: the paper's sum of pulls, or by virtual work, which slow closed loops take no energy from."),
           &Coupling::force);
    t.custom(schema::number("max_proxy_error", "world",
                            "Greatest distance of a streamline link's proxy from its line; links without settings of their own get the "
                            "fastest ones that keep it.")
                 .positive()
                 .with_default("none"),
             [](Scene& scene, const json::Node& node, Coupling&) -> Outcome {
               CATENA_TRY(scene.tuning.max_proxy_error, json::get_optional_number(node, "max_proxy_error", json::NumberRange::positive));
               return Done{};
             });
    t.custom(schema::number("max_tick_us", "us", "Longest time of a tick; the same links get the most exact settings that keep it.")
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
        return json::error_at(*node.find("force"), "a \"conservative\" force is made of a chain; \"method\" \"chain\" was expected");
      return Done{};
    });
    return t;
  }();
  return table;
}

const Table<Workspace>& workspace_table() {
  static const auto table = [] {
    Table<Workspace> t;
    t.bind(schema::number("metres_per_unit", "m", "Metres of hand per world unit.")
               .positive()
               .with_default("1 in `replay`; fitted to the device in `view` and `feel`"),
           &Workspace::meters_per_unit);
    t.bind(schema::vec3("origin", "world", "Where the middle of the device's workspace lies."), &Workspace::origin);
    t.bind(schema::rotation("rotation", "World from hand: three rows of three numbers, nine numbers, or `{\"axis\", \"angle_deg\"}`.")
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
  return {{"chain", "What the hand feels: links, in their order.", Section::Layout::list, {}, static_cast<int>(kMaxLinkCount)}, read_chain};
}

Part modes_part() {
  return {{"modes", "While the switch of a mode is on, its links run in its order, and all others are off. At most eight.",
           Section::Layout::list, modes_keys(), 8},
          read_modes};
}

Part coupling_part() {
  return {{"coupling", "How the links make one force.", Section::Layout::object, coupling_table().keys()},
          [](Scene& scene, const json::Node& node) -> Outcome {
            CATENA_CHECK(json::expect_object(node, "coupling"));
            return coupling_table().read(scene, node, scene.coupling);
          }};
}

Part workspace_part() {
  return {{"workspace", "How the hand's metres lie in the world.", Section::Layout::object, workspace_table().keys()},
          [](Scene& scene, const json::Node& node) -> Outcome {
            CATENA_CHECK(json::expect_object(node, "workspace"));
            return workspace_table().read(scene, node, scene.workspace);
          }};
}

/// The "device" section. Its keys are read by haptics/device, which defines the device types; one key names a file.
Part device_part() {
  return {{"device", "What the hand holds.", Section::Layout::object, {}}, [](Scene& scene, const json::Node& node) -> Outcome {
            CATENA_CHECK(json::expect_object(node, "device"));
            scene.device = node;
            return Done{};
          }};
}

}  // namespace catena::scene
