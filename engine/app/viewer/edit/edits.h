// SPDX-License-Identifier: MIT
/// Edits of the scene by panels. An edit is recorded with its undo label and executed after the GUI of this frame is complete; until then
/// nothing that a panel refers to changes, since every edit reads the scene again. An edit that is not possible is reported in one line and
/// changes nothing. Pointers are RFC 6901, values JSON text (engine/scene/to_json.h).
///   context.edits.set("/isosurfaces/0/opacity", scene::to_json(0.4), "opacity");   // an undo step of its own
///   context.edits.drag("/isosurfaces/0/level", scene::to_json(0.4), "isolevel");   // one undo step until the next press of the pointer
///   context.edits.remove("/isosurfaces/0/opacity", "opacity");
/// Frame thread.
#pragma once
#include <string>

#include "engine/app/viewer/input/commands.h"

namespace catena::app {

/// A number being typed; applied when the user is done, because a surface that follows every digit would jump under the probe.
struct TypedInput {
  std::string pointer;
  Vec3 values{0.0};          ///< A single number is in the first component.
  int last_typed_frame = 0;  ///< GUI frame of the last key.
};

/// State kept from frame to frame.
struct EditState {
  int gesture = 0;  ///< Counts presses of pointer or keyboard; identifies the undo group of a drag.
  TypedInput typed;
};

/// Records edits as commands. `what`: undo label.
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

  /// Adds a link that lies on that item (haptic_binding.h).
  void bind_haptics(const std::string& item) { commands_.push_back(BindHaptics{item}); }

  /// Removes an item of a list with everything that refers to it (remove_item.h).
  void remove_item(const std::string& item, const std::string& what) { commands_.push_back(RemoveItem{item, what}); }

  EditState& state() { return state_; }

 private:
  Commands& commands_;
  EditState& state_;
};

}  // namespace catena::app
