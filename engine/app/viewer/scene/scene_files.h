// SPDX-License-Identifier: MIT
/// File operations of the window: opening, adding, saving and closing the scene, and autosave. Loading runs in the background; a failure is
/// reported in one line and leaves everything unchanged. Frame thread.
#pragma once
#include <functional>
#include <optional>
#include <string>

#include "engine/app/viewer/input/camera_controller.h"
#include "engine/app/viewer/scene/autosave.h"
#include "engine/app/viewer/scene/file_browser.h"
#include "engine/app/viewer/scene/scene_model.h"
#include "engine/app/viewer/window/viewer_context.h"
#include "engine/app/viewer/window/viewport.h"

namespace catena::app {

/// Returns the description of the scene for a recording: path, text, field options and input files.
RecordedScene make_recorded_scene(const SceneModel& scene, const HapticSession& hand);
/// Loads the first scene and prepares the haptic session for it. `scene` is replaced by the loaded model, which is moved out of the result.
/// `meanwhile`: called while the scene is loaded on another thread, and must not use `scene`; empty: loads on this thread. An Error if
/// loading or preparing fails.
Result<LoadedScene> load_initial_scene(SceneModel& scene, HapticSession& hand, std::uint32_t width, std::uint32_t height,
                                       const std::function<void(const LoadWait&)>& meanwhile = {});

/// Executes the file commands; holds the state of pending loads, saves and dialogs.
class SceneFiles {
 public:
  SceneFiles(ViewerContext& shared, CameraController& camera, Viewport& viewport);

  /// Call when a loaded scene has become the visible one: adopts its bounds and camera. Edits are then accepted only if the haptic program
  /// can be built.
  void adopt_scene(const LoadedScene& loaded);
  /// Initializes the list of recent files and offers the autosave of an earlier run.
  void begin();

  // Commands.
  /// Opens a file in place of the scene, after resolving unsaved changes.
  void open(const std::string& path, const std::string& grid = {}) { confirm_leave({path, grid}); }
  /// Adds what a file shows to the scene.
  void add(const std::string& path) { start_loading({path}, true); }
  /// Opens a dropped file or folder, or asks whether to add it to the scene.
  void open_dropped(const std::string& dropped);
  /// Saves to the scene's own file; without one, opens the Save As dialog.
  void save();
  /// Saves to `path`; asks first if the scene's own file was changed on disk.
  void save_as(const std::string& path);
  /// Cancels what should follow the pending save.
  void cancel_save() { after_save_.reset(); }
  void quit() { confirm_leave({}); }
  /// Choices of the dialogs.
  void on_choice(UnsavedChangesChoice choice);
  void on_choice(DroppedFileChoice choice);
  void on_choice(FileConflictChoice choice);
  void on_choice(RecoveryChoice choice);

  /// Takes over a finished load. Returns true if the image must be rendered again.
  bool poll_loaded();
  bool is_loading() const { return loader_.is_busy(); }
  /// Saves unsaved changes to the autosave file: every few seconds (3 s), or immediately if `now`, as at an exit without a dialog. A
  /// failure is reported once.
  void autosave(bool now = false);
  /// Returns whether the user has quit, with unsaved changes resolved.
  bool has_quit() const { return has_quit_; }

 private:
  void confirm_leave(const PendingLeave& leaving);
  void leave(const PendingLeave& leaving);
  void save_and_continue(const std::string& path);
  bool write(const std::string& path);
  void start_loading(const PendingLeave& file, bool to_current_scene);
  void replace_scene(LoadedScene loaded, const std::string& path);
  void add_to_scene(LoadedScene loaded, const std::string& path);
  void offer_recovery();
  void add_to_recent(const std::string& path);

  ViewerContext& context_;
  CameraController& camera_;
  Viewport& viewport_;
  RecentFiles recent_files_;
  SceneLoader loader_;
  bool loading_joins_scene_ = false;        ///< The file being loaded is added to the scene.
  std::optional<PendingLeave> after_save_;  ///< Action to continue with after a successful save.
  bool has_quit_ = false;
  Autosave autosave_;
  std::int64_t last_autosave_ns_ = 0;
  std::string autosave_error_;  ///< Last reported failure; empty: none.
};

}  // namespace catena::app
