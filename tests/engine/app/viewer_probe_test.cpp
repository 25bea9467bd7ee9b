// SPDX-License-Identifier: MIT
// Command-line options of the window for the device and GPU memory, on a virtual display.
#include <gtest/gtest.h>

#include <sys/wait.h>

#include <cstdlib>

#include "tests/support/drive_window.h"
#include "tests/support/support.h"

namespace catena::app {
namespace viewer_probe_test {

bool has(const std::string& program) { return std::system(("command -v " + program + " > /dev/null 2>&1").c_str()) == 0; }

class ViewerProbe : public testing::Test {
 protected:
  /// Runs a window for a few frames and returns the exit code; the output is in log().
  int view(const std::string& scene, const std::string& options) {
    test::write_file(folder_ / "scene.json", scene);
    test::write_file(folder_ / "script.sh", test::program_path() + " view " + (folder_ / "scene.json") + " --size 320x240 " + options);
    const int status = std::system(
        ("timeout 120 " + test::on_display("640x480") + "sh " + (folder_ / "script.sh") + " > " + (folder_ / "log") + " 2>&1").c_str());
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  }
  std::string log() const { return test::read_file(folder_ / "log"); }
  test::TemporaryFolder folder_;
};

TEST_F(ViewerProbe, AnAbsentDeviceLeavesTheMouseAndANote) {
  if (!has("Xvfb")) GTEST_SKIP() << "no Xvfb here";
  ASSERT_EQ(view(R"({"chain": [{"name": "p", "type": "point", "position": [0, 0, 0]}]})",
                 "--device falcon:7 --frames 2 --record " + (folder_ / "a.catlog")),
            0)
      << log();
  EXPECT_NE(log().find("the mouse moves the probe"), std::string::npos) << log();
  EXPECT_NE(log().find("2 frames"), std::string::npos) << log();
  // The recording can be replayed.
  const int status =
      std::system((test::program_path() + " replay --log " + (folder_ / "a.catlog") + " > " + (folder_ / "log") + " 2>&1").c_str());
  EXPECT_EQ(WEXITSTATUS(status), 0) << log();
}

TEST_F(ViewerProbe, AGridThatDoesNotFitIntoGpuMemoryHasANote) {
  if (!has("Xvfb")) GTEST_SKIP() << "no Xvfb here";
  const std::string scene = R"({"fields": {"g": {"analytic": "gaussian", "resolution": 160}}, "volumes": [{"field": "g"}]})";
  ASSERT_EQ(view(scene, "--frames 1 --gpu-memory 8"), 0) << log();
  EXPECT_NE(log().find("resolution"), std::string::npos) << log();
}

}  // namespace viewer_probe_test
}  // namespace catena::app
