// SPDX-License-Identifier: MIT
// Keystrokes faster than frames: none is lost or reordered, and the interface never sees a modifier change within one frame.
#include <gtest/gtest.h>

#include "tests/support/drive_window.h"
#include "tests/support/support.h"

namespace catena::app {
namespace viewer_keys_test {

constexpr const char* kScene = R"({
  "fields": {"d": {"analytic": "gaussian", "resolution": 64}},
  "volumes": [{"field": "d"}],
  "chain": [{"name": "p", "type": "point", "position": [0, 0, 0]}],
  "background": [0, 0.3, 0] })";

class ViewerKeys : public testing::Test {
 protected:
  void SetUp() override {
    if (!test::can_drive_windows()) GTEST_SKIP() << "no Xvfb or no xdotool here";
    test::write_file(folder_ / "slow.json", kScene);
    test::write_file(folder_ / "Capital.json", R"({"fields": {}})");
  }
  std::string log() const { return test::read_file(folder_ / "log"); }
  test::TemporaryFolder folder_;
};

TEST_F(ViewerKeys, FastOverlappingKeystrokesDoNotCrash) {
  // Overlapping keystrokes, as in fast typing: the next key is pressed before the last modifier is released.
  ASSERT_EQ(test::drive_window(folder_, "slow.json --size 900x600",
                               "for i in $(seq 40); do\n"
                               "  xdotool key ctrl+o; xdotool key --delay 0 ctrl+a\n"
                               "  xdotool type --delay 1 'ABCDEFGhijKLM'\n"
                               "  xdotool keydown ctrl keydown shift keydown a keyup ctrl keyup a keyup shift keydown B keyup B\n"
                               "  xdotool key --delay 0 ctrl+shift+Left Escape\n"
                               "  kill -0 $V || break\n"
                               "done\nkeys ctrl+q"),
            0)
      << log();
}

TEST_F(ViewerKeys, FastInputIsReadInOrder) {
  // There is no pause between the command that opens the dialog, the name, and Return. The H before is a command, those in the name are
  // not. GLFW merges keystrokes of one key within a millisecond.
  ASSERT_EQ(test::drive_window(
                folder_, "slow.json --size 900x600",
                "xdotool key --delay 0 h ctrl+o; xdotool type --delay 0 'XXh'; xdotool key --delay 12 BackSpace BackSpace BackSpace\n"
                "xdotool type --delay 0 'Capital.json'; xdotool key --delay 0 Return\n"
                "titled 'Capital.json.*[[]probe mode[]]'\nkeys ctrl+q"),
            0)
      << log();
  EXPECT_EQ(log().find("never"), std::string::npos) << log();
}

}  // namespace viewer_keys_test
}  // namespace catena::app
