// SPDX-License-Identifier: MIT
/// Off-axis projection on a display screen: projected points in both eyes for moving heads.
#include "render/extract/extract_internal.h"
#include "render/frame/camera.h"
#include "tests/render/support/scene_packet.h"
#include "tests/support/run_program.h"
#include "tests/support/support.h"

namespace catena::render::display_screen_test {

constexpr const char* kScene = R"({"fields": {"ball": {"analytic": "sphere", "resolution": 24}},
  "isosurfaces": [{"field": "ball", "level": 0.5}], "stereo": {"mode": "side-by-side", "separation": 0.065},
  "screens": [{"name": "wall", "lower_left": [-1.5, -1, -1], "lower_right": [1.5, -1, -1], "upper_left": [-1.5, -1, 1]},
              {"name": "side", "lower_left": [1.5, -1, -1], "lower_right": [2.3, -1.6, -1], "upper_left": [1.5, -1, 1]}],
  "camera": {"position": [0.2, -3, 0.1], "target": [0, 0, 0]}})";

/// Intersection of the line from eye to point with the screen, in pixels, by geometry.
Vec2 on_screen(const scene::DisplayScreen& s, const Vec3& eye, const Vec3& point, double width, double height) {
  const Vec3 right = s.lower_right - s.lower_left, up = s.upper_left - s.lower_left, normal = cross(right, up);
  const double along = dot(normal, s.lower_left - eye) / dot(normal, point - eye);
  const Vec3 hit = eye + along * (point - eye) - s.lower_left;
  return {width * dot(hit, right) / dot(right, right), height * (1 - dot(hit, up) / dot(up, up))};
}

TEST(DisplayScreens, PointsProjectToTheIntersectionOfLineOfSightAndScreen) {
  scene::Scene scene = test::scene_from(kScene);
  ASSERT_EQ(scene.stereo.screens.size(), 2u);
  for (std::size_t which = 0; which < 2; ++which) {
    scene.stereo.screen_index = which;
    const scene::DisplayScreen& screen = scene.stereo.screens[which];
    FramePacket packet = test::packet_from(scene);
    for (const Vec3& head : {Vec3(0.2, -3, 0.1), Vec3(-0.6, -2.2, 0.5), Vec3(0.9, -4.5, -0.7)}) {
      View view = packet.view;
      view.position = head;
      set_view(scene, view, packet);
      ASSERT_TRUE(check_screen_view(packet, scene.stereo));
      ASSERT_EQ(packet.eyes.size(), 2u);
      EXPECT_NEAR(norm(packet.eyes[1].position - packet.eyes[0].position), 0.065, 1e-12);
      EXPECT_LT(norm(0.5 * (packet.eyes[1].position + packet.eyes[0].position) - head), 1e-12);
      for (const View& eye : packet.eyes)
        for (const Vec3& p : {Vec3(0, 0.3, 0.2), Vec3(1.4, 0.8, -0.5), Vec3(1.6, 3, 0.4)}) {
          const auto pixel = project(make_camera(eye, 320, 240, {}), p);
          ASSERT_TRUE(pixel);
          const Vec2 truth = on_screen(screen, eye.position, p, 320, 240);
          EXPECT_NEAR(pixel->x, truth.x, 1e-9);
          EXPECT_NEAR(pixel->y, truth.y, 1e-9);
        }
    }
  }
}

TEST(DisplayScreens, AHeadBehindTheScreenIsAnError) {
  scene::Scene scene = test::scene_from(kScene);
  scene.stereo.screen_index = 0;
  FramePacket packet = test::packet_from(scene, 64, 48);
  View behind = packet.view;
  behind.position = {0, 2, 0};
  set_view(scene, behind, packet);
  const Outcome checked = check_screen_view(packet, scene.stereo);
  ASSERT_FALSE(checked);
  EXPECT_NE(checked.error().message.find("\"wall\""), std::string::npos) << checked.error().message;
  EXPECT_EQ(packet.eyes.size(), 2u);
}

TEST(DisplayScreens, TheProgramDrawsScreensAndRefusesUnknownOnes) {
  const test::TemporaryFolder folder;
  test::write_file(folder / "s.json", kScene);
  test::write_file(folder / "head.csv", "t,px,py,pz,tx,ty,tz\n0,0,-3,0,0,0,0\n1,0,3,0,0,0,0\n");
  const auto render = [&](std::vector<std::string> more) {
    std::vector<std::string> all{"render", folder / "s.json", "--size", "80x60", "-o", folder / "p.png"};
    all.insert(all.end(), more.begin(), more.end());
    return test::run_catena(all);
  };
  const auto drawn = render({"--screen", "side"});
  if (drawn.exit_code == 1) GTEST_SKIP() << drawn.err;
  EXPECT_EQ(drawn.exit_code, 0) << drawn.err;
  for (const std::vector<std::string>& words :
       {std::vector<std::string>{"--screen", "floor"}, {"--screen", "wall", "--camera", folder / "head.csv", "--frames", "2"}}) {
    std::filesystem::remove(folder / "p.png");
    const auto refused = render(words);
    EXPECT_EQ(refused.exit_code, 2) << refused.out;
    EXPECT_EQ(std::count(refused.err.begin(), refused.err.end(), '\n'), 1) << refused.err;
    EXPECT_FALSE(test::exists(folder / "p.png"));
  }
  std::string bad = kScene;
  bad.replace(bad.find("[-1.5, -1, 1]}"), 14, "[-1.0, -1, 1]}");
  EXPECT_FALSE(scene::parse_scene(bad, "s.json"));
}

}  // namespace catena::render::display_screen_test
