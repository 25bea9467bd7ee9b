// SPDX-License-Identifier: MIT
// Binding of haptics in a real window: a scene without a chain, the pointer on the surface, the key H, and the wheel.
#include <filesystem>

#include "tests/engine/app/program_runs.h"
#include "tests/engine/app/window_fixture.h"

namespace catena::app::viewer_haptic_binding_test {

class ViewerHapticBinding : public test::DrivenWindow {
 protected:
  ViewerHapticBinding() {
    test::write_file(folder_ / "ball.json", R"({"fields": {"d": {"analytic": "sphere", "resolution": 24}},
      "isosurfaces": [{"field": "d", "level": 1}], "camera": {"position": [0, -6, 0], "target": [0, 0, 0]}})");
  }
};

TEST_F(ViewerHapticBinding, HPlacesTheProbeUnderThePointerAndTheWheelPushes) {
  // The center of the image: the panels take the left 320 pixels.
  play("ball.json --size 900x600",
       "xdotool mousemove 610 310; sleep 0.3; keys h; titled ' N  isosurface .*[[]probe mode[]]'\n"
       "for i in 1 2 3 4; do xdotool click 4; sleep 0.1; done; titled ' [1-9][.][0-9]* N  isosurface OK'\n"
       // Over a panel, the pointer does not move the probe.
       "xdotool mousemove 100 450; sleep 0.3; for i in 1 2 3 4 5 6 7 8; do xdotool click 5; done; sleep 0.5\n"
       "titled ' [1-9][.][0-9]* N  isosurface OK'; keys Escape; sleep 0.5; keys ctrl+s ctrl+q");
  EXPECT_NE(log().find("force 0 N"), std::string::npos) << "nothing holds the mouse after probe mode\n" << log();
  const std::string saved = test::read_file(folder_ / "ball.json");
  EXPECT_NE(saved.find(R"("type": "isosurface", "field": "d", "level": 1, "free": "above")"), std::string::npos) << saved;
}

TEST_F(ViewerHapticBinding, WithoutAnObjectUnderThePointerTheSceneIsUnchanged) {
  play("ball.json --size 900x600", "xdotool mousemove 330 40; sleep 0.3; keys h; titled '[[]probe mode[]]'\nkeys ctrl+q");
  EXPECT_EQ(test::read_file(folder_ / "ball.json").find("chain"), std::string::npos);
}

TEST_F(ViewerHapticBinding, ASceneOfADataFileIsSavedInTheCurrentFolder) {
  std::filesystem::create_directory(folder_ / "data");
  test::run_ok({"generate", "gaussian", "-o", folder_ / "data/g.vdb", "--resolution", "16"});
  play("data/g.vdb --size 900x600", "keys o ctrl+s; sleep 0.5; keys Return; written g.vdb.json\nkeys ctrl+q");
  EXPECT_FALSE(test::exists(folder_ / "data/g.vdb.json"));
  EXPECT_NE(test::read_file(folder_ / "g.vdb.json").find("data/g.vdb"), std::string::npos) << "named from where the scene is";
}

}  // namespace catena::app::viewer_haptic_binding_test
