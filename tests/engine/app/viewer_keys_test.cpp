// SPDX-License-Identifier: MIT
// Keystrokes faster than frames: none is lost or reordered, and the interface never sees a modifier change within one frame.
#include "tests/engine/app/window_fixture.h"

namespace catena::app::viewer_keys_test {

constexpr const char* kScene = R"({
  "fields": {"d": {"analytic": "gaussian", "resolution": 64}},
  "volumes": [{"field": "d"}],
  "chain": [{"name": "p", "type": "point", "position": [0, 0, 0]}],
  "background": [0, 0.3, 0] })";

class ViewerKeys : public test::DrivenWindow {
 protected:
  ViewerKeys() {
    test::write_file(folder_ / "slow.json", kScene);
    test::write_file(folder_ / "Capital.json", R"({"fields": {}})");
  }
};

TEST_F(ViewerKeys, FastOverlappingKeystrokesDoNotCrash) {
  // Overlapping keystrokes, as in fast typing: the next key is pressed before the last modifier is released.
  play("slow.json --size 900x600",
       "for i in $(seq 40); do\n"
       "  xdotool key ctrl+o; xdotool key --delay 0 ctrl+a\n"
       "  xdotool type --delay 1 'ABCDEFGhijKLM'\n"
       "  xdotool keydown ctrl keydown shift keydown a keyup ctrl keyup a keyup shift keydown B keyup B\n"
       "  xdotool key --delay 0 ctrl+shift+Left Escape\n"
       "  kill -0 $V || break\n"
       "done\nkeys ctrl+q");
}

TEST_F(ViewerKeys, FastInputIsReadInOrder) {
  // There is no pause between the command that opens the dialog, the name, and Return. The H before is a command, those in the name are
  // not. GLFW merges keystrokes of one key within a millisecond.
  play("slow.json --size 900x600",
       "xdotool key --delay 0 h ctrl+o; xdotool type --delay 0 'XXh'; xdotool key --delay 12 BackSpace BackSpace BackSpace\n"
       "xdotool type --delay 0 'Capital.json'; xdotool key --delay 0 Return\n"
       "titled 'Capital.json.*[[]probe mode[]]'\nkeys ctrl+q");
}

}  // namespace catena::app::viewer_keys_test
