// SPDX-License-Identifier: MIT
#include "tests/engine/scene/scene_fixture.h"

namespace catena::scene::clip_test {

Result<Scene> parse(const std::string& clip) { return parse_scene("{\"fields\": {},\n\"clip\": " + clip + "}", "s.json"); }

TEST(SceneClip, PlanesAndBoxesBecomePlanes) {
  const auto scene = parse(R"([{"plane": {"point": [1, 2, 3], "normal": [0, 0, -2]}}, {"box": {"min": [0, 0, 0], "max": [1, 2, 3]}}])");
  ASSERT_TRUE(scene);
  ASSERT_EQ(scene->clip_planes.size(), 7u);
  EXPECT_EQ(scene->clip_planes[0].normal, Vec3(0, 0, -2));
  // The box's planes keep its center and cut what is outside.
  for (std::size_t i = 1; i < 7; ++i) {
    const ClipPlane& plane = scene->clip_planes[i];
    EXPECT_GT(dot(plane.normal, Vec3(0.5, 1, 1.5) - plane.point), 0);
    EXPECT_LT(dot(plane.normal, (i % 2 == 1 ? Vec3(-1, -1, -1) : Vec3(2, 3, 4)) - plane.point), 0);
  }
}

TEST(SceneClip, ErrorsNameTheLine) {
  for (const auto& [text, expected] : {std::pair{R"({"plane": 1})", "an array of objects was expected"},
                                       {R"([{}])", "one of \"plane\", \"box\" and \"widget\" was expected"},
                                       {R"([{"plane": {"point": [0,0,0], "normal": [0,0,0]}}])", "a vector other than [0, 0, 0]"},
                                       {R"([{"box": {"min": [0,0,0], "max": [1,0,1]}}])", "a box was expected"},
                                       {R"([{"box": {"min": [0,0,0], "max": [1,1,1], "in": 1}}])", "in"}})
    expect_error(parse(text), "s.json:2", {expected});
  expect_error(parse(R"([{"box": {"min": [0,0,0], "max": [1,1,1]}}, {"box": {"min": [0,0,0], "max": [1,1,1]}}])"), "s.json:2",
               {"more than 8 clip planes"});
}

}  // namespace catena::scene::clip_test
