/// Autosave keeps unsaved work: the scene's text as it is now, in a file while it has changes that are not saved, so that it outlives a
/// program that is killed. SCENE.json.unsaved-<12 hex digits> lies beside the scene; of a data file whose scene was never saved it lies in
/// the user's own folder (state_folder() in file_list.h, unsaved/<hash of the place>-SCENE.json.unsaved-...), so that nothing is written
/// beside data unasked. It is written whole or not at all, is its owner's alone, and is locked (flock) while its program runs: what is
/// found unlocked was left by one that has ended. Frame thread.
#pragma once
#include <cstdint>
#include <optional>
#include <string>

#include "engine/base/result.h"

namespace catena::app {

class Autosave {
 public:
  Autosave() = default;
  ~Autosave();  ///< the file stays
  Autosave(const Autosave&) = delete;
  Autosave& operator=(const Autosave&) = delete;

  /// The text is on its way to the disk; the same text twice is written once. Of another scene than before: the one before goes.
  Outcome save_text(const std::string& scene_path, const std::string& text);
  /// Saved, or given up by the person.
  void remove();

 private:
  std::string scene_path_, path_, text_;  ///< path_ empty: nothing is kept
  int lock_ = -1;
};

/// What a program that has ended left of a scene.
struct OrphanedAutosave {
  std::string path, text;
  std::int64_t saved_at_s = 0;  ///< when it was kept, seconds of the system's clock
};
/// The newest of this user's own; none: nothing is there. Links and what is no regular file do not count.
std::optional<OrphanedAutosave> find_orphaned_autosave(const std::string& scene_path);
void remove_orphaned_autosave(const OrphanedAutosave& draft);

}  // namespace catena::app
