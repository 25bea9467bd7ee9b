// SPDX-License-Identifier: MIT
// The window on a virtual display with real pointer and key events: panels, files, confirmations, images and a lost graphics device.

#include <cstdlib>
#include <filesystem>

#include "engine/app/viewer/viewer.h"
#include "tests/engine/app/window_fixture.h"

namespace catena::app::viewer_window_test {

constexpr const char* kScene = R"({
  "fields": {"v": {"analytic": "circle"}},
  "chain": [{"name": "c", "type": "streamline", "field": "v", "seed": [1, 0, 0]}],
  "workspace": {"metres_per_unit": 0.05},
  "streamlines": [{"field": "v", "seeds": [[1, 0, 0], [0.5, 0, 0.4]], "radius": 0.05}],
  "background": [0, 0.3, 0],
  "camera": {"position": [0, -6, 3], "target": [0, 0, 0]} })";
constexpr const char* kOther = R"({
  "fields": {"d": {"analytic": "sphere", "resolution": 24}},
  "isosurfaces": [{"field": "d", "level": 1}],
  "background": [0, 0, 0.4] })";

class ViewerWindow : public test::DrivenWindow {
 protected:
  ViewerWindow() {
    test::write_file(scene_, kScene);
    test::write_file(folder_ / "ball.json", kOther);
  }
  const std::string scene_ = folder_ / "flow.json";
};

bool is_color(const render::Image8& p, std::uint32_t x, std::uint32_t y, int r, int g, int b) {
  const std::uint8_t* at = p.pixel(x, y);
  return std::abs(at[0] - r) < 8 && std::abs(at[1] - g) < 8 && std::abs(at[2] - b) < 8;
}

TEST_F(ViewerWindow, TheImageIsBesideThePanelsAndTabHidesThem) {
  play(scene_ + " --size 900x600 --screenshot end.png",
       "keys shift+F12; written flow-001.png\nkeys F12; written flow-002.png\n"
       "keys Tab; sleep 0.5; keys F12; written flow-003.png\nkeys ctrl+q");
  const render::Image8 window = picture("flow-001.png"), beside = picture("flow-002.png"), alone = picture("flow-003.png");
  EXPECT_EQ(window.width, 900u);
  EXPECT_EQ(window.height, 600u);
  EXPECT_EQ(beside.width, 580u);
  EXPECT_LT(beside.height, 600u);
  EXPECT_EQ(alone.width, 900u);
  EXPECT_EQ(alone.height, 600u);
  EXPECT_EQ(picture("end.png").width, 900u);
  ASSERT_FALSE(window.rgba.empty() || beside.rgba.empty() || alone.rgba.empty());
  EXPECT_TRUE(is_color(window, 895, 100, 0, 77, 0)) << "the background right of the panels";
  EXPECT_FALSE(is_color(window, 100, 300, 0, 77, 0)) << "panels";
  EXPECT_TRUE(is_color(alone, 5, 590, 0, 77, 0));
}

TEST_F(ViewerWindow, QuitAsksBeforeUnsavedEditsAreLost) {
  // The key O changes the view only. Edits in the side window have their own tests; here the undo step comes from saving the changed view
  // to another file.
  play(scene_ + " --size 900x600",
       "keys o ctrl+shift+s; sleep 0.3; xdotool type --delay 60 'copy'; keys Return; written copy.json\n"
       "keys ctrl+z; titled 'copy.json [^ -]'\n"
       "keys ctrl+q; sleep 0.5; kill -0 $V && echo 'still there'\n"
       "keys Escape; sleep 0.3; kill -0 $V && echo 'still open'\n"
       "keys ctrl+q; sleep 0.5; keys Return");
  EXPECT_NE(log().find("still there"), std::string::npos) << log();
  EXPECT_NE(log().find("still open"), std::string::npos) << log();
  const std::string saved = test::read_file(folder_ / "copy.json");
  EXPECT_EQ(saved.find("orthographic"), std::string::npos) << "the undone text was saved on the way out";
  EXPECT_EQ(test::read_file(scene_), kScene) << "the first file is as it was";
}

TEST_F(ViewerWindow, TheOpenDialogOpensTypedNamesAndAFailureKeepsTheScene) {
  play("--size 900x600 --screenshot-ui end.png",
       "titled 'untitled'\n"
       "keys ctrl+o; sleep 0.3; xdotool type --delay 60 'flow.js'; keys Tab Return; titled 'flow.json'\n"
       "keys ctrl+o; sleep 0.3; xdotool type --delay 60 'none.json'; keys Return; sleep 0.7; titled 'flow.json'\n"
       "keys ctrl+o; sleep 0.3; xdotool type --delay 60 'ball.json'; keys Return; titled 'ball.json'\n"
       "sleep 0.5; keys ctrl+q");
  const render::Image8 end = picture("end.png");
  ASSERT_FALSE(end.rgba.empty());
  EXPECT_TRUE(is_color(end, 895, 100, 0, 0, 102));
}

TEST_F(ViewerWindow, ThePlanesAreSavedAndOpenedAgain) {
  play((folder_ / "ball.json") + " --size 900x600",
       "keys 4; sleep 0.5; xdotool mousemove 480 180; sleep 0.3; xdotool click 5; sleep 0.3\n"
       "keys ctrl+shift+s; sleep 0.3; xdotool type --delay 60 'planes'; keys Return; written planes.json; keys ctrl+q");
  const std::string saved = test::read_file(folder_ / "planes.json");
  EXPECT_NE(saved.find("\"orthogonal_views\": {\"focus\": ["), std::string::npos) << saved;
  play((folder_ / "planes.json") + " --size 900x600",
       "keys 4; sleep 0.5; keys ctrl+s\nfor n in $(seq 50); do grep -q orthogonal planes.json || break; sleep 0.2; done; keys ctrl+q");
  EXPECT_EQ(test::read_file(folder_ / "planes.json").find("orthogonal_views"), std::string::npos) << "4 turned them off";
}

TEST_F(ViewerWindow, UndoInATextFieldDoesNotApplyToTheTextOfAnEarlierUse) {
  play(scene_ + " --size 900x600",
       "keys ctrl+shift+s; sleep 0.3; xdotool type --delay 60 'some much longer name'; keys Escape ctrl+shift+s; sleep 0.3\n"
       "keys ctrl+z ctrl+z End 2 Return; written flow.json2.json\n"
       "keys ctrl+shift+s; sleep 0.3; xdotool type --delay 60 'ball.js'; keys Tab ctrl+z End 3 Return; written ball.json3.json; keys "
       "ctrl+q");
}

TEST_F(ViewerWindow, RepeatedResizingKeepsTheImagesSizeRight) {
  play(scene_ + " --size 800x500",
       "for s in '300 200' '900 650' '40 30' '1 1' '700 400' '820 610'; do xdotool windowsize $W $s; sleep 0.15; done\n"
       "xdotool windowminimize $W; sleep 0.3; xdotool windowmap $W; xdotool windowsize $W 860 560; sleep 1\n"
       "xdotool mousemove 600 300; keys shift+F12; written flow-001.png; keys ctrl+q");
  const render::Image8 window = picture("flow-001.png");
  EXPECT_EQ(window.width, 860u);
  EXPECT_EQ(window.height, 560u);
}

// The child process of ALostGraphicsDeviceIsRestarted: a window whose graphics device is lost four times, at different driver calls.
TEST(ViewerDeviceLost, DISABLED_InAWindow) {
  ViewOptions options;
  options.source = std::getenv("CATENA_TEST_SCENE");
  options.width = 400;
  options.height = 300;
  options.max_frames = 60;
  options.haptic_options.device = "mouse";
  auto quality = parse_quality("draft");
  ASSERT_TRUE(quality);
  options.quality = *quality;
  const auto calls = std::make_shared<int>(0);
  const auto at = [](int call) { return call == 40 || call == 93 || call == 146 || call == 199; };
  options.inject_failure = [calls, at](render::vk::DriverCall call) {
    return call == render::vk::DriverCall::wait && at(++*calls) ? VK_ERROR_DEVICE_LOST : VK_SUCCESS;
  };
  EXPECT_EQ(run_viewer(std::move(options)), 0);
  EXPECT_GT(*calls, 199) << "otherwise the last one never came";
}

TEST_F(ViewerWindow, ALostGraphicsDeviceIsRestarted) {
  const std::string self = std::filesystem::read_symlink("/proc/self/exe").string();
  EXPECT_EQ(run_logged("env -u GTEST_TOTAL_SHARDS -u GTEST_SHARD_INDEX CATENA_TEST_SCENE=" + scene_ + " timeout 90 " +
                       test::on_display("640x480") + self +
                       " --gtest_also_run_disabled_tests --gtest_filter=ViewerDeviceLost.DISABLED_InAWindow"),
            0)
      << log();
  EXPECT_NE(log().find("60 frames"), std::string::npos) << log();
  EXPECT_NE(log().find("lost and restarted 4 times"), std::string::npos) << log();
}

TEST_F(ViewerWindow, WithoutADisplayTheScreenshotIsStillDrawn) {
  EXPECT_EQ(run_logged("cd " + folder_.path() + " && env -u DISPLAY -u WAYLAND_DISPLAY " + test::program_path() + " view " + scene_ +
                       " --size 200x150 --screenshot a.png"),
            0)
      << log();
  EXPECT_NE(log().find("rendered without a window"), std::string::npos) << log();
  const render::Image8 a = picture("a.png");
  EXPECT_EQ(a.width, 200u);
  EXPECT_EQ(a.height, 150u);
}

}  // namespace catena::app::viewer_window_test
