// SPDX-License-Identifier: MIT
#include "tests/engine/scene/scene_fixture.h"

namespace catena::scene::environment_test {

Result<Scene> parse(const std::string& rest) { return parse_scene("{\"fields\": {},\n" + rest + "}", "s.json"); }

TEST(SceneEnvironment, AidsAreBooleansOrObjects) {
  const Scene scene = value_of(parse(R"("bounding_box": true, "axes": {"ticks": 3, "names": ["u", "v", "w"]},
    "ground": {"height": -2, "tile": 0.5}, "fog": {"color": [0, 0, 1], "near": 2, "far": 9},
    "lights": [{"direction": [1, 0, 0], "intensity": 0.5, "fixed_to": "camera"}])"));
  EXPECT_TRUE(scene.bounding_box.has_value());
  EXPECT_EQ(scene.axes->names[2], "w");
  EXPECT_EQ(scene.ground->z, -2.0);
  EXPECT_EQ(scene.fog->far, 9.0);
  ASSERT_EQ(scene.illumination.lights.size(), 1u);
  EXPECT_EQ(value_of(parse(R"("look": "plain")")).illumination.look, Look::plain);
  EXPECT_EQ(value_of(parse(R"("look": "lit")")).illumination.look, Look::lit);
  EXPECT_FALSE(parse(R"("look": "bright")"));
  EXPECT_TRUE(scene.illumination.lights[0].follows_camera);
  const Scene none = value_of(parse(R"("bounding_box": false, "axes": false, "ground": false, "fog": false, "lights": [])"));
  EXPECT_FALSE(none.bounding_box || none.axes || none.ground || none.fog);
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
                                       {R"("lights": [{"direction": [1, 0, 0], "fixed_to": "moon"}])", "fixed_to"}})
    expect_error(parse(text), "s.json:2", {expected});
  std::string five = R"("lights": [)";
  for (int i = 0; i < 5; ++i) five += std::string(i ? "," : "") + R"({"direction": [1, 0, 0]})";
  expect_error(parse(five + "]"), "s.json:2", {"more than 4 lights"});
}

}  // namespace catena::scene::environment_test
