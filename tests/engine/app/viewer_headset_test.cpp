// catena view --xr against the scripted runtime (tests/xr_runtime), on a virtual display.
#include <gtest/gtest.h>

#include <sys/wait.h>

#include <algorithm>
#include <cstdlib>
#include <sstream>

#include "render/image/picture.h"
#include "tests/support/support.h"
#include "tests/support/windows.h"

namespace catena::app {
namespace viewer_headset_test {

constexpr const char* kScene = R"({
  "fields": {"s": {"analytic": "sphere"}},
  "chain": [{"name": "ball", "type": "isosurface", "field": "s", "level": 1}],
  "isosurfaces": [{"field": "s", "level": 1, "color": [1, 0.5, 0.2]}],
  "camera": {"position": [0, -6, 3], "target": [0, 0, 0]} })";

class ViewerHeadset : public testing::Test {
 protected:
  void SetUp() override {
    if (!test::exists(test::binary_dir() + "/libcatena_xr_runtime.so")) GTEST_SKIP() << "the scripted runtime was not built";
    test::write_file(folder_ / "scene.json", kScene);
  }
  int view(const std::string& options, const std::string& words, const std::string& runtime) {
    test::write_file(folder_ / "script.sh", "export HOME=" + folder_.path() + " XR_RUNTIME_JSON=" + runtime + " CATENA_XR_SCRIPT='" +
                                                words + " record=" + (folder_ / "record") + "'\nexec " + test::program_path() + " view " +
                                                (folder_ / "scene.json") + " --xr --size 320x240 " + options + "\n");
    const int status = std::system(
        ("timeout 60 " + test::on_display("640x480") + "sh " + (folder_ / "script.sh") + " > " + (folder_ / "log") + " 2>&1").c_str());
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  }
  int view(const std::string& options, const std::string& words) { return view(options, words, test::binary_dir() + "/xr_runtime.json"); }
  std::string log() const { return test::read_file(folder_ / "log"); }
  /// A number of what the runtime has seen.
  double seen(const std::string& word) const {
    std::istringstream in(test::read_file(folder_ / "record"));
    std::string name;
    for (double value = 0; in >> name >> value;)
      if (name == word) return value;
    return -1;
  }
  int lines_of_catena() const {
    std::istringstream in(log());
    int count = 0;
    for (std::string line; std::getline(in, line);) count += line.starts_with("catena: ");
    return count;
  }
  test::TemporaryFolder folder_;
};

TEST_F(ViewerHeadset, BothEyesAreDrawnAndTheFirstOneIsMirrored) {
  ASSERT_EQ(view("--frames 8 --screenshot " + (folder_ / "eye.png"), "size=96x80"), 0) << log();
  EXPECT_GE(seen("pictures"), 7);
  EXPECT_EQ(seen("moved"), 0);
  EXPECT_EQ(seen("illegal"), 0) << test::read_file(folder_ / "record");
  EXPECT_EQ(seen("objects"), 0);
  EXPECT_NE(log().find("headset: "), std::string::npos) << log();
  EXPECT_EQ(lines_of_catena(), 0) << log();
  const auto eye = render::read_png(folder_ / "eye.png");
  ASSERT_TRUE(eye) << eye.error().message;
  // the ball is straight ahead, and orange
  EXPECT_EQ(eye->width * 80, eye->height * 96);
  std::size_t orange = 0;
  for (std::size_t i = 0; i < eye->rgba.size(); i += 4) orange += eye->rgba[i] > eye->rgba[i + 2] + 40;
  EXPECT_GT(orange, eye->rgba.size() / 4 / 100);
}

TEST_F(ViewerHeadset, WithoutARuntimeItSaysSoInOneLine) {
  EXPECT_EQ(view("--frames 2", "", "/nowhere/runtime.json"), 1) << log();
  EXPECT_EQ(lines_of_catena(), 1) << log();
  EXPECT_NE(log().find("expected an OpenXR runtime"), std::string::npos) << log();
}

/// The session is lost, then the whole runtime: said once each, the window goes on, and the headset comes back with a new device.
TEST_F(ViewerHeadset, WhatIsLostComesBack) {
  ASSERT_EQ(view("--frames 60", "size=32x32 fail=xrEndFrame:6:-17 fail=xrWaitFrame:20:-13"), 0) << log();
  EXPECT_NE(log().find("XR_ERROR_SESSION_LOST"), std::string::npos) << log();
  EXPECT_NE(log().find("XR_ERROR_INSTANCE_LOST"), std::string::npos) << log();
  EXPECT_EQ(lines_of_catena(), 2) << log();
  EXPECT_GT(seen("pictures"), 20);
  EXPECT_EQ(seen("illegal"), 0) << test::read_file(folder_ / "record");
  EXPECT_EQ(seen("objects"), 0);
}

}  // namespace viewer_headset_test
}  // namespace catena::app
