// SPDX-License-Identifier: MIT
// The window on a virtual display (Xvfb), with real pointer events if xdotool is installed.

#include <filesystem>
#include <sstream>

#include "tests/engine/app/program_runs.h"
#include "tests/engine/app/window_fixture.h"

namespace catena::app::viewer_test {

using test::has;

constexpr const char* kScene = R"({
  "fields": {"v": {"analytic": "circle"}},
  "chain": [{"name": "c", "type": "streamline", "field": "v", "seed": [1, 0, 0]}],
  "workspace": {"metres_per_unit": 0.05},
  "streamlines": [{"field": "v", "seeds": [[1, 0, 0], [0.5, 0, 0.4]], "radius": 0.05}],
  "camera": {"position": [0, -6, 3], "target": [0, 0, 0]} })";

bool is_installed(const std::string& program) { return std::system(("command -v " + program + " > /dev/null 2>&1").c_str()) == 0; }

class Viewer : public test::WindowTest {
 protected:
  Viewer() { test::write_file(scene_, kScene); }
  std::string view() const { return test::program_path() + " view " + scene_ + " --size 320x240"; }
  /// Runs the window without a display; the output is one line that begins with the text.
  void expect_no_window(const std::string& options, int exit_code, const std::string& begin) const {
    EXPECT_EQ(run_logged("env -u DISPLAY -u WAYLAND_DISPLAY " + view() + options), exit_code) << options;
    EXPECT_EQ(log().find("catena: " + begin), 0u) << log();
    EXPECT_TRUE(test::is_one_line(log()));
  }
  /// Opens the window, waits for a title, moves the pointer to its center, plays the script, and quits.
  void play(const std::string& options, const std::string& title, const std::string& script) const {
    EXPECT_EQ(
        test::drive_windows(folder_, "view scene.json --size 320x240 " + options + "\ntitled '" + title +
                                         "'\nxdotool mousemove 160 120; sleep 0.3\n" + script + "\nxdotool key ctrl+q; wait $V\nexit $?\n"),
        0)
        << log();
    EXPECT_EQ(log().find("never"), std::string::npos) << log();
  }
  const std::string scene_ = folder_ / "scene.json";
};

/// The number of reddish pixels in columns from..to.
int count_red(const render::Image8& p, std::uint32_t from, std::uint32_t to) {
  int count = 0;
  for (std::uint32_t y = 0; y < p.height; ++y)
    for (std::uint32_t x = from; x < to; ++x) count += p.pixel(x, y)[0] > 80 && p.pixel(x, y)[1] < p.pixel(x, y)[0] / 2;
  return count;
}

int differing(const render::Image8& a, const render::Image8& b) {
  int count = 0;
  for (std::size_t i = 0; i < std::min(a.rgba.size(), b.rgba.size()); i += 4)
    if (std::abs(a.rgba[i] - b.rgba[i]) + std::abs(a.rgba[i + 1] - b.rgba[i + 1]) + std::abs(a.rgba[i + 2] - b.rgba[i + 2]) > 40) ++count;
  return count;
}

TEST_F(Viewer, AMissingDisplayIsOneErrorLine) { expect_no_window("", 1, "no display"); }

TEST_F(Viewer, DrawsTheSceneAndTheProbe) {
  if (!is_installed("Xvfb")) GTEST_SKIP() << "no Xvfb here";
  render::Image8 images[2];
  for (const bool states_probe : {false, true}) {
    if (states_probe) test::write_file(scene_, "{\"cursor\": {\"probe\": [0.5, 0, 0]}," + std::string(kScene).substr(1));
    ASSERT_EQ(run_on_display(view() + " --frames 4 --screenshot " + (folder_ / "a.png")), 0) << log();
    const render::Image8& a = images[states_probe] = picture("a.png");
    ASSERT_EQ(a.width, 320u);
    ASSERT_EQ(a.height, 240u);
    EXPECT_GT(count_red(a, 0, 320), 500) << "the streamlines";
    EXPECT_TRUE(has(log(), "4 frames"));
  }
  EXPECT_GT(differing(images[0], images[1]), 100) << "the probe of a mouse is hidden until it is moved, unless the scene states it";
}

TEST_F(Viewer, AnUnknownDeviceIsReportedBeforeAnyWindow) { expect_no_window(" --device nonsense", 2, "there is no device \"nonsense\""); }

TEST_F(Viewer, ForcesOfAHapticDeviceAreOffUntilF) {
  if (!test::can_drive_windows()) GTEST_SKIP() << "no Xvfb or no xdotool here";
  play("--device simulated --servo-stats servo.json", "forces off", "xdotool key f\ntitled 'forces on'");
  const std::size_t off = log().find("forces off (F turns them on)"), on = log().find("forces on (F turns them off)");
  EXPECT_LT(off, on) << log();
  EXPECT_NE(on, std::string::npos) << log();
  EXPECT_TRUE(has(test::read_file(folder_ / "servo.json"), "\"missed_deadlines\""));
}

TEST_F(Viewer, StereoFillsTheWindowAndF2SelectsTheNextMode) {
  if (!is_installed("Xvfb")) GTEST_SKIP() << "no Xvfb here";
  ASSERT_EQ(run_on_display(view() + " --stereo side-by-side --frames 2 --screenshot " + (folder_ / "pair.png")), 0) << log();
  const render::Image8 pair = picture("pair.png");
  ASSERT_EQ(pair.width, 320u);
  ASSERT_EQ(pair.height, 240u);
  // Both halves show the streamlines.
  EXPECT_GT(count_red(pair, 0, 160), 200);
  EXPECT_GT(count_red(pair, 160, 320), 200);
  if (!test::can_drive_windows()) return;
  play("--stereo top-bottom-half", "top-bottom-half", "xdotool key F2\ntitled '[[]anaglyph[]]'");
}

TEST_F(Viewer, AChangedShaderIsReloadedAndABrokenOneIsReported) {
  if (!test::can_drive_windows()) GTEST_SKIP() << "no Xvfb or no xdotool here";
  const std::string shaders = folder_ / "shaders", compose = shaders + "/passes/compose.frag";
  std::filesystem::copy(test::source_dir() + "/shaders", shaders, std::filesystem::copy_options::recursive);
  test::write_file(folder_ / "green.frag",
                   "#version 460\nlayout(location = 0) out vec4 c;\nvoid main() { c = vec4(0.0, 1.0, 0.0, 1.0); }\n");
  test::write_file(folder_ / "broken.frag", "#version 460\nvoid main() { nonsense; }\n");
  play("--shaders shaders --screenshot green.png", " - Catena",
       "sleep 0.3\ncp green.frag shaders/passes/compose.frag\nsays 'compose.frag: reloaded from the file'\n"
       "cp broken.frag shaders/passes/compose.frag\nsays 'compose.frag:2: '");
  EXPECT_TRUE(has(log(), "catena: shaders/passes/compose.frag:2: 'nonsense'"));
  const render::Image8 green = picture("green.png");
  ASSERT_FALSE(green.rgba.empty());
  int others = 0;
  for (std::size_t i = 0; i < green.rgba.size(); i += 4) others += green.rgba[i] > 2 || green.rgba[i + 1] < 253 || green.rgba[i + 2] > 2;
  EXPECT_EQ(others, 0);
}

TEST_F(Viewer, InvalidQualityAndShadersAreOneErrorLine) {
  expect_no_window(" --quality nonsense", 2, "--quality nonsense: expected draft");
  expect_no_window(" --shaders /nowhere", 2, "--shaders /nowhere/passes/");
}

TEST_F(Viewer, KeysChangeTheView) {
  if (!test::can_drive_windows()) GTEST_SKIP() << "no Xvfb or no xdotool here";
  test::write_file(scene_, R"({
    "fields": {"f": {"analytic": "sphere"}},
    "volumes": [{"field": "f"}],
    "camera": {"position": [3, -6, 3], "target": [0, 0, 0]} })");
  for (const auto& [keys, png] :
       {std::pair{"", "still.png"}, {"xdotool key 1", "along_x.png"}, {"xdotool key 1; sleep 0.2; xdotool key o", "flat.png"}})
    play(std::string("--quality time=30 --screenshot ") + png, " - Catena", std::string(keys) + "\nsleep 1");
  EXPECT_GT(differing(picture("still.png"), picture("along_x.png")), 500);
  EXPECT_GT(differing(picture("along_x.png"), picture("flat.png")), 50);
}

TEST_F(Viewer, DrawsForTheRequestedSeconds) {
  if (!is_installed("Xvfb")) GTEST_SKIP() << "no Xvfb here";
  ASSERT_EQ(run_on_display(view() + " --seconds 1 --servo-stats " + (folder_ / "servo.json")), 0) << log();
  EXPECT_TRUE(has(test::read_file(folder_ / "servo.json"), "\"device\": \"mouse\""));
}

TEST_F(Viewer, DragsOrbitTheViewAndMoveTheProbe) {
  if (!test::can_drive_windows()) GTEST_SKIP() << "no Xvfb or no xdotool here";
  const auto drive = [&](const std::string& events, const std::string& png) {
    play("--screenshot " + png, " - Catena", events + "\nsleep 0.5");
    return log();
  };
  const std::string still = drive("", "still.png");
  const std::string turned = drive("xdotool mousedown 1 mousemove 220 130 mousemove 260 140 mouseup 1", "turned.png");
  const std::string moved = drive("xdotool mousedown 3 mousemove 140 120 mousemove 80 120 mouseup 3", "moved.png");
  EXPECT_GT(differing(picture("still.png"), picture("turned.png")), 500);
  EXPECT_GT(differing(picture("still.png"), picture("moved.png")), 20);

  // The probe does not move unless the probe is dragged.
  const auto probe = [](const std::string& text) {
    std::istringstream in(text.substr(text.find("probe ") + 6));
    double x = 0;
    in >> x;
    return x;
  };
  ASSERT_NE(still.find("probe "), std::string::npos) << still;
  EXPECT_NEAR(probe(still), 1, 1e-9) << still;
  EXPECT_NEAR(probe(turned), 1, 1e-9) << turned;
  EXPECT_LT(probe(moved), 0) << moved;
}

}  // namespace catena::app::viewer_test
