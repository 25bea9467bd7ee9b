// SPDX-License-Identifier: MIT
#include "haptics/build/build_program.h"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <string>

#include "engine/base/hash.h"
#include "engine/base/numbers.h"
#include "engine/base/text.h"
#include "engine/field/bricks/paged_grid.h"
#include "engine/scene/labels.h"
#include "engine/scene/unsteady_lines.h"
#include "haptics/constraints/common/link_schema.h"
#include "haptics/constraints/presets/mode_presets.h"

namespace catena::haptics {

namespace {

/// Adds to the spec hash the recipe of a link: its text except "enabled" (switching a link off and on does not change it), and the versions
/// of its fields and meshes.
void add_recipe(const json::Node& node, Fnv1a& recipe) {
  recipe.add(static_cast<int>(node.kind));
  recipe.add(node.boolean);
  recipe.add(node.number);
  recipe.add_bytes(node.string.data(), node.string.size());
  for (const json::Node& item : node.items) add_recipe(item, recipe);
  for (const auto& [key, value] : node.members) {
    recipe.add_bytes(key.data(), key.size() + 1);
    add_recipe(value, recipe);
  }
}

/// Prepares a link's node for a baseline method. Baselines release by themselves (haptics/chain/baseline.h): "release" is moved from the
/// constraint's node to the link. The linear method uses only the field at the proxy, not a streamline.
Result<json::Node> node_for_baseline(const json::Node& from, CouplingMethod method, Link& link) {
  json::Node node = from;
  const ConstraintType* type = find_constraint_type(from.find("type")->string);
  if (type == nullptr) return node;
  const auto has = [&](std::string_view key) {
    return std::any_of(type->keys.begin(), type->keys.end(), [&](const schema::Key& k) { return k.name == key; });
  };
  if (const json::Node* snap = from.find("snap"))
    return json::error_at(*snap, "\"snap\" needs a separate proxy for the link; \"method\": \"chain\" was expected in \"coupling\"");
  if (const json::Node* release = from.find("release"); release != nullptr) {
    if (release->kind == json::Kind::object)
      return json::error_at(
          *release, "\"release\" depends on a field; a number was expected, because the \"method\" of \"coupling\" is not \"chain\"");
    CATENA_TRY(link.release, json::as_number(*release, "release", json::NumberRange::positive));
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

constexpr double kConservativeTolerance = 1e-10;  // fraction of L; for proxies whose derivative along the probe path enters the force

}  // namespace

Result<Link> build_link(const json::Node& from, const Coupling& coupling, const BuildContext& context) {
  Link link;
  Fnv1a recipe;
  json::Node own = from;
  std::erase_if(own.members, [](const auto& member) { return member.first == "enabled"; });
  add_recipe(own, recipe);
  if (coupling.method != CouplingMethod::chain) recipe.add(static_cast<int>(coupling.method));
  BuildContext noting = context;
  if (coupling.force == CouplingForce::conservative) noting.proxy_tolerance = kConservativeTolerance;
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
  if (context.pathline)
    noting.pathline = [&](const json::Node& where, const std::string& name, const PathlineSpec& spec) -> Result<flow::CurvePtr> {
      CATENA_TRY(flow::CurvePtr curve, context.pathline(where, name, spec));
      for (const flow::Knot& knot : {curve->knots().front(), curve->knots().back()})
        for (const double number : {knot.s, knot.p.x, knot.p.y, knot.p.z}) recipe.add(number);
      return curve;
    };
  noting.curves = [&](const json::Node& where, const std::string& name) -> Result<curves::CurveSetPtr> {
    CATENA_TRY(curves::CurveSetPtr set, context.curves(where, name));
    recipe.add(set->version);
    return set;
  };
  noting.points = [&](const json::Node& where, const std::string& name) -> Result<curves::PointSetPtr> {
    CATENA_TRY(curves::PointSetPtr set, context.points(where, name));
    recipe.add(set->version);
    return set;
  };
  link.name = from.find("name")->string;
  CATENA_TRY(link.stiffness_n_per_m, get_parameter(from, "stiffness", coupling.stiffness_n_per_m, json::NumberRange::non_negative, noting));
  CATENA_TRY(link.active_when, read_switch(from));
  CATENA_TRY(const bool enabled, json::get_boolean(from, "enabled", true));
  link.active_when.disabled = !enabled;
  CATENA_TRY(link.release_cue, read_release_cue(from));
  if (const json::Node* side = from.find("free")) link.one_sided = side->string != "none";
  if (coupling.method == CouplingMethod::chain) {
    CATENA_TRY(link.constraint, build_constraint(from, noting));
  } else {
    CATENA_TRY(const json::Node node, node_for_baseline(from, coupling.method, link));
    CATENA_TRY(link.constraint, build_constraint(node, noting));
    if (!link.constraint->has_primitive())
      return json::error_at(*from.find("type"), "a \"" + from.find("type")->string +
                                                    "\" link has no linear primitive, which the \"method\" of \"coupling\" needs; "
                                                    "\"method\": \"chain\" was expected");
  }
  CATENA_TRY(link.align, read_align(from, coupling, *link.constraint));
  link.spec_hash = recipe.value;
  return link;
}

namespace {

std::atomic<std::uint64_t> newest_epoch{0};

/// Names and the indices of the program's links that each name stands for. The links of a mode also have names of their own.
using LinksOf = std::vector<std::pair<std::string, std::vector<int>>>;

/// Adds a note if a mesh that has an outside is oriented the other way in places.
Outcome note_sides(scene::Scene& scene, const json::Node& name, const std::string& link) {
  CATENA_TRY(const mesh::MeshPtr mesh, scene::resolve_mesh(scene, name.string, name));
  if (mesh->misoriented_edges() == 0) return Done{};
  const std::string note = fmt::format(
      "link \"{}\": at {} edges of mesh \"{}\" the two faces have opposite orientations; at these edges the probe may pass through, or be "
      "held from inside",
      link, mesh->misoriented_edges(), name.string);
  if (std::find(scene.notes.begin(), scene.notes.end(), note) == scene.notes.end()) scene.notes.push_back(note);
  return Done{};
}

/// Adds the link, or the links of a preset mode.
Outcome add_links(scene::Scene& scene, const scene::Link& from, const BuildContext& context, HapticProgram& program, LinksOf& links_of) {
  CATENA_TRY(const json::Node item, resolve_widget_values(scene, from.node));
  CATENA_TRY(const std::vector<json::Node> nodes, expand_link(item));
  std::vector<int> indices;
  for (const json::Node& node : nodes) {
    if (program.links.size() >= static_cast<std::size_t>(kMaxSceneLinks))
      return json::error_at(from.node, "the chain has too many links; at most " + std::to_string(kMaxSceneLinks) + " were expected");
    CATENA_TRY(Link link, build_link(node, program.coupling, context));
    if (const json::Node* mesh = node.find("mesh"); mesh != nullptr && link.one_sided) CATENA_CHECK(note_sides(scene, *mesh, link.name));
    if (const json::Node* field = node.find("field"); field != nullptr && field->kind == json::Kind::string)
      link.feature_name = scene::surface_label_name(scene, field->string);
    for (const Link& other : program.links)
      if (other.name == link.name)
        return json::error_at(from.node, "duplicate link name \"" + link.name + "\" (the links of a preset mode are named " +
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
  std::vector<std::string_view> names;
  for (const auto& [name, links] : links_of) names.push_back(name);
  return (names.size() > 1 ? "one of " : "") + join_words(names);
}

Result<Mode> make_mode(const scene::Mode& from, const LinksOf& links_of) {
  Mode mode{from.name, {}, {}};
  CATENA_TRY(mode.active_when, read_switch(from.node));
  const std::vector<json::Node>& items = from.node.find("links")->items;
  for (std::size_t k = 0; k < from.links.size(); ++k) {
    const std::vector<int>* found = nullptr;
    for (const auto& [name, links] : links_of)
      if (name == from.links[k]) found = &links;
    if (found == nullptr)
      return json::error_at(items[k], "mode \"" + from.name + "\" names \"" + from.links[k] + "\", which is not a link of the chain; " +
                                          known_names(links_of) + " was expected");
    for (const int link : *found) {
      if (std::find(mode.links.begin(), mode.links.end(), link) != mode.links.end())
        return json::error_at(items[k],
                              "mode \"" + from.name + "\" names \"" + from.links[k] + "\" twice; one mention of each link was expected");
      mode.links.push_back(link);
    }
  }
  return mode;
}

}  // namespace

Result<std::shared_ptr<const HapticProgram>> build_program(scene::Scene& scene, const DeviceLimits& limits) {
  BuildContext context;
  std::vector<std::shared_ptr<const field::PagedGrid>> paged_grids;
  context.field = [&](const json::Node& where, const std::string& name) -> Result<field::AnyField> {
    CATENA_TRY(field::AnyField field, scene::resolve_field(scene, name, where));
    if (field.paged == nullptr) return field;
    if (std::ranges::find(paged_grids, field.paged) == paged_grids.end()) paged_grids.push_back(field.paged);
    field.scalar = field.paged;
    return field;
  };
  context.curve = [&scene](const json::Node& where, const std::string&, const flow::Flow& flow, const Vec3& seed) {
    return scene::resolve_streamline(scene, flow, seed, where);
  };
  context.pathline = [&scene](const json::Node& where, const std::string& name, const PathlineSpec& spec) {
    return scene::resolve_pathline(scene, name, spec.seed, {scene::LineKind::path, spec.times, spec.is_cubic_in_time}, where);
  };
  context.mesh = [&scene](const json::Node& where, const std::string& name) { return scene::resolve_mesh(scene, name, where); };

  context.points = [&scene](const json::Node& where, const std::string& name) { return scene::resolve_points(scene, name, where); };
  context.curves = [&scene](const json::Node& where, const std::string& name) { return scene::resolve_curves(scene, name, where); };

  auto program = std::make_shared<HapticProgram>();
  program->coupling.stiffness_n_per_m = scene.coupling.stiffness_n_per_m;
  program->coupling.damping_ns_per_m = scene.coupling.damping_ns_per_m;
  program->coupling.max_force_n = scene.coupling.max_force_n;
  program->coupling.rotational_stiffness_nm_per_rad = scene.coupling.rotational_stiffness_nm_per_rad;
  program->coupling.rotational_damping_nms_per_rad = scene.coupling.rotational_damping_nms_per_rad;
  program->coupling.ramp_s = scene.coupling.ramp_s.value_or(0);
  program->coupling.method = scene.coupling.method;
  program->coupling.force = scene.coupling.force;
  program->limits = limits;
  program->meters_per_unit = scene.workspace.meters_per_unit;
  program->workspace_origin = scene.workspace.origin;
  program->workspace_rotation = scene.workspace.rotation;

  // the links in the order of the scene, then the modes, which set other orders
  std::vector<scene::Link> links;
  scene.entities.each<scene::Link>([&](scene::Entity, const scene::Link& link) { links.push_back(link); });
  LinksOf links_of;
  for (const scene::Link& from : links) CATENA_CHECK(add_links(scene, from, context, *program, links_of));
  std::vector<scene::Mode> modes;
  scene.entities.each<scene::Mode>([&](scene::Entity, const scene::Mode& mode) { modes.push_back(mode); });
  for (const scene::Mode& from : modes) {
    if (program->modes.size() >= static_cast<std::size_t>(kMaxModes))
      return json::error_at(from.node, "the scene has too many modes; at most " + std::to_string(kMaxModes) + " were expected");
    CATENA_TRY(Mode mode, make_mode(from, links_of));
    program->modes.push_back(std::move(mode));
  }
  const auto named = [&](const std::string& name) -> const std::vector<int>* {
    for (const auto& [known, indices] : links_of)
      if (known == name) return &indices;
    return nullptr;
  };
  CATENA_CHECK(add_widgets(scene, named, *program));
  program->paged_grids = std::move(paged_grids);
  program->epoch = ++newest_epoch;
  return std::shared_ptr<const HapticProgram>(std::move(program));
}

}  // namespace catena::haptics
