// SPDX-License-Identifier: MIT
// The window on a virtual display (Xvfb), with real pointer events if xdotool is installed.
#include <gtest/gtest.h>

#include <sys/wait.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <sstream>

#include "render/image/image.h"
#include "tests/support/drive_window.h"
#include "tests/support/support.h"

namespace catena::app {
namespace viewer_test {

constexpr const char* kScene = R"({
  "fields": {"v": {"analytic": "circle"}},
  "chain": [{"name": "c", "type": "streamline", "field": "v", "seed": [1, 0, 0]}],
  "workspace": {"metres_per_unit": 0.05},
  "streamlines": [{"field": "v", "seeds": [[1, 0, 0], [0.5, 0, 0.4]], "radius": 0.05}],
  "camera": {"position": [0, -6, 3], "target": [0, 0, 0]} })";

bool has(const std::string& program) { return std::system(("command -v " + program + " > /dev/null 2>&1").c_str()) == 0; }

int exit_code(const std::string& command) {
  const int status = std::system(command.c_str());
  return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

class Viewer : public testing::Test {
 protected:
  void SetUp() override {
    scene_ = folder_ / "scene.json";
    test::write_file(scene_, kScene);
  }
  std::string view() const { return test::program_path() + " view " + scene_ + " --size 320x240"; }
  int on_display(const std::string& script) {
    test::write_file(folder_ / "script.sh", script);
    return exit_code("timeout 60 " + test::on_display("640x480") + "sh " + (folder_ / "script.sh") + " > " + (folder_ / "log") + " 2>&1");
  }
  std::string log() const { return test::read_file(folder_ / "log"); }
  render::Image8 picture(const std::string& name) {
    auto read = render::read_png(folder_ / name);
    EXPECT_TRUE(read) << log();
    return read ? std::move(*read) : render::Image8();
  }

  test::TemporaryFolder folder_;
  std::string scene_;
};

int differing(const render::Image8& a, const render::Image8& b) {
  int count = 0;
  for (std::size_t i = 0; i < std::min(a.rgba.size(), b.rgba.size()); i += 4)
    if (std::abs(a.rgba[i] - b.rgba[i]) + std::abs(a.rgba[i + 1] - b.rgba[i + 1]) + std::abs(a.rgba[i + 2] - b.rgba[i + 2]) > 40) ++count;
  return count;
}

TEST_F(Viewer, AMissingDisplayIsOneErrorLine) {
  const std::string command = "env -u DISPLAY -u WAYLAND_DISPLAY " + view() + " > " + (folder_ / "log") + " 2>&1";
  EXPECT_EQ(exit_code(command), 1);
  const std::string text = log();
  EXPECT_EQ(text.find("catena: no display"), 0u) << text;
  EXPECT_EQ(std::count(text.begin(), text.end(), '\n'), 1) << text;
}

TEST_F(Viewer, DrawsTheSceneAndTheProbe) {
  if (!has("Xvfb")) GTEST_SKIP() << "no Xvfb here";
  ASSERT_EQ(on_display(view() + " --frames 4 --screenshot " + (folder_ / "a.png")), 0) << log();
  const render::Image8 a = picture("a.png");
  ASSERT_EQ(a.width, 320u);
  ASSERT_EQ(a.height, 240u);
  int red = 0, white = 0;
  for (std::size_t i = 0; i < a.rgba.size(); i += 4) {
    if (a.rgba[i] > 80 && a.rgba[i + 1] < a.rgba[i] / 2) ++red;
    if (a.rgba[i] > 150 && a.rgba[i + 1] > 150 && a.rgba[i + 2] > 150) ++white;
  }
  EXPECT_GT(red, 500) << "the streamlines";
  EXPECT_GT(white, 10) << "the probe";
  EXPECT_NE(log().find("4 frames"), std::string::npos) << log();
}

TEST_F(Viewer, AnUnknownDeviceIsReportedBeforeAnyWindow) {
  const std::string command = "env -u DISPLAY -u WAYLAND_DISPLAY " + view() + " --device nonsense > " + (folder_ / "log") + " 2>&1";
  EXPECT_EQ(exit_code(command), 2);
  const std::string text = log();
  EXPECT_EQ(text.find("catena: there is no device \"nonsense\""), 0u) << text;
  EXPECT_EQ(std::count(text.begin(), text.end(), '\n'), 1) << text;
}

TEST_F(Viewer, ForcesOfAHapticDeviceAreOffUntilF) {
  if (!has("Xvfb") || !has("xdotool")) GTEST_SKIP() << "no Xvfb or no xdotool here";
  std::ostringstream script;
  script << view() << " --device simulated --servo-stats " << (folder_ / "servo.json") << " &\n"
         << "for i in $(seq 200); do xdotool search --name 'forces off' > /dev/null 2>&1 && break; sleep 0.1; done\n"
         << "xdotool mousemove 160 120; sleep 0.3; xdotool key f\n"
         << "for i in $(seq 100); do xdotool search --name 'forces on' > /dev/null 2>&1 && break; sleep 0.1; done\n"
         << "xdotool key ctrl+q; wait $!\n";
  ASSERT_EQ(on_display(script.str()), 0) << log();
  const std::size_t off = log().find("forces off (F turns them on)"), on = log().find("forces on (F turns them off)");
  EXPECT_LT(off, on) << log();
  EXPECT_NE(on, std::string::npos) << log();
  EXPECT_NE(test::read_file(folder_ / "servo.json").find("\"missed_deadlines\""), std::string::npos);
}

TEST_F(Viewer, StereoFillsTheWindowAndF2SelectsTheNextMode) {
  if (!has("Xvfb")) GTEST_SKIP() << "no Xvfb here";
  ASSERT_EQ(on_display(view() + " --stereo side-by-side --frames 2 --screenshot " + (folder_ / "pair.png")), 0) << log();
  const render::Image8 pair = picture("pair.png");
  ASSERT_EQ(pair.width, 320u);
  ASSERT_EQ(pair.height, 240u);
  // Both halves show the streamlines.
  int red[2] = {0, 0};
  for (std::size_t i = 0; i < pair.rgba.size(); i += 4)
    if (pair.rgba[i] > 80 && pair.rgba[i + 1] < pair.rgba[i] / 2) ++red[(i / 4) % 320 / 160];
  EXPECT_GT(red[0], 200);
  EXPECT_GT(red[1], 200);
  if (!has("xdotool")) return;
  std::ostringstream script;
  script << view() << " --stereo top-bottom-half &\n"
         << "for i in $(seq 200); do xdotool search --name 'top-bottom-half' > /dev/null 2>&1 && break; sleep 0.1; done\n"
         << "xdotool mousemove 160 120; sleep 0.3; xdotool key F2\n"
         << "for i in $(seq 100); do xdotool search --name '[[]anaglyph[]]' > /dev/null 2>&1 && echo arrived && break; sleep 0.1; done\n"
         << "xdotool key ctrl+q; wait $!\n";
  ASSERT_EQ(on_display(script.str()), 0) << log();
  EXPECT_NE(log().find("arrived"), std::string::npos) << log();
}

TEST_F(Viewer, AChangedShaderIsReloadedAndABrokenOneIsReported) {
  if (!has("Xvfb") || !has("xdotool")) GTEST_SKIP() << "no Xvfb or no xdotool here";
  const std::string shaders = folder_ / "shaders", compose = shaders + "/passes/compose.frag";
  std::filesystem::copy(test::source_dir() + "/shaders", shaders, std::filesystem::copy_options::recursive);
  test::write_file(folder_ / "green.frag",
                   "#version 460\nlayout(location = 0) out vec4 c;\nvoid main() { c = vec4(0.0, 1.0, 0.0, 1.0); }\n");
  test::write_file(folder_ / "broken.frag", "#version 460\nvoid main() { nonsense; }\n");
  const auto wait_for = [&](const std::string& word) {
    return "for i in $(seq 200); do grep -q '" + word + "' " + (folder_ / "log") + " && break; sleep 0.1; done\n";
  };
  std::ostringstream script;
  script << view() << " --shaders " << shaders << " --screenshot " << (folder_ / "green.png") << " &\n"
         << "for i in $(seq 200); do xdotool search --name '^catena  ' > /dev/null 2>&1 && break; sleep 0.1; done\n"
         << "xdotool mousemove 160 120; sleep 0.6\n"
         << "cp " << (folder_ / "green.frag") << " " << compose << "\n"
         << wait_for("compose.frag: reloaded from the file") << "cp " << (folder_ / "broken.frag") << " " << compose << "\n"
         << wait_for("compose.frag:2: ") << "xdotool key ctrl+q; wait $!\n";
  ASSERT_EQ(on_display(script.str()), 0) << log();
  EXPECT_NE(log().find("catena: " + compose + ":2: 'nonsense'"), std::string::npos) << log();
  const render::Image8 green = picture("green.png");
  ASSERT_FALSE(green.rgba.empty());
  int others = 0;
  for (std::size_t i = 0; i < green.rgba.size(); i += 4) others += green.rgba[i] > 2 || green.rgba[i + 1] < 253 || green.rgba[i + 2] > 2;
  EXPECT_EQ(others, 0);
}

TEST_F(Viewer, InvalidQualityAndShadersAreOneErrorLine) {
  for (const auto& [options, text] : {std::pair{" --quality nonsense", "--quality nonsense: expected draft"},
                                      std::pair{" --shaders /nowhere", "--shaders /nowhere/passes/"}}) {
    EXPECT_EQ(exit_code("env -u DISPLAY -u WAYLAND_DISPLAY " + view() + options + " > " + (folder_ / "log") + " 2>&1"), 2);
    EXPECT_NE(log().find(text), std::string::npos) << log();
    EXPECT_EQ(std::ranges::count(log(), '\n'), 1) << log();
  }
}

TEST_F(Viewer, TheTitleHasTheQualityAndKeysChangeTheView) {
  if (!has("Xvfb") || !has("xdotool")) GTEST_SKIP() << "no Xvfb or no xdotool here";
  test::write_file(scene_, R"({
    "fields": {"f": {"analytic": "sphere"}},
    "volumes": [{"field": "f"}],
    "camera": {"position": [3, -6, 3], "target": [0, 0, 0]} })");
  const auto drive = [&](const std::string& keys, const std::string& png) {
    std::ostringstream script;
    script
        << view() << " --quality time=30 --screenshot " << (folder_ / png) << " &\n"
        << "for i in $(seq 200); do xdotool search --name '[[].*step .* ms[]]' > /dev/null 2>&1 && echo arrived && break; sleep 0.1; done\n"
        << "xdotool mousemove 160 120; sleep 0.3; " << keys << "\nsleep 0.5; xdotool key ctrl+q; wait $!\n";
    EXPECT_EQ(on_display(script.str()), 0) << log();
    EXPECT_NE(log().find("arrived"), std::string::npos) << log();
  };
  drive(":", "still.png");
  drive("xdotool key 1", "along_x.png");
  drive("xdotool key 1; sleep 0.2; xdotool key o", "flat.png");
  EXPECT_GT(differing(picture("still.png"), picture("along_x.png")), 500);
  EXPECT_GT(differing(picture("along_x.png"), picture("flat.png")), 50);
}

TEST_F(Viewer, DrawsForTheRequestedSeconds) {
  if (!has("Xvfb")) GTEST_SKIP() << "no Xvfb here";
  ASSERT_EQ(on_display(view() + " --seconds 1 --servo-stats " + (folder_ / "servo.json")), 0) << log();
  EXPECT_NE(test::read_file(folder_ / "servo.json").find("\"device\": \"mouse\""), std::string::npos);
}

TEST_F(Viewer, DragsOrbitTheViewAndMoveTheProbe) {
  if (!has("Xvfb") || !has("xdotool")) GTEST_SKIP() << "no Xvfb or no xdotool here";
  const auto drive = [&](const std::string& events, const std::string& png) {
    std::ostringstream script;
    script << view() << " --screenshot " << (folder_ / png) << " &\n"
           << "for i in $(seq 200); do xdotool search --name '^catena  ' > /dev/null 2>&1 && break; sleep 0.1; done\n"
           << "xdotool mousemove 160 120; sleep 0.3\n"
           << events << "\nsleep 0.5; xdotool key ctrl+q; wait $!\n";
    EXPECT_EQ(on_display(script.str()), 0) << log();
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

}  // namespace viewer_test
}  // namespace catena::app
