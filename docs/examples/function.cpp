// SPDX-License-Identifier: MIT
// A field that is a function: a wavy floor, felt exactly as its formula says. A scene names it as it names a file's.
#include <cmath>
#include <cstdio>

#include "engine/field/callable_field.h"
#include "engine/scene/scene.h"
#include "haptics/build/build_program.h"
#include "haptics/chain/tick.h"

using namespace catena;

// s(x, y, z) = z - sin(3 x) cos(3 y) / 4: the floor is its level 0
double floor_value(const Vec3& p, Vec3& gradient) {
  const double sx = std::sin(3 * p.x), cx = std::cos(3 * p.x), sy = std::sin(3 * p.y), cy = std::cos(3 * p.y);
  gradient = {-0.75 * cx * cy, 0.75 * sx * sy, 1};
  return p.z - 0.25 * sx * cy;
}

Outcome run() {
  scene::FieldOverride given;
  given.name = "floor";
  given.in_memory_field.scalar = field::make_callable_field("floor", {Vec3(-1.0), Vec3(1.0)}, floor_value);
  CATENA_TRY(scene::Scene scene,
             scene::parse_scene(R"({"chain": [{"name": "skin", "type": "isosurface", "field": "floor", "level": 0, "free": "above"}]})",
                                "function", {given}));
  CATENA_TRY(const std::shared_ptr<const haptics::HapticProgram> program, haptics::build_program(scene));

  // from above down to z = -0.2, where the floor is at 0.25
  haptics::ChainState state;
  haptics::ChainScratch scratch;
  HapticState out;
  for (int i = 0; i <= 1000; ++i) haptics::tick(*program, {i * 1e-3, Vec3(std::acos(-1.0) / 6, 0, 0.8 - 1e-3 * i)}, state, scratch, out);
  std::printf("%s: proxy %.4f %.4f %.4f\n", to_string(out.links[0].status), out.links[0].proxy.x, out.links[0].proxy.y,
              out.links[0].proxy.z);
  return Done{};
}

int main() {
  if (const Outcome done = run(); !done) return std::fprintf(stderr, "%s\n", done.error().message.c_str()), 2;
  return 0;
}
