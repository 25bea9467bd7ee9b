// SPDX-License-Identifier: MIT
/// Scenes from text, their programs, and the errors of both. An unexpected error ends the case.
#pragma once
#include <gtest/gtest.h>

#include "haptics/build/build_program.h"
#include "tests/haptics/chain/chain_driver.h"
#include "tests/support/support.h"

namespace catena::haptics::build_tests {

inline scene::Scene scene_of(const std::string& text, const std::string& path = "scene.json") {
  auto scene = scene::parse_scene(text, path);
  if (!scene) throw std::runtime_error(scene.error().message);
  return std::move(*scene);
}

inline std::shared_ptr<const HapticProgram> program_of(scene::Scene& scene) {
  const auto program = build_program(scene);
  if (!program) throw std::runtime_error(program.error().message);
  return *program;
}
inline std::shared_ptr<const HapticProgram> program_of(const std::string& text) {
  scene::Scene scene = scene_of(text);
  return program_of(scene);
}

/// The message is one line that has the place and these parts.
inline void expect_message(const Error& error, int line, std::initializer_list<const char*> parts) {
  EXPECT_TRUE(error.message.starts_with("scene.json:" + std::to_string(line) + ": ")) << error.message;
  EXPECT_EQ(error.message.find('\n'), std::string::npos) << error.message;
  for (const char* part : parts) EXPECT_NE(error.message.find(part), std::string::npos) << error.message << "\nlacks " << part;
}
inline void expect_error(const std::string& text, int line, std::initializer_list<const char*> parts) {
  scene::Scene scene = scene_of(text);
  const auto program = build_program(scene);
  ASSERT_FALSE(program) << text;
  expect_message(program.error(), line, parts);
}

}  // namespace catena::haptics::build_tests
