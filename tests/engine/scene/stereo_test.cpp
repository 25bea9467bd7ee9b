// SPDX-License-Identifier: MIT
#include "engine/scene/stereo.h"

#include <gtest/gtest.h>

#include "engine/scene/scene.h"

namespace catena::scene {
namespace stereo_test {

std::string error_of(const std::string& text) {
  const auto scene = parse_scene(text, "scene.json");
  return scene ? std::string("no error") : scene.error().message;
}

TEST(Stereo, EveryModeIsRead) {
  for (int i = 0; i < kStereoModeCount; ++i) {
    const auto mode = static_cast<StereoMode>(i);
    EXPECT_EQ(parse_stereo_mode(to_string(mode)), mode);
    const auto scene = parse_scene("{\"stereo\": {\"mode\": \"" + std::string(to_string(mode)) + "\"}}", "scene.json");
    ASSERT_TRUE(scene) << scene.error().message;
    EXPECT_EQ(scene->stereo.mode, mode);
    EXPECT_NE(stereo_mode_names().find(to_string(mode)), std::string::npos);
  }
  EXPECT_FALSE(parse_stereo_mode("both"));
}

TEST(Stereo, ReadsKeysAndDefaults) {
  const auto plain = parse_scene("{}", "scene.json");
  ASSERT_TRUE(plain);
  EXPECT_EQ(plain->stereo.mode, StereoMode::mono);
  EXPECT_FALSE(plain->stereo.separation || plain->stereo.zero_parallax || plain->stereo.swap_eyes);
  const auto scene = parse_scene(
      R"({"stereo": {"mode": "side-by-side", "separation": 0.25, "zero_parallax": 4, "views": 5, "swap_eyes": true}})", "scene.json");
  ASSERT_TRUE(scene) << scene.error().message;
  EXPECT_EQ(scene->stereo.separation, 0.25);
  EXPECT_EQ(scene->stereo.zero_parallax, 4);
  EXPECT_EQ(scene->stereo.view_count, 5);
  EXPECT_TRUE(scene->stereo.swap_eyes);
}

TEST(Stereo, ErrorsNameTheLine) {
  const auto expect = [](const std::string& stereo, const char* part) {
    const std::string message = error_of("{\n\"stereo\": " + stereo + "}");
    EXPECT_TRUE(message.starts_with("scene.json:2: ")) << message;
    EXPECT_NE(message.find(part), std::string::npos) << message;
    EXPECT_EQ(message.find('\n'), std::string::npos) << message;
  };
  expect(R"("anaglyph")", "stereo");
  expect(R"({"mode": "both"})", "mono, left, right, side-by-side");
  expect(R"({"mode": 3})", "mode");
  expect(R"({"separation": -1})", "separation");
  expect(R"({"zero_parallax": 0})", "zero_parallax");
  expect(R"({"views": 1})", "views");
  expect(R"({"mode": "anaglyph", "views": 3})", "2 was expected");
  expect(R"({"swap_eyes": 1})", "swap");
  expect(R"({"eyes": 2})", "eyes");
}

}  // namespace stereo_test
}  // namespace catena::scene
