#include "haptics/extract/extract.h"

#include <atomic>
#include <string>

#include "haptics/constraints/registry.h"

namespace catena::haptics {
namespace {

std::atomic<std::uint64_t> newest_epoch{0};

Result<Switch> read_switch(const json::Node& link) {
  Switch on;
  const json::Node* node = link.find("on");
  if (node == nullptr) return on;
  CATENA_CHECK(json::expect_object(*node, "on"));
  CATENA_CHECK(json::only_keys(*node, {"button", "force_above"}));
  const bool button = node->find("button") != nullptr, force = node->find("force_above") != nullptr;
  if (button == force)
    return json::error_at(*node, std::string("\"on\" has ") + (button ? "both" : "neither") +
                                     " \"button\" and \"force_above\"; exactly one of them was expected");
  CATENA_TRY(on.button, json::get_integer(*node, "button", 0, 1, 32));
  CATENA_TRY(on.force_above_n, json::get_number(*node, "force_above", 0, json::Range::positive));
  return on;
}

}  // namespace

Result<std::shared_ptr<const Program>> extract_program(scene::Scene& scene) {
  BuildContext context;
  context.field = [&scene](const json::Node& where, const std::string& name) { return scene::use_field(scene, name, where); };
  context.curve = [&scene](const json::Node& where, const std::string&, const flow::Flow& flow, const Vec3& seed) {
    return scene::use_curve(scene, flow, seed, where);
  };

  auto program = std::make_shared<Program>();
  program->coupling.stiffness_n_per_m = scene.coupling.stiffness_n_per_m;
  program->coupling.damping_ns_per_m = scene.coupling.damping_ns_per_m;
  program->coupling.max_force_n = scene.coupling.max_force_n;
  program->coupling.ramp_s = scene.coupling.ramp_s.value_or(0);
  program->metres_per_unit = scene.workspace.metres_per_unit;
  program->workspace_origin = scene.workspace.origin;
  program->workspace_rotation = scene.workspace.rotation;

  // links in the order of the scene
  std::vector<scene::Entity> entities;
  scene.world.each<scene::Link>([&](scene::Entity e, const scene::Link&) { entities.push_back(e); });
  for (const scene::Entity e : entities) {
    const scene::Link& from = scene.world.get<scene::Link>(e);
    if (program->links.size() >= static_cast<std::size_t>(kMaxLinks))
      return json::error_at(from.node, "the chain is too long; at most " + std::to_string(kMaxLinks) + " links were expected");
    Link link;
    link.name = from.name;
    CATENA_TRY(link.stiffness_n_per_m,
               json::get_number(from.node, "stiffness", program->coupling.stiffness_n_per_m, json::Range::not_negative));
    CATENA_TRY(link.on, read_switch(from.node));
    CATENA_TRY(link.constraint, build_constraint(from.node, context));
    program->links.push_back(std::move(link));
  }
  program->epoch = ++newest_epoch;
  return std::shared_ptr<const Program>(std::move(program));
}

}  // namespace catena::haptics
