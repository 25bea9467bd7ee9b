// SPDX-License-Identifier: MIT
/// A cutting plane in the hand's workspace (servo_fixture.h), with its default sizes for L = 4.
#pragma once
#include "haptics/build/build_program.h"
#include "tests/haptics/device/usbfs/servo_fixture.h"

namespace catena::haptics::tests {

inline std::shared_ptr<const HapticProgram> widget_scene_program() {
  auto scene = scene::parse_scene(R"({
    "fields": {},
    "widgets": [{"name": "cut", "type": "cutting_plane", "center": [0, 0, 0], "normal": [0, 0, 1]}],
    "coupling": {"stiffness": 200, "damping": 0, "max_force": 4},
    "workspace": {"metres_per_unit": 0.04, "origin": [0, 0, -3]} })",
                                  "cut.json");
  if (!scene) {
    ADD_FAILURE() << scene.error().message;
    return nullptr;
  }
  auto program = build_program(*scene);
  if (!program) ADD_FAILURE() << program.error().message;
  return program ? *program : nullptr;
}

}  // namespace catena::haptics::tests
