// SPDX-License-Identifier: MIT
/// The ball of servo_fixture.h as a scene's isosurface, with the real haptic stack.
#pragma once
#include "haptics/build/build_program.h"
#include "tests/haptics/device/usbfs/servo_fixture.h"

namespace catena::haptics::tests {

inline std::shared_ptr<const HapticProgram> ball_program() {
  auto scene = scene::parse_scene(R"({
    "fields": {"ball": {"analytic": "sphere"}},
    "chain": [{"name": "surface", "type": "isosurface", "field": "ball", "level": 0.5, "free": "above"}],
    "coupling": {"stiffness": 400, "damping": 0, "max_force": 8},
    "workspace": {"metres_per_unit": 0.04, "origin": [0, 0, -3]} })",
                                  "ball.json");
  if (!scene) {
    ADD_FAILURE() << scene.error().message;
    return nullptr;
  }
  auto program = build_program(*scene);
  if (!program) ADD_FAILURE() << program.error().message;
  return program ? *program : nullptr;
}

}  // namespace catena::haptics::tests
