// SPDX-License-Identifier: MIT
/// Scenes from their text, and their frame packets.
#pragma once
#include <gtest/gtest.h>

#include "render/extract/extract.h"

namespace catena::test {

inline scene::Scene scene_from(const std::string& text, const std::string& path = "s.json") {
  auto scene = scene::parse_scene(text, path);
  EXPECT_TRUE(scene) << scene.error().message;
  return std::move(*scene);
}

inline render::FramePacket packet_from(scene::Scene& scene, std::uint32_t width = 320, std::uint32_t height = 240) {
  auto packet = render::make_frame(scene, width, height);
  EXPECT_TRUE(packet) << packet.error().message;
  return std::move(*packet);
}

inline render::FramePacket packet_from(const std::string& text, const std::string& path = "s.json", std::uint32_t width = 320,
                                       std::uint32_t height = 240) {
  scene::Scene scene = scene_from(text, path);
  return packet_from(scene, width, height);
}

/// The error of a scene that can be read but not drawn.
inline std::string packet_error(const std::string& text, const std::string& path = "s.json") {
  scene::Scene scene = scene_from(text, path);
  const auto packet = render::make_frame(scene, 64, 48);
  EXPECT_FALSE(packet);
  return packet ? std::string() : packet.error().message;
}

}  // namespace catena::test
