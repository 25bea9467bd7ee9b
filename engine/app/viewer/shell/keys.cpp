#include "engine/app/viewer/shell/keys.h"

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>

#include <algorithm>
#include <optional>
#include <utility>

#include "engine/app/viewer/shell/controls.h"

namespace catena::app {

namespace {

std::optional<Command> command_of(int key, bool control, bool shift) {
  if (key == GLFW_KEY_F11) return Command::full_screen;
  if (key == GLFW_KEY_F12) return shift ? Command::window_screenshot : Command::screenshot;
  if (key == GLFW_KEY_TAB) return Command::toggle_panels;
  if (key == GLFW_KEY_T && !control) return Command::turntable;
  if (key == GLFW_KEY_V && !control) return Command::fly;
  if (!control) return std::nullopt;
  if (key == GLFW_KEY_Z) return shift ? Command::redo : Command::undo;
  if (key == GLFW_KEY_Y) return Command::redo;
  if (key == GLFW_KEY_S) return shift ? Command::save_as : Command::save;
  if (key == GLFW_KEY_O) return Command::open;
  if (key == GLFW_KEY_Q) return Command::quit;
  return std::nullopt;
}

bool is_fly_key(int key) {
  constexpr int kKeys[] = {GLFW_KEY_W, GLFW_KEY_A,    GLFW_KEY_S,     GLFW_KEY_D,  GLFW_KEY_E,
                           GLFW_KEY_Q, GLFW_KEY_LEFT, GLFW_KEY_RIGHT, GLFW_KEY_UP, GLFW_KEY_DOWN};
  return std::ranges::find(kKeys, key) != std::end(kKeys);
}

bool is_modifier(int key) { return key >= GLFW_KEY_LEFT_SHIFT && key <= GLFW_KEY_RIGHT_SUPER; }

/// A key that makes text; the others come after GLFW_KEY_ESCAPE.
bool makes_text(const KeyEvent& event) { return event.key < GLFW_KEY_ESCAPE && !event.control && !event.alt; }

}  // namespace

void interpret(const KeyEvent& event, bool fly, Input& input) {
  if (event.what == KeyEvent::What::character && event.character == U'?') input.help = true;
  if (event.what != KeyEvent::What::press) return;
  if (const auto command = command_of(event.key, event.control, event.shift)) return input.commands.push_back(*command);
  if (event.control || (fly && is_fly_key(event.key))) return;
  if (event.key >= GLFW_KEY_1 && event.key <= GLFW_KEY_3) input.axis = event.key - GLFW_KEY_1;
  constexpr std::pair<int, bool Input::*> kAsks[] = {{GLFW_KEY_H, &Input::toggle_hand},   {GLFW_KEY_F, &Input::toggle_forces},
                                                     {GLFW_KEY_R, &Input::reset_view},    {GLFW_KEY_A, &Input::fit},
                                                     {GLFW_KEY_HOME, &Input::fit},        {GLFW_KEY_O, &Input::toggle_projection},
                                                     {GLFW_KEY_P, &Input::toggle_pulses}, {GLFW_KEY_F2, &Input::next_stereo},
                                                     {GLFW_KEY_F1, &Input::help},         {GLFW_KEY_ESCAPE, &Input::escape}};
  for (const auto& [key, what] : kAsks)
    if (key == event.key) input.*what = true;
}

std::vector<KeyEvent> without_repeats(const KeyEvent& event) {
  if (event.what != KeyEvent::What::repeat) return {event};
  if (event.key < GLFW_KEY_BACKSPACE || event.key > GLFW_KEY_END) return {};
  KeyEvent up = event, down = event;
  up.what = KeyEvent::What::release;
  down.what = KeyEvent::What::press;
  return {up, down};
}

bool KeyFrames::joins(const KeyEvent& event) const {
  using What = KeyEvent::What;
  switch (event.what) {
    case What::repeat:
      return true;
    case What::press:
    case What::release:
      if (std::ranges::find(changed_, event.key) != changed_.end()) return false;
      if (is_modifier(event.key)) return !strokes_;
      return event.what == What::release || (!decides_ && (makes_text(event) || !text_));
    case What::character:
      return !decides_;
    case What::focus_gained:
    case What::focus_lost:
      return changed_.empty() && !strokes_ && !decides_;
  }
  return false;
}

void KeyFrames::tell(const KeyEvent& event) {
  using What = KeyEvent::What;
  if (event.what == What::press || event.what == What::release) changed_.push_back(event.key);
  if (event.what == What::press && !is_modifier(event.key)) {
    strokes_ = true;
    decides_ = decides_ || !makes_text(event);
  }
  if (event.what == What::character) strokes_ = text_ = true;
  if (event.what == What::focus_gained || event.what == What::focus_lost) strokes_ = decides_ = true;
}

void KeyFrames::framed() {
  changed_.clear();
  strokes_ = text_ = decides_ = false;
}

}  // namespace catena::app
