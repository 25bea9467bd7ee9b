/// The one way in which panels edit the scene: an edit is noted, with the words that the menu of undo has for it, and done when the
/// interface of this frame has been made. Until then nothing that a panel refers to changes: every edit reads the scene again. An edit
/// that is not possible is said in one line and changes nothing. Pointers are RFC 6901, values JSON text (engine/scene/to_json.h).
///   context.edits.set("/isosurfaces/0/opacity", scene::text_of(0.4), "opacity");   // a step of undo of its own
///   context.edits.drag("/isosurfaces/0/level", scene::text_of(0.4), "isolevel");   // one step until the pointer is pressed again
///   context.edits.remove("/isosurfaces/0/opacity", "opacity");
/// Frame thread.
#pragma once
#include <string>

#include "engine/app/viewer/input/commands.h"

namespace catena::app {

/// A number that is being typed: taken when the person is done, for a surface that follows each digit would jump under the hand.
struct TypedInput {
  std::string pointer;
  Vec3 values{0.0};          ///< of a single one the first
  int last_typed_frame = 0;  ///< when they were last typed at
};

/// What lasts from frame to frame.
struct EditState {
  int gesture = 0;  ///< counts what the pointer or the keyboard takes hold of: names drags
  TypedInput typed;
};

class Edits {
 public:
  Edits(Commands& commands, EditState& state) : commands_(commands), state_(state) {}

  void set(const std::string& pointer, const std::string& value, const std::string& what) { set(TextEdits{{pointer, value}}, what); }
  void set(TextEdits edits, const std::string& what) { commands_.push_back(Edit{std::move(edits), what}); }
  void remove(const std::string& pointer, const std::string& what) { set(TextEdits{{pointer, std::nullopt}}, what); }
  void drag(const std::string& pointer, const std::string& value, const std::string& what) { drag(TextEdits{{pointer, value}}, what); }
  void drag(TextEdits edits, const std::string& what) {
    commands_.push_back(Edit{std::move(edits), what, what + " " + std::to_string(state_.gesture)});
  }

  /// A link that lies on that item (feel.h).
  void bind_haptics(const std::string& item) { commands_.push_back(BindHaptics{item}); }

  /// An item of a list, with what hangs on it (removal.h).
  void remove_item(const std::string& item, const std::string& what) { commands_.push_back(RemoveItem{item, what}); }

  EditState& state() { return state_; }

 private:
  Commands& commands_;
  EditState& state_;
};

}  // namespace catena::app
