// SPDX-License-Identifier: MIT
// Command-line options of the window for the device and GPU memory, on a virtual display.
#include "tests/engine/app/program_runs.h"
#include "tests/engine/app/window_fixture.h"

namespace catena::app::viewer_probe_test {

class ViewerProbe : public test::WindowTest {
 protected:
  void SetUp() override {
    if (std::system("command -v Xvfb > /dev/null 2>&1") != 0) GTEST_SKIP() << "no Xvfb here";
  }
  /// Runs a window for a few frames.
  void view(const std::string& scene, const std::string& options) const {
    test::write_file(folder_ / "scene.json", scene);
    ASSERT_EQ(run_on_display(test::program_path() + " view " + (folder_ / "scene.json") + " --size 320x240 " + options), 0) << log();
  }
};

TEST_F(ViewerProbe, AnAbsentDeviceLeavesTheMouseAndANote) {
  view(R"({"chain": [{"name": "p", "type": "point", "position": [0, 0, 0]}]})",
       "--device falcon:7 --frames 2 --record " + (folder_ / "a.catlog"));
  EXPECT_TRUE(test::has(log(), "the mouse moves the probe"));
  EXPECT_TRUE(test::has(log(), "2 frames"));
  test::run_ok({"replay", "--log", folder_ / "a.catlog"});
}

TEST_F(ViewerProbe, AGridThatDoesNotFitIntoGpuMemoryHasANote) {
  const std::string scene = R"({"fields": {"g": {"analytic": "gaussian", "resolution": 160}}, "volumes": [{"field": "g"}]})";
  view(scene, "--frames 1 --gpu-memory 8");
  EXPECT_TRUE(test::has(log(), "resolution"));
}

}  // namespace catena::app::viewer_probe_test
