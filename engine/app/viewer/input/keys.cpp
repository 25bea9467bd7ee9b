// SPDX-License-Identifier: MIT
#include "engine/app/viewer/input/keys.h"

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>

#include <algorithm>

namespace catena::app {

namespace {

bool is_modifier(int key) { return key >= GLFW_KEY_LEFT_SHIFT && key <= GLFW_KEY_RIGHT_SUPER; }

/// Returns whether the key produces text; key numbers from GLFW_KEY_ESCAPE on do not.
bool makes_text(const KeyEvent& event) { return event.key < GLFW_KEY_ESCAPE && !event.control && !event.alt; }

}  // namespace

std::vector<KeyEvent> resolve_repeats(const KeyEvent& event) {
  if (event.type != KeyEvent::Type::repeat) return {event};
  if (event.key < GLFW_KEY_BACKSPACE || event.key > GLFW_KEY_END) return {};
  KeyEvent up = event, down = event;
  up.type = KeyEvent::Type::release;
  down.type = KeyEvent::Type::press;
  return {up, down};
}

bool KeyFrameScheduler::fits_current_frame(const KeyEvent& event) const {
  using What = KeyEvent::Type;
  switch (event.type) {
    case What::repeat:
      return true;
    case What::press:
    case What::release:
      if (std::ranges::find(changed_keys_, event.key) != changed_keys_.end()) return false;
      if (is_modifier(event.key)) return !has_strokes_;
      return event.type == What::release || (!may_move_focus_ && (makes_text(event) || !has_text_));
    case What::character:
      return !may_move_focus_;
    case What::focus_gained:
    case What::focus_lost:
      return changed_keys_.empty() && !has_strokes_ && !may_move_focus_;
  }
  return false;
}

void KeyFrameScheduler::add(const KeyEvent& event) {
  using What = KeyEvent::Type;
  if (event.type == What::press || event.type == What::release) changed_keys_.push_back(event.key);
  if (event.type == What::press && !is_modifier(event.key)) {
    has_strokes_ = true;
    may_move_focus_ = may_move_focus_ || !makes_text(event);
  }
  if (event.type == What::character) has_strokes_ = has_text_ = true;
  if (event.type == What::focus_gained || event.type == What::focus_lost) has_strokes_ = may_move_focus_ = true;
}

void KeyFrameScheduler::end_frame() {
  changed_keys_.clear();
  has_strokes_ = has_text_ = may_move_focus_ = false;
}

}  // namespace catena::app
