// SPDX-License-Identifier: MIT
/// `catena replay --widgets`: a cutting plane dragged by a scripted probe, against closed forms.

#include <cmath>

#include "engine/base/numbers.h"
#include "engine/base/vec.h"
#include "tests/engine/app/program_in_folder.h"

namespace widgets_test {

using namespace catena;

constexpr const char* kScene = R"({"fields": {"d": {"analytic": "gaussian"}},
  "widgets": [{"name": "cut", "type": "cutting_plane", "center": [0, 0, 0], "normal": [0, 0, 1], "radius": 0.5,
               "snap": 0.1, "release": 0.2, "grab_distance": 0.05, "step": 0.1}],
  "slices": [{"field": "d", "widget": "cut"}]})";

class Widgets : public test::ProgramInFolder {
 protected:
  test::Table replay(const std::string& path_csv) {
    write("s.json", kScene);
    write("p.csv", "t,x,y,z,buttons\n" + path_csv);
    succeed("replay {s.json} --probe {p.csv} -o {t.csv} --widgets {w.csv}");
    return test::Table::read(folder_ / "w.csv");
  }
  static std::string row(int k, const Vec3& p, int buttons) {
    return to_text(1e-3 * k) + "," + to_text(p.x) + "," + to_text(p.y) + "," + to_text(p.z) + "," + std::to_string(buttons) + "\n";
  }
};

TEST_F(Widgets, ADragAlongXWithTremorKeepsYAndZ) {
  std::string path;
  for (int k = 0; k < 200; ++k) path += row(k, {1.0, 0.5, 0.0}, 0);
  for (int k = 200; k <= 1200; ++k)
    path += row(k, {1 + 6e-4 * (k - 200), 0.5 + 0.08 * std::sin(0.1 * (k - 200)), 0.09 * std::sin(0.07 * (k - 200))}, 1);
  for (int k = 1201; k < 1300; ++k) path += row(k, {1.6, 0.5, 0.0}, 0);
  const test::Table table = replay(path);
  for (std::size_t k = 0; k < table.rows(); ++k) {
    EXPECT_EQ(table.number(k, "cut_y"), 0);
    EXPECT_EQ(table.number(k, "cut_z"), 0);
    EXPECT_EQ(table.number(k, "cut_nz"), 1);
  }
  EXPECT_EQ(table.text(100, "cut_mode"), "explore");
  EXPECT_EQ(table.text(700, "cut_mode"), "translate");
  EXPECT_EQ(table.text(1290, "cut_mode"), "explore");
  // The plane across x releases at `step`; then the widget moves as far as the probe.
  EXPECT_EQ(table.number(360, "cut_x"), 0);
  EXPECT_NEAR(table.number(1200, "cut_x"), 0.6 - 0.1, 1e-12);
  EXPECT_NEAR(table.number(table.rows() - 1, "cut_x"), 0.5, 1e-12);
}

TEST_F(Widgets, ARotationAboutAnAxisKeepsTheAxis) {
  // A path on the great circle across the widget's y axis, away from the other circles: from x towards z by 100 degrees.
  const double angle = 100 * M_PI / 180, start = 40 * M_PI / 180;
  std::string path;
  for (int k = 0; k < 200; ++k) path += row(k, {0.5 * std::cos(start), 0.0, 0.5 * std::sin(start)}, 0);
  for (int k = 200; k <= 1200; ++k) {
    const double a = start + angle * (k - 200) / 1000;
    path += row(k, {0.55 * std::cos(a), 0.03 * std::sin(0.05 * k), 0.55 * std::sin(a)}, 1);
  }
  const test::Table table = replay(path);
  const std::size_t last = table.rows() - 1;
  ASSERT_EQ(table.text(last, "cut_mode"), "turn");
  EXPECT_EQ(table.number(last, "cut_held"), 2) << "the plane across y";
  for (std::size_t k = 0; k <= last; ++k) EXPECT_NEAR(table.number(k, "cut_ny"), 0, 1e-12);
  // x rotates to z, so z rotates to -x.
  EXPECT_NEAR(table.number(last, "cut_nx"), -std::sin(angle), 1e-12);
  EXPECT_NEAR(table.number(last, "cut_nz"), std::cos(angle), 1e-12);
  EXPECT_EQ(table.number(last, "cut_x"), 0);
  EXPECT_EQ(table.number(last, "cut_z"), 0);
}

TEST_F(Widgets, ALinkWithTheNameOfAWidgetsLinkIsRefused) {
  write("bad.json", R"({"fields": {}, "chain": [{"name": "widget_x", "type": "point", "position": [0, 0, 0]}],
    "widgets": [{"name": "cut", "type": "cutting_plane", "center": [0, 0, 0], "normal": [0, 0, 1]}]})");
  write("p.csv", "t,x,y,z\n0,0,0,0\n");
  expect_refused("replay {bad.json} --probe {p.csv} -o {t.csv}", {"bad.json:2:", "widget_x"});
}

}  // namespace widgets_test
