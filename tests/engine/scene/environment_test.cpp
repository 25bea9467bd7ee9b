// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include "engine/scene/scene.h"

namespace catena::scene {
namespace environment_test {

Result<Scene> parse(const std::string& rest) { return parse_scene("{\"fields\": {},\n" + rest + "}", "s.json"); }

TEST(SceneEnvironment, AidsAreBooleansOrObjects) {
  const auto scene = parse(R"("bounding_box": true, "axes": {"ticks": 3, "names": ["u", "v", "w"]}, "ground": {"height": -2, "tile": 0.5},
    "fog": {"color": [0, 0, 1], "near": 2, "far": 9}, "lights": [{"direction": [1, 0, 0], "intensity": 0.5, "fixed_to": "camera"}])");
  ASSERT_TRUE(scene) << scene.error().message;
  EXPECT_TRUE(scene->bounding_box.has_value());
  EXPECT_EQ(scene->axes->names[2], "w");
  EXPECT_EQ(scene->ground->z, -2.0);
  EXPECT_EQ(scene->fog->far, 9.0);
  ASSERT_EQ(scene->lights.size(), 1u);
  EXPECT_TRUE(scene->lights[0].follows_camera);
  const auto none = parse(R"("bounding_box": false, "axes": false, "ground": false, "fog": false, "lights": [])");
  ASSERT_TRUE(none);
  EXPECT_FALSE(none->bounding_box || none->axes || none->ground || none->fog);
}

TEST(SceneEnvironment, ErrorsNameTheLine) {
  for (const auto& [text, expected] : {std::pair{R"("bounding_box": 1)", "neither true, false nor an object"},
                                       {R"("bounding_box": {"field": "f"})", "unknown field \"f\""},
                                       {R"("axes": {"names": ["a"]})", "three names"},
                                       {R"("axes": {"ticks": 1})", "ticks"},
                                       {R"("ground": {"tile": 0})", "tile"},
                                       {R"("ground": {"size": 10, "tile": 0.001})", "at most 1000 tiles"},
                                       {R"("fog": {"near": 5, "far": 5})", "greater view depth"},
                                       {R"("fog": {"max_opacity": 1.5})", "from 0 to 1 was expected"},
                                       {R"("lights": [{"direction": [0, 0, 0]}])", "a vector other than"},
                                       {R"("lights": [{}])", "direction"},
                                       {R"("lights": [{"direction": [1, 0, 0], "fixed_to": "moon"}])", "fixed_to"}}) {
    const auto scene = parse(text);
    ASSERT_FALSE(scene) << text;
    EXPECT_NE(scene.error().message.find(expected), std::string::npos) << scene.error().message;
    EXPECT_EQ(scene.error().message.find("s.json:2"), 0u) << scene.error().message;
  }
  std::string five = R"("lights": [)";
  for (int i = 0; i < 5; ++i) five += std::string(i ? "," : "") + R"({"direction": [1, 0, 0]})";
  const auto scene = parse(five + "]");
  ASSERT_FALSE(scene);
  EXPECT_NE(scene.error().message.find("more than 4 lights"), std::string::npos);
}

}  // namespace environment_test
}  // namespace catena::scene
