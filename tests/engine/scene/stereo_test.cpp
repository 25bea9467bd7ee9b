// SPDX-License-Identifier: MIT
#include "engine/scene/stereo.h"

#include "tests/engine/scene/scene_fixture.h"

namespace catena::scene::stereo_test {

TEST(Stereo, EveryModeIsRead) {
  for (int i = 0; i < kStereoModeCount; ++i) {
    const auto mode = static_cast<StereoMode>(i);
    EXPECT_EQ(parse_stereo_mode(to_string(mode)), mode);
    EXPECT_EQ(parsed("{\"stereo\": {\"mode\": \"" + std::string(to_string(mode)) + "\"}}").stereo.mode, mode);
    EXPECT_NE(stereo_mode_names().find(to_string(mode)), std::string::npos);
  }
  EXPECT_FALSE(parse_stereo_mode("both"));
}

TEST(Stereo, ReadsKeysAndDefaults) {
  const Stereo plain = parsed("{}").stereo;
  EXPECT_EQ(plain.mode, StereoMode::mono);
  EXPECT_FALSE(plain.separation || plain.zero_parallax || plain.swap_eyes);
  const Stereo stereo =
      parsed(R"({"stereo": {"mode": "side-by-side", "separation": 0.25, "zero_parallax": 4, "views": 5, "swap_eyes": true}})").stereo;
  EXPECT_EQ(std::tuple(stereo.separation, stereo.zero_parallax, stereo.view_count), std::tuple(0.25, 4, 5));
  EXPECT_TRUE(stereo.swap_eyes);
}

TEST(Stereo, ErrorsNameTheLine) {
  for (const auto& [stereo, part] : {std::pair{R"("anaglyph")", "stereo"},
                                     {R"({"mode": "both"})", "mono, left, right, side-by-side"},
                                     {R"({"mode": 3})", "mode"},
                                     {R"({"separation": -1})", "separation"},
                                     {R"({"zero_parallax": 0})", "zero_parallax"},
                                     {R"({"views": 1})", "views"},
                                     {R"({"mode": "anaglyph", "views": 3})", "2 was expected"},
                                     {R"({"swap_eyes": 1})", "swap"},
                                     {R"({"eyes": 2})", "eyes"}})
    expect_error(parse_scene("{\n\"stereo\": " + std::string(stereo) + "}", "s.json"), "s.json:2: ", {part});
}

}  // namespace catena::scene::stereo_test
