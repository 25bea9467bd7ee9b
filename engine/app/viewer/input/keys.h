// SPDX-License-Identifier: MIT
/// Key events as plain data, and the rules by which they are distributed to GUI frames. The actions of key presses are in commands.h. Frame
/// thread.
#pragma once
#include <cstdint>
#include <vector>

namespace catena::app {

/// A key, character or focus event.
struct KeyEvent {
  enum class Type : std::uint8_t { press, release, repeat, character, focus_gained, focus_lost };
  Type type = Type::press;
  int key = 0;  ///< GLFW key code; 0 for character and focus events.
  int scancode = 0;
  bool shift = false, control = false, alt = false;  ///< Modifiers held.
  std::uint32_t character = 0;                       ///< Unicode code point.
};

/// Resolves a repeat event as sent by the system: to release and press for keys that move in or delete text, to nothing for other keys, so
/// that a held Return does not answer the next dialog. Other events are returned unchanged.
std::vector<KeyEvent> resolve_repeats(const KeyEvent& event);

/// Key frame scheduler: decides which GUI frame gets which key event. A frame-based GUI sees only the state of keys at the start of a
/// frame, so key presses faster than frames need several frames. A new frame is required such that no key press is lost and each is read
/// with its own modifiers:
///   a key changes at most one time between two frames (a short key press is down in one frame and up in a later one);
///   a modifier never changes in a frame after a key press that was made without the change;
///   after a key that is not text (Return, Escape, Tab, an arrow, a shortcut) a frame is run before the next key press: it may have opened
///   or closed something, and within a frame the GUI reads text first.
class KeyFrameScheduler {
 public:
  /// Returns whether the event can be sent before the next frame, together with those sent since the last one.
  bool fits_current_frame(const KeyEvent& event) const;
  /// Records that the event was sent.
  void add(const KeyEvent& event);
  /// Returns whether anything was sent since the last frame.
  bool has_pending() const { return !changed_keys_.empty() || has_strokes_; }
  /// Records that a frame was run.
  void end_frame();

 private:
  std::vector<int> changed_keys_;  ///< Keys that changed since the last frame.
  bool has_strokes_ = false;       ///< A non-modifier key was pressed, or text was sent.
  bool has_text_ = false;          ///< Text was sent.
  bool may_move_focus_ = false;    ///< An event may have changed which widget reads the next key press.
};

}  // namespace catena::app
