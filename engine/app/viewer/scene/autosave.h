// SPDX-License-Identifier: MIT
/// Autosave: keeps the current text of the scene in a file while there are unsaved changes, so that they survive a killed program. The file
/// SCENE.json.unsaved-<12 hex digits> is next to the scene; for a data file whose scene was never saved it is in the user's own folder
/// (state_folder() in file_browser.h, unsaved/<hash of the path>-SCENE.json.unsaved-...), so that nothing is written next to data without
/// being asked. It is written atomically, readable by its owner only, and locked (flock) while its program runs: an unlocked file is
/// orphaned. Frame thread.
#pragma once
#include <cstdint>
#include <optional>
#include <string>

#include "engine/base/result.h"

namespace catena::app {

/// Owns the autosave file of one scene and the lock on it.
class Autosave {
 public:
  Autosave() = default;
  ~Autosave();  ///< Leaves the file.
  Autosave(const Autosave&) = delete;
  Autosave& operator=(const Autosave&) = delete;

  /// Writes the text if it differs from the last one. If the scene's path has changed, the file of the former scene is removed. An Error if
  /// it cannot be written.
  Outcome save_text(const std::string& scene_path, const std::string& text);
  /// Removes the file: the changes were saved or discarded.
  void remove();

 private:
  std::string scene_path_, path_, text_;  ///< An empty path_ means that there is no file.
  int lock_ = -1;
};

/// An autosave file whose program has ended.
struct OrphanedAutosave {
  std::string path, text;
  std::int64_t saved_at_s = 0;  ///< Modification time, seconds of the system clock.
};
/// Returns the newest file of the current user for that scene; nothing if there is none. Symbolic links and non-regular files are ignored.
std::optional<OrphanedAutosave> find_orphaned_autosave(const std::string& scene_path);
/// Deletes the file.
void remove_orphaned_autosave(const OrphanedAutosave& draft);

}  // namespace catena::app
