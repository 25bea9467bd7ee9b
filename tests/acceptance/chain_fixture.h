// SPDX-License-Identifier: MIT
/// A whole chain driven in the tick, from a scene's text or from given constraints.
#pragma once
#include "engine/scene/to_json.h"
#include "haptics/build/build_program.h"
#include "haptics/chain/tick.h"
#include "tests/haptics/constraints/constraint_fixture.h"

namespace catena::acceptance {

using catena::LinkStatus;
using haptics::ChainScratch;
using haptics::ChainState;
using haptics::HapticProgram;

/// A streamline link of a field through a seed; `more`: further keys.
inline haptics::tests::ConstraintPtr streamline(field::VectorFieldPtr field, const Vec3& seed, const std::string& more = "") {
  haptics::tests::Fields fields;
  fields.named["v"].vector = std::move(field);
  return haptics::tests::build(R"({"name": "a", "type": "streamline", "field": "v", "seed": )" + scene::to_json(seed) + more + "}", fields);
}

inline std::shared_ptr<const HapticProgram> make_program(const std::string& scene_text) {
  auto scene = scene::parse_scene(scene_text, "scene.json");
  if (!scene) {
    ADD_FAILURE() << scene.error().message;
    return nullptr;
  }
  auto program = haptics::build_program(*scene);
  if (!program) {
    ADD_FAILURE() << program.error().message;
    return nullptr;
  }
  return *program;
}

inline std::shared_ptr<const HapticProgram> make_program(const std::vector<haptics::tests::ConstraintPtr>& constraints) {
  auto program = std::make_shared<HapticProgram>();
  for (std::size_t i = 0; i < constraints.size(); ++i) {
    haptics::Link link;
    link.name = std::string(1, static_cast<char>('a' + i));
    link.constraint = constraints[i];
    program->links.push_back(std::move(link));
  }
  return program;
}

struct ChainRig {
  explicit ChainRig(std::shared_ptr<const HapticProgram> p) : program(std::move(p)) {}
  /// Runs the next tick, 1 ms after the last.
  const HapticState& step_to(const Vec3& probe, std::uint32_t buttons = 0) {
    return step_at(1e-3 * static_cast<double>(state.ticks), probe, buttons);
  }
  const HapticState& step_at(double t_s, const Vec3& probe, std::uint32_t buttons = 0) {
    haptics::tick(*program, {t_s, probe, buttons}, state, scratch, out);
    return out;
  }
  const Vec3& proxy(std::size_t link = 0) const { return state.links[link].proxy; }
  LinkStatus status(std::size_t link = 0) const { return state.links[link].status; }
  int evaluations(std::size_t link = 0) const { return state.links[link].evaluations; }

  std::shared_ptr<const HapticProgram> program;
  ChainState state;
  ChainScratch scratch;
  HapticState out;
};

}  // namespace catena::acceptance
