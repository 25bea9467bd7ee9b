// SPDX-License-Identifier: MIT
// Edits of the transfer function and the isolevel in the window with real pointer events: the saved scene and the undo steps.

#include <algorithm>
#include <cmath>

#include "engine/scene/scene.h"
#include "tests/engine/app/window_fixture.h"

namespace catena::app::viewer_appearance_test {

// A scene that renders fast: in a slow frame, ImGui would see a press and a move as one event. The color bar is pure green and the line
// of the level pure magenta; no other part of the interface has these colors.
constexpr const char* kScene = R"({
  "fields": {"ball": {"analytic": "sphere", "resolution": 17}},
  "chain": [{"name": "skin", "type": "isosurface", "field": "ball", "level": 1}], // felt
  "workspace": {"metres_per_unit": 0.05},
  "volumes": [{"field": "ball", "color": [[0, 0, 1, 0], [4, 0, 1, 0]], "opacity": [[0, 0], [1, 0.25], [4, 0.04]], "opacity_unit": 1,
               "visible": false}],
  "isosurfaces": [{"field": "ball", "level": 1, "color": [1, 0, 1]}] })";

/// The bounding box of the pixels of one color in the side window.
struct Spot {
  int left = 1 << 20, top = 1 << 20, right = -1, bottom = -1;
  double x(double share) const { return left + share * (right + 1 - left); }
};
Spot find(const render::Image8& picture, int r, int g, int b) {
  Spot spot;
  for (int y = 0; y < static_cast<int>(picture.height); ++y)
    for (int x = 0; x < std::min(320, static_cast<int>(picture.width)); ++x) {
      const std::uint8_t* p = &picture.rgba[4 * (std::size_t(y) * picture.width + std::size_t(x))];
      if (p[0] != r || p[1] != g || p[2] != b) continue;
      spot.left = std::min(spot.left, x), spot.right = std::max(spot.right, x);
      spot.top = std::min(spot.top, y), spot.bottom = std::max(spot.bottom, y);
    }
  return spot;
}

class ViewerAppearance : public test::DrivenWindow {
 protected:
  struct Saved {
    scene::TransferFunction transfer;
    double surface_level = 0, link_level = 0;
  };
  Saved saved(const std::string& name) {
    Saved all;
    const auto scene = scene::read_scene(folder_ / name);
    EXPECT_TRUE(scene) << (scene ? "" : scene.error().message);
    if (!scene) return all;
    scene->entities.each<scene::Volume>([&](scene::Entity, const scene::Volume& v) { all.transfer = v.transfer; });
    scene->entities.each<scene::Isosurface>([&](scene::Entity, const scene::Isosurface& s) { all.surface_level = s.level; });
    scene->entities.each<scene::Link>([&](scene::Entity, const scene::Link& link) { all.link_level = link.node.find("level")->number; });
    return all;
  }
};

TEST_F(ViewerAppearance, DragsMoveAnOpacityAndALevelAndAreOneUndoStepEach) {
  test::write_file(folder_ / "s.json", kScene);
  const std::string view = "s.json --size 640x720 --quality draft";
  ASSERT_EQ(run_on_display("cd " + folder_.path() + "\n" + test::program_path() + " view " + view + " --frames 4 --screenshot-ui w.png",
                           "640x720"),
            0)
      << log();
  const render::Image8 window = picture("w.png");
  const Spot bar = find(window, 0, 255, 0), line = find(window, 255, 0, 255);
  ASSERT_GT(bar.right - bar.left, 200) << "the colour bar";
  ASSERT_GT(line.bottom - line.top, 20) << "the line of the level";

  // The plot is above the bar and shows square roots of opacities; the drag moves 0.25 at value 1 to about 0.64 at value 2.
  const double bottom = bar.top - 8, height = 115.5;
  const auto at = [](double x, double y) { return std::to_string(std::lround(x)) + " " + std::to_string(std::lround(y)); };
  const double middle = 0.5 * (line.top + line.bottom), level = 0.5 * (line.left + line.right);
  const auto drag = [&](const std::string& from, const std::string& half, const std::string& to) {
    return "xdotool mousemove " + from + "; sleep 0.5; xdotool mousedown 1; sleep 0.5; xdotool mousemove " + half +
           "; sleep 0.5; xdotool mousemove " + to + "; sleep 0.5; xdotool mouseup 1; sleep 0.5\n";
  };
  play(view,
       "cp s.json 0.json\nchanged() { until_ sh -c \"! cmp -s s.json $1\"; sleep 0.2; }\nsleep 1\n" +
           drag(at(bar.x(0.25), bottom - 0.5 * height), at(bar.x(0.4), bottom - 0.6 * height), at(bar.x(0.5), bottom - 0.8 * height)) +
           drag(at(level, middle), at(level + 10, middle), at(level + 40, middle)) +
           "xdotool key ctrl+s\nchanged 0.json\ncp s.json 1.json\n"
           "xdotool key ctrl+z; sleep 0.5; xdotool key ctrl+s\nchanged 1.json\ncp s.json 2.json\nxdotool key ctrl+q");

  const Saved edited = saved("1.json");
  ASSERT_EQ(edited.transfer.opacities.size(), 3u);
  EXPECT_NEAR(edited.transfer.opacities[1].value, 2, 0.1);
  EXPECT_NEAR(edited.transfer.opacities[1].alpha, 0.64, 0.05);
  EXPECT_EQ(edited.transfer.opacities[2].alpha, 0.04);
  EXPECT_GT(edited.surface_level, 1.3);
  EXPECT_LT(edited.surface_level, 1.8);
  EXPECT_EQ(edited.link_level, edited.surface_level) << "what is seen is what is felt";
  EXPECT_NE(test::read_file(folder_ / "1.json").find("// felt"), std::string::npos);

  // Undo reverts the whole drag of the level, and nothing else.
  const Saved back = saved("2.json");
  EXPECT_EQ(back.surface_level, 1);
  EXPECT_EQ(back.link_level, 1);
  EXPECT_EQ(back.transfer.opacities[1].alpha, edited.transfer.opacities[1].alpha);
}

}  // namespace catena::app::viewer_appearance_test
