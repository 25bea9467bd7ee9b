#include "engine/app/viewer/shell/keys.h"

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>

#include <algorithm>

namespace catena::app {

namespace {

bool is_modifier(int key) { return key >= GLFW_KEY_LEFT_SHIFT && key <= GLFW_KEY_RIGHT_SUPER; }

/// A key that makes text; the others come after GLFW_KEY_ESCAPE.
bool makes_text(const KeyEvent& event) { return event.key < GLFW_KEY_ESCAPE && !event.control && !event.alt; }

}  // namespace

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
