// SPDX-License-Identifier: MIT
// Binding of haptics in a real window: a scene without a chain, the pointer on the surface, the key H, and the wheel.
#include <gtest/gtest.h>

#include <filesystem>

#include "tests/support/drive_window.h"
#include "tests/support/run_program.h"
#include "tests/support/support.h"

namespace catena::app {
namespace viewer_haptic_binding_test {

class ViewerHapticBinding : public testing::Test {
 protected:
  void SetUp() override {
    if (!test::can_drive_windows()) GTEST_SKIP() << "no Xvfb or no xdotool here";
    test::write_file(folder_ / "ball.json", R"({"fields": {"d": {"analytic": "sphere", "resolution": 24}},
      "isosurfaces": [{"field": "d", "level": 1}], "camera": {"position": [0, -6, 0], "target": [0, 0, 0]}})");
  }
  std::string log() const { return test::read_file(folder_ / "log"); }
  test::TemporaryFolder folder_;
};

TEST_F(ViewerHapticBinding, HPlacesTheProbeUnderThePointerAndTheWheelPushes) {
  // The center of the image: the panels take the left 320 pixels.
  ASSERT_EQ(test::drive_window(folder_, "ball.json --size 900x600",
                               "xdotool mousemove 610 310; sleep 0.3; keys h; titled ' N  isosurface .*[[]probe mode[]]'\n"
                               "for i in 1 2 3 4; do xdotool click 4; sleep 0.1; done; titled ' [1-9][.][0-9]* N  isosurface OK'\n"
                               // Over a panel, the pointer does not move the probe.
                               "xdotool mousemove 100 450; sleep 0.3; for i in 1 2 3 4 5 6 7 8; do xdotool click 5; done; sleep 0.5\n"
                               "titled ' [1-9][.][0-9]* N  isosurface OK'; keys Escape ctrl+s ctrl+q"),
            0)
      << log();
  EXPECT_EQ(log().find("never"), std::string::npos) << log();
  const std::string saved = test::read_file(folder_ / "ball.json");
  EXPECT_NE(saved.find(R"("type": "isosurface", "field": "d", "level": 1, "free": "above")"), std::string::npos) << saved;
}

TEST_F(ViewerHapticBinding, WithoutAnObjectUnderThePointerTheSceneIsUnchanged) {
  ASSERT_EQ(test::drive_window(folder_, "ball.json --size 900x600",
                               "xdotool mousemove 330 40; sleep 0.3; keys h; titled '[[]probe mode[]]'\nkeys ctrl+q"),
            0)
      << log();
  EXPECT_EQ(test::read_file(folder_ / "ball.json").find("chain"), std::string::npos);
}

TEST_F(ViewerHapticBinding, ASceneOfADataFileIsSavedInTheCurrentFolder) {
  std::filesystem::create_directory(folder_ / "data");
  ASSERT_EQ(test::run_catena({"generate", "gaussian", "-o", folder_ / "data/g.vdb", "--resolution", "16"}).exit_code, 0);
  ASSERT_EQ(
      test::drive_window(folder_, "data/g.vdb --size 900x600", "keys o ctrl+s; sleep 0.5; keys Return; written g.vdb.json\nkeys ctrl+q"), 0)
      << log();
  EXPECT_EQ(log().find("never"), std::string::npos) << log();
  EXPECT_FALSE(test::exists(folder_ / "data/g.vdb.json"));
  EXPECT_NE(test::read_file(folder_ / "g.vdb.json").find("data/g.vdb"), std::string::npos) << "named from where the scene is";
}

}  // namespace viewer_haptic_binding_test
}  // namespace catena::app
