// SPDX-License-Identifier: MIT
// A constraint of one's own in one file: a ball whose radius is the level of a scalar field. The scene names it like any other; the reader
// checks its keys, and a misspelt one is answered with what was meant.
#include <cstdio>

#include "engine/scene/scene.h"
#include "haptics/build/build_program.h"
#include "haptics/chain/tick.h"
#include "haptics/constraints/registry.h"

using namespace catena;
using namespace catena::haptics;

// The specification, made once, off the tick. A tick may not allocate, lock or throw.
class Ball final : public Constraint {
 public:
  explicit Ball(double radius) : radius_(radius) {}
  void start(const Vec3& probe, LinkState& state, LinkScratch& scratch) const noexcept override { advance(probe, state, scratch); }
  void advance(const Vec3& probe, LinkState& state, LinkScratch&) const noexcept override {
    const Vec3 away = direction(probe);
    if (!(max_abs(away) > 0)) return;  // at the centre every direction is as good: the proxy stays
    state.proxy = radius_ * away;
    state.status = LinkStatus::ok;
  }

 private:
  double radius_;
};

ConstraintType ball_type() {
  ConstraintType type;
  type.type = "ball";
  type.help = "Holds the proxy on a ball.";
  type.keys = {schema::number("radius", "world", "The ball's radius.").positive().required()};
  type.build = [](const json::Node& link, const BuildContext&) -> Result<std::shared_ptr<const Constraint>> {
    CATENA_TRY(const double radius, json::require_number(link, "radius", json::NumberRange::positive));
    return std::shared_ptr<const Constraint>(std::make_shared<Ball>(radius));
  };
  return type;
}

Outcome run() {
  register_constraint(ball_type());
  CATENA_TRY(scene::Scene scene, scene::parse_scene(R"({"chain": [{"name": "skin", "type": "ball", "radius": 0.5}],
    "workspace": {"metres_per_unit": 0.05}})",
                                                    "constraint.json"));
  CATENA_TRY(const std::shared_ptr<const HapticProgram> program, build_program(scene));

  ChainState state;
  ChainScratch scratch;
  HapticState out;
  for (int i = 0; i <= 1000; ++i) tick(*program, {i * 1e-3, Vec3(1 - 0.8e-3 * i, 0, 0)}, state, scratch, out);
  std::printf("probe at %.3f, proxy at %.3f, force %.3f N\n", out.probe.x, out.links[0].proxy.x, out.force_n.x);
  return Done{};
}

int main() {
  if (const Outcome done = run(); !done) return std::fprintf(stderr, "%s\n", done.error().message.c_str()), 2;
  return 0;
}
