/// This file describes what the keyboard did, as plain data, and says which strokes the interface may be told at once. What a stroke asks
/// of the program is in commands.h. Frame thread.
#pragma once
#include <cstdint>
#include <vector>

namespace catena::app {

struct KeyEvent {
  enum class Type : std::uint8_t { press, release, repeat, character, focus_gained, focus_lost };
  Type type = Type::press;
  int key = 0;  ///< GLFW's number; 0 for a character and the focus
  int scancode = 0;
  bool shift = false, control = false, alt = false;  ///< held
  std::uint32_t character = 0;                       ///< Unicode
};

/// A key that is held repeats as the person's system says; as presses and releases: none but for a key that moves or removes text, so that
/// a Return that is held answers one question and not the next.
std::vector<KeyEvent> resolve_repeats(const KeyEvent& event);

/// An interface that is made frame by frame knows keys only as they are when a frame begins. Strokes that come faster than frames therefore
/// need several frames, and this says where one has to be made so that no stroke is lost and each is read with its own modifiers:
///   a key changes at most once between two frames (a short stroke is down in one frame and up in a later one);
///   a modifier never changes in a frame after a stroke that was made without the change;
///   after a key that is no text (Return, Escape, Tab, an arrow, a shortcut) a frame is made before the next stroke: it may have opened or
///   closed something, and within a frame the interface reads text first.
class KeyFrameScheduler {
 public:
  /// The event may be told before the next frame, together with what was told since the last one.
  bool fits_current_frame(const KeyEvent& event) const;
  void add(const KeyEvent& event);
  /// Something was told since the last frame.
  bool has_pending() const { return !changed_keys_.empty() || has_strokes_; }
  /// A frame has been made.
  void end_frame();

 private:
  std::vector<int> changed_keys_;  ///< keys
  bool has_strokes_ = false;       ///< a key that is no modifier went down, or text came
  bool has_text_ = false;          ///< text came
  bool may_move_focus_ = false;    ///< what was told may change who reads the next stroke
};

}  // namespace catena::app
