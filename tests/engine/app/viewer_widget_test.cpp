// SPDX-License-Identifier: MIT
// A cutting plane moved by the mouse in a real window, through all modes and into the saved scene; and dropped files.
#include <gtest/gtest.h>

#include <sys/wait.h>

#include <cstdlib>
#include <set>
#include <sstream>

#include "engine/base/json.h"
#include "tests/engine/io/vtk/files.h"
#include "tests/support/drive_window.h"
#include "tests/support/run_program.h"
#include "tests/support/support.h"

namespace viewer_widget_test {

using namespace catena;

// The plane faces the camera, so the probe moves on the plane as the pointer does in the image.
constexpr const char* kScene = R"(// held by the mouse
{ "fields": {"d": {"analytic": "sphere", "resolution": 24}},
  "widgets": [{"name": "cut", "type": "cutting_plane", "center": [0, 0, 0], "normal": [0, -1, 0], "radius": 0.48}],
  "slices": [{"field": "d", "widget": "cut"}],
  "camera": {"position": [0, -6, 0], "target": [0, 0, 0]} })";

bool has(const std::string& program) { return std::system((program + " > /dev/null 2>&1").c_str()) == 0; }

class ViewerWidget : public testing::Test {
 protected:
  void SetUp() override {
    if (!has("command -v Xvfb") || !has("command -v xdotool")) GTEST_SKIP() << "no Xvfb or no xdotool here";
    test::write_file(folder_ / "plane.json", kScene);
    test::write_file(folder_ / "ball.json", R"({"fields": {"d": {"analytic": "sphere", "resolution": 24}},
                                                "isosurfaces": [{"field": "d", "level": 1}]})");
  }
  int drive(const std::string& options, const std::string& script) {
    std::ostringstream all;
    all << "cd " << folder_.path() << "\nexport HOME=" << folder_.path() << " XDG_STATE_HOME=" << (folder_ / "state") << "\n"
        << "titled() { for i in $(seq 300); do xdotool search --name \"$1\" > /dev/null 2>&1 && return; sleep 0.1; done; "
           "echo \"never titled $1\"; }\n"
        << "by() { for i in 1 2 3 4 5 6; do xdotool mousemove_relative -- $1 $2; sleep 0.1; done; sleep 0.4; }\n"
        << test::program_path() << " view " << options << " &\nV=$!\ntitled '^catena  '\nsleep 1\n"
        << script << "\nwait $V\n";
    test::write_file(folder_ / "script.sh", all.str());
    const int status = std::system(
        ("timeout 90 " + test::on_display("800x600") + "sh " + (folder_ / "script.sh") + " > " + (folder_ / "log") + " 2>&1").c_str());
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  }
  std::string log() const { return test::read_file(folder_ / "log"); }
  test::TemporaryFolder folder_;
};

TEST_F(ViewerWidget, TheMouseDrivesTheCuttingPlaneThroughAllModes) {
  ASSERT_EQ(drive("plane.json --size 640x480 --no-panels --quality draft --record hand.catlog",
                  "xdotool mousemove 320 240; sleep 0.5; xdotool key h; sleep 0.5\n"
                  "by 3 0\n"                                                                     // over the plane
                  "xdotool keydown space; sleep 0.5; by 10 0; xdotool keyup space; sleep 0.5\n"  // moves it
                  "by 7 0\n"                                                                     // to the sphere
                  "xdotool keydown space; sleep 0.5; by 0 -8; xdotool keyup space; sleep 0.7\n"  // turns it
                  "xdotool key h; sleep 0.3; xdotool key ctrl+s; sleep 1\n"
                  "xdotool key ctrl+q; sleep 0.7; xdotool key Return"),  // quit asks during a recording
            0)
      << log();

  const auto saved = json::read(folder_ / "plane.json");
  ASSERT_TRUE(saved) << saved.error().message;
  const json::Node& widget = saved->find("widgets")->items[0];
  const auto centre = json::require_vec3(widget, "center");
  ASSERT_TRUE(centre);
  EXPECT_GT(centre->x, 0.1) << test::read_file(folder_ / "plane.json");
  EXPECT_EQ(centre->y, 0) << "the plane across y held";
  ASSERT_NE(widget.find("orientation"), nullptr) << "it was turned\n" << test::read_file(folder_ / "plane.json");
  EXPECT_EQ(test::read_file(folder_ / "plane.json").find("// held by the mouse"), 0u) << "the author's comment stays";

  // The recording contains the modes of the widget.
  const auto run = test::run_catena({"replay", "--log", folder_ / "hand.catlog", "-o", folder_ / "t.csv", "--widgets", folder_ / "w.csv"});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  const test::Table table = test::Table::read(folder_ / "w.csv");
  std::set<std::string> modes;
  for (std::size_t k = 0; k < table.rows(); ++k) modes.insert(table.text(k, "cut_mode"));
  for (const char* mode : {"explore", "translate", "rotate", "turn"}) EXPECT_TRUE(modes.count(mode)) << mode;
}

TEST_F(ViewerWidget, ADroppedFileIsOpened) {
  if (!has("/usr/bin/python3 -c 'import Xlib'")) GTEST_SKIP() << "no python3-xlib here";
  ASSERT_EQ(drive("plane.json --size 640x480 --no-panels --quality draft",
                  "/usr/bin/python3 " + test::source_dir() + "/tests/support/drop_file.py $(xdotool search --name '^catena  ' | head -1) " +
                      (folder_ / "ball.json") +
                      " && echo taken\ntitled 'ball.json'\nxdotool search --name ball.json > /dev/null && echo opened\n"
                      "xdotool mousemove 320 240; sleep 0.3; xdotool key ctrl+q"),
            0)
      << log();
  EXPECT_NE(log().find("taken"), std::string::npos) << log();
  EXPECT_NE(log().find("opened"), std::string::npos) << log();
}

TEST_F(ViewerWidget, ADroppedFolderIsOpenedAsASeries) {
  if (!has("/usr/bin/python3 -c 'import Xlib'")) GTEST_SKIP() << "no python3-xlib here";
  std::filesystem::create_directory(folder_ / "slices");
  for (int k = 0; k < 3; ++k)
    test::write_file(folder_ / ("slices/" + std::to_string(k) + ".dcm"), test::vtk_files::dicom(k, {0, 0, 1.0 * k}, {1, 2, 3, 4, 5, 6}));
  ASSERT_EQ(drive("--size 640x480 --no-panels --quality draft",
                  "/usr/bin/python3 " + test::source_dir() + "/tests/support/drop_file.py $(xdotool search --name '^catena' | head -1) " +
                      (folder_ / "slices") +
                      " && echo taken\ntitled 'slices'\nxdotool search --name slices > /dev/null && echo opened\n"
                      "xdotool mousemove 320 240; sleep 0.3; xdotool key ctrl+q"),
            0)
      << log();
  EXPECT_NE(log().find("opened"), std::string::npos) << log();
}

}  // namespace viewer_widget_test
