#include "haptics/extract/extract.h"

#include <algorithm>
#include <atomic>
#include <string>

#include "haptics/constraints/presets/modes.h"
#include "haptics/constraints/rules/link_keys.h"
#include "haptics/extract/make_link.h"
#include "haptics/extract/widgets.h"

namespace catena::haptics {
namespace {

std::atomic<std::uint64_t> newest_epoch{0};

/// The links that a name stands for: indices into the program's. A mode's links have names of their own, too.
using LinksOf = std::vector<std::pair<std::string, std::vector<int>>>;

/// Adds the link, or the links of a ready-made mode.
Outcome add_links(scene::Scene& scene, const scene::Link& from, const BuildContext& context, Program& program, LinksOf& links_of) {
  CATENA_TRY(const json::Node item, with_widget_values(scene, from.node));
  CATENA_TRY(const std::vector<json::Node> nodes, expand_link(item));
  std::vector<int> indices;
  for (const json::Node& node : nodes) {
    if (program.links.size() >= static_cast<std::size_t>(exchange::kMaxSceneLinks))
      return json::error_at(from.node,
                            "the chain is too long; at most " + std::to_string(exchange::kMaxSceneLinks) + " links were expected");
    CATENA_TRY(Link link, make_link(node, program.coupling, context));
    for (const Link& other : program.links)
      if (other.name == link.name)
        return json::error_at(from.node, "duplicate link name \"" + link.name + "\" (a ready-made mode names its links " +
                                             "MODE_...); unique names were expected");
    indices.push_back(static_cast<int>(program.links.size()));
    if (nodes.size() > 1) links_of.push_back({link.name, {indices.back()}});
    program.links.push_back(std::move(link));
  }
  links_of.emplace_back(from.name, std::move(indices));
  return Done{};
}

std::string known_names(const LinksOf& links_of) {
  if (links_of.empty()) return "a chain with links";
  std::string out = links_of.size() > 1 ? "one of " : "";
  for (std::size_t i = 0; i < links_of.size(); ++i) out += (i > 0 ? ", " : "") + links_of[i].first;
  return out;
}

Result<Mode> make_mode(const scene::Mode& from, const LinksOf& links_of) {
  Mode mode{from.name, {}, {}};
  CATENA_TRY(mode.on, read_switch(from.node));
  const std::vector<json::Node>& items = from.node.find("links")->items;
  for (std::size_t k = 0; k < from.links.size(); ++k) {
    const std::vector<int>* found = nullptr;
    for (const auto& [name, links] : links_of)
      if (name == from.links[k]) found = &links;
    if (found == nullptr)
      return json::error_at(items[k], "mode \"" + from.name + "\" names \"" + from.links[k] + "\", which is no link of the chain; " +
                                          known_names(links_of) + " was expected");
    for (const int link : *found) {
      if (std::find(mode.links.begin(), mode.links.end(), link) != mode.links.end())
        return json::error_at(items[k], "mode \"" + from.name + "\" names \"" + from.links[k] + "\" twice; each link once was expected");
      mode.links.push_back(link);
    }
  }
  return mode;
}

}  // namespace

Result<std::shared_ptr<const Program>> extract_program(scene::Scene& scene, const Limits& limits) {
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
  program->coupling.rotational_stiffness_nm_per_rad = scene.coupling.rotational_stiffness_nm_per_rad;
  program->coupling.rotational_damping_nms_per_rad = scene.coupling.rotational_damping_nms_per_rad;
  program->coupling.ramp_s = scene.coupling.ramp_s.value_or(0);
  program->coupling.method = scene.coupling.method;
  program->limits = limits;
  program->metres_per_unit = scene.workspace.metres_per_unit;
  program->workspace_origin = scene.workspace.origin;
  program->workspace_rotation = scene.workspace.rotation;

  // links in the order of the scene, then the modes that order them
  std::vector<scene::Link> links;
  scene.world.each<scene::Link>([&](scene::Entity, const scene::Link& link) { links.push_back(link); });
  LinksOf links_of;
  for (const scene::Link& from : links) CATENA_CHECK(add_links(scene, from, context, *program, links_of));
  std::vector<scene::Mode> modes;
  scene.world.each<scene::Mode>([&](scene::Entity, const scene::Mode& mode) { modes.push_back(mode); });
  for (const scene::Mode& from : modes) {
    if (program->modes.size() >= static_cast<std::size_t>(kMaxModes))
      return json::error_at(from.node, "too many modes; at most " + std::to_string(kMaxModes) + " were expected");
    CATENA_TRY(Mode mode, make_mode(from, links_of));
    program->modes.push_back(std::move(mode));
  }
  const auto named = [&](const std::string& name) -> const std::vector<int>* {
    for (const auto& [known, indices] : links_of)
      if (known == name) return &indices;
    return nullptr;
  };
  CATENA_CHECK(add_widgets(scene, named, *program));
  program->epoch = ++newest_epoch;
  return std::shared_ptr<const Program>(std::move(program));
}

}  // namespace catena::haptics
