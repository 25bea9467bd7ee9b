/// A whole chain driven through the tick: from the text of a scene, or from constraints made by hand.
#pragma once
#include "haptics/chain/tick.h"
#include "haptics/extract/extract.h"
#include "tests/haptics/constraints/rig.h"

namespace catena::acceptance {

using haptics::ChainScratch;
using haptics::ChainState;
using haptics::Program;
using haptics::Status;

inline std::shared_ptr<const Program> program_of(const std::string& scene_text) {
  auto scene = scene::parse_scene(scene_text, "scene.json");
  if (!scene) {
    ADD_FAILURE() << scene.error().message;
    return nullptr;
  }
  auto program = haptics::extract_program(*scene);
  if (!program) {
    ADD_FAILURE() << program.error().message;
    return nullptr;
  }
  return *program;
}

inline std::shared_ptr<const Program> program_of(const std::vector<haptics::tests::ConstraintPtr>& constraints) {
  auto program = std::make_shared<Program>();
  for (std::size_t i = 0; i < constraints.size(); ++i) {
    haptics::Link link;
    link.name = std::string(1, static_cast<char>('a' + i));
    link.constraint = constraints[i];
    program->links.push_back(std::move(link));
  }
  return program;
}

struct ChainRig {
  explicit ChainRig(std::shared_ptr<const Program> p) : program(std::move(p)) {}
  /// The next tick, 1 ms after the last.
  const exchange::HapticState& to(const Vec3& probe, std::uint32_t buttons = 0) {
    return at(1e-3 * static_cast<double>(state.ticks), probe, buttons);
  }
  const exchange::HapticState& at(double t_s, const Vec3& probe, std::uint32_t buttons = 0) {
    haptics::tick(*program, {t_s, probe, buttons}, state, scratch, out);
    return out;
  }
  const Vec3& proxy(std::size_t link = 0) const { return state.links[link].proxy; }
  Status status(std::size_t link = 0) const { return state.links[link].status; }
  int evaluations(std::size_t link = 0) const { return state.links[link].evaluations; }

  std::shared_ptr<const Program> program;
  ChainState state;
  ChainScratch scratch;
  exchange::HapticState out;
};

}  // namespace catena::acceptance
