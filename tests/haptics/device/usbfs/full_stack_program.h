// SPDX-License-Identifier: MIT
/// Scenes for the hand's workspace of servo_fixture.h, with the real haptic stack.
#pragma once
#include "haptics/build/build_program.h"
#include "tests/haptics/device/usbfs/servo_fixture.h"
#include "tests/support/results.h"

namespace catena::haptics::tests {

inline std::shared_ptr<const HapticProgram> program_of_scene(const std::string& text) {
  auto scene = test::value_of(scene::parse_scene(text, "scene.json"));
  return test::value_of(build_program(scene));
}

/// The ball of servo_fixture.h as an isosurface.
inline std::shared_ptr<const HapticProgram> ball_program() {
  return program_of_scene(R"({
    "fields": {"ball": {"analytic": "sphere"}},
    "chain": [{"name": "surface", "type": "isosurface", "field": "ball", "level": 0.5, "free": "above"}],
    "coupling": {"stiffness": 400, "damping": 0, "max_force": 8},
    "workspace": {"metres_per_unit": 0.04, "origin": [0, 0, -3]} })");
}

/// A cutting plane with its default sizes for L = 4.
inline std::shared_ptr<const HapticProgram> widget_scene_program() {
  return program_of_scene(R"({
    "fields": {},
    "widgets": [{"name": "cut", "type": "cutting_plane", "center": [0, 0, 0], "normal": [0, 0, 1]}],
    "coupling": {"stiffness": 200, "damping": 0, "max_force": 4},
    "workspace": {"metres_per_unit": 0.04, "origin": [0, 0, -3]} })");
}

}  // namespace catena::haptics::tests
