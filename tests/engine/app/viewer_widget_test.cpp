// SPDX-License-Identifier: MIT
// A cutting plane moved by the mouse in a real window, through all modes and into the saved scene; and dropped files.

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <set>

#include "engine/base/json.h"
#include "tests/engine/app/program_runs.h"
#include "tests/engine/app/window_fixture.h"
#include "tests/engine/io/vtk/files.h"
#include "tests/support/results.h"

namespace viewer_widget_test {

using namespace catena;

// The plane faces the camera, so the probe moves on the plane as the pointer does in the image.
constexpr const char* kScene = R"(// held by the mouse
{ "fields": {"d": {"analytic": "sphere", "resolution": 24}},
  "widgets": [{"name": "cut", "type": "cutting_plane", "center": [0, 0, 0], "normal": [0, -1, 0], "radius": 0.48}],
  "slices": [{"field": "d", "widget": "cut"}],
  "camera": {"position": [0, -6, 0], "target": [0, 0, 0]} })";

class ViewerWidget : public test::DrivenWindow {
 protected:
  ViewerWidget() {
    test::write_file(folder_ / "plane.json", kScene);
    test::write_file(folder_ / "ball.json", R"({"fields": {"d": {"analytic": "sphere", "resolution": 24}},
                                                "isosurfaces": [{"field": "d", "level": 1}]})");
  }
  /// Drops a file or folder on the window, which then has its name in the title.
  void drop(const std::string& options, const std::string& name) const {
    if (std::system("/usr/bin/python3 -c 'import Xlib' > /dev/null 2>&1") != 0) GTEST_SKIP() << "no python3-xlib here";
    play(options + " --size 640x480 --no-panels --quality draft",
         "sleep 1; /usr/bin/python3 " + test::source_dir() + "/tests/support/drop_file.py $W " + (folder_ / name) +
             " && echo taken\ntitled '" + name + "'\nxdotool mousemove 320 240; sleep 0.3; xdotool key ctrl+q");
    EXPECT_NE(log().find("taken"), std::string::npos) << log();
    EXPECT_NE(log().find("titled " + name), std::string::npos) << log();
  }
};

TEST_F(ViewerWidget, TheMouseDrivesTheCuttingPlaneThroughAllModes) {
  play("plane.json --size 640x480 --no-panels --quality draft --record hand.catlog",
       "by() { for i in 1 2 3 4 5 6; do xdotool mousemove_relative -- $1 $2; sleep 0.1; done; sleep 0.4; }\n"
       "sleep 1; xdotool mousemove 320 240; sleep 0.5; xdotool key h; sleep 0.5\n"
       "by 3 0\n"                                                                     // over the plane
       "xdotool keydown space; sleep 0.5; by 10 0; xdotool keyup space; sleep 0.5\n"  // moves it
       "by 7 0\n"                                                                     // to the sphere
       "xdotool keydown space; sleep 0.5; by 0 -8; xdotool keyup space; sleep 0.7\n"  // turns it
       "xdotool key h; sleep 0.3; xdotool key ctrl+s; sleep 1\n"
       "xdotool key ctrl+q; sleep 0.7; xdotool key Return");  // quit asks during a recording

  const auto saved = test::value_of(json::read(folder_ / "plane.json"));
  const json::Node& widget = saved.find("widgets")->items[0];
  const auto centre = test::value_of(json::require_vec3(widget, "center"));
  EXPECT_GT(centre.x, 0.1) << test::read_file(folder_ / "plane.json");
  EXPECT_EQ(centre.y, 0) << "the plane across y held";
  ASSERT_NE(widget.find("orientation"), nullptr) << "it was turned\n" << test::read_file(folder_ / "plane.json");
  EXPECT_EQ(test::read_file(folder_ / "plane.json").find("// held by the mouse"), 0u) << "the author's comment stays";

  // The recording contains the modes of the widget.
  test::run_ok({"replay", "--log", folder_ / "hand.catlog", "-o", folder_ / "t.csv", "--widgets", folder_ / "w.csv"});
  const test::Table table = test::Table::read(folder_ / "w.csv");
  std::set<std::string> modes;
  for (std::size_t k = 0; k < table.rows(); ++k) modes.insert(table.text(k, "cut_mode"));
  for (const char* mode : {"explore", "translate", "rotate", "turn"}) EXPECT_TRUE(modes.count(mode)) << mode;
}

TEST_F(ViewerWidget, TheMouseDragsTheArrowAndACircleUnderThePointer) {
  test::write_file(folder_ / "side.json", R"(// dragged
{ "fields": {"d": {"analytic": "sphere", "resolution": 24}}, "isosurfaces": [{"field": "d", "level": 1}],
  "widgets": [{"name": "cut", "type": "cutting_plane", "center": [0, 0, 0], "normal": [1, 0, 0], "radius": 0.48}],
  "clip": [{"widget": "cut", "side": "behind"}],
  "camera": {"position": [0, -6, 0], "target": [0, 0, 0], "projection": "orthographic", "height": 4} })");
  // 120 pixels a unit: the arrow from 320 to 403 at y = 240; then the circle about the view axis, a quarter turn
  const std::string drag =
      "drag() { xdotool mousemove $1 $2; sleep 0.3; xdotool mousedown 1; sleep 0.2; "
      "for k in 1 2 3 4 5 6; do xdotool mousemove $(($1 + ($3 - $1) * k / 6)) $(($2 + ($4 - $2) * k / 6)); sleep 0.1; "
      "done; sleep 0.3; xdotool mouseup 1; sleep 0.3; }\n";
  play("side.json --size 640x480 --no-panels --quality draft",
       "sleep 1\n" + drag + "drag 390 240 450 240\nkeys ctrl+s; sleep 0.7; cp side.json moved.json\n" +
           "drag 421 199 339 199\nkeys ctrl+s; sleep 0.7; cp side.json turned.json\n" +
           "keys ctrl+z ctrl+z; sleep 0.5; keys ctrl+s; sleep 0.7\nxdotool key ctrl+q");
  const auto widget_of = [&](const char* name) { return test::value_of(json::read(folder_ / name)).find("widgets")->items[0]; };
  const auto centre = test::value_of(json::require_vec3(widget_of("moved.json"), "center"));
  EXPECT_NEAR(centre.x, 0.5, 0.01);
  EXPECT_LT(std::hypot(centre.y, centre.z), 1e-9) << "along the normal only";
  const json::Node turned = widget_of("turned.json");
  const json::Node* q = turned.find("orientation");
  ASSERT_NE(q, nullptr);
  const Quat rotation(q->items[0].number, q->items[1].number, q->items[2].number, q->items[3].number);
  EXPECT_GT(rotate(rotation, {0, 0, 1}).z, 0.99) << "a quarter turn";
  EXPECT_EQ(test::read_file(folder_ / "turned.json").find("// dragged"), 0u);
  EXPECT_NE(widget_of("side.json").find("normal"), nullptr) << "each drag is one undo step";
}

TEST_F(ViewerWidget, ADroppedFileIsOpened) { drop("plane.json", "ball.json"); }

TEST_F(ViewerWidget, ADroppedFolderIsOpenedAsASeries) {
  std::filesystem::create_directory(folder_ / "slices");
  for (int k = 0; k < 3; ++k)
    test::write_file(folder_ / ("slices/" + std::to_string(k) + ".dcm"), test::vtk_files::dicom(k, {0, 0, 1.0 * k}, {1, 2, 3, 4, 5, 6}));
  drop("", "slices");
}

}  // namespace viewer_widget_test
