/// SceneFiles opens, adds to, saves and leaves the scene, and keeps what is not saved. What takes long runs beside the window;
/// what fails is said in one line and leaves all as it was. Frame thread.
#pragma once
#include <optional>
#include <string>

#include "engine/app/viewer/input/camera_controller.h"
#include "engine/app/viewer/scene/autosave.h"
#include "engine/app/viewer/scene/file_browser.h"
#include "engine/app/viewer/scene/scene_model.h"
#include "engine/app/viewer/window/viewer_context.h"
#include "engine/app/viewer/window/viewport.h"

namespace catena::app {

/// What a recording says of the scene that is felt.
RecordedScene make_recorded_scene(const SceneModel& scene, const HapticSession& hand);
/// Loads what the first scene draws and feels; the hand takes hold. `scene` is the host of the answer again.
Result<LoadedScene> load_initial_scene(SceneModel& scene, HapticSession& hand, std::uint32_t width, std::uint32_t height);

class SceneFiles {
 public:
  SceneFiles(ViewerContext& shared, CameraController& eye, Viewport& picture);

  /// The scene has just become the one that is shown. From now on an edit counts if the hand can feel what it makes.
  void adopt_scene(const LoadedScene& loaded);
  /// The list of recent files begins, and what an earlier run left unsaved is offered.
  void begin();

  // commands
  void open(const std::string& path) { confirm_leave({path}); }
  void open_dropped(const std::string& dropped);
  void save();
  void save_as(const std::string& path);
  void cancel_save() { after_save_.reset(); }
  void quit() { confirm_leave({}); }
  void on_choice(UnsavedChangesChoice given);
  void on_choice(DroppedFileChoice given);
  void on_choice(FileConflictChoice given);
  void on_choice(RecoveryChoice given);

  /// What was being opened is there; true: the picture has to be made again.
  bool poll_loaded();
  bool is_loading() const { return loader_.is_busy(); }
  /// Every few seconds, beside the scene, and (`now`) at the end where nobody was asked. What cannot be kept is said once.
  void autosave(bool now = false);
  /// The person has quit, and was asked where something would be lost.
  bool has_quit() const { return has_quit_; }

 private:
  void confirm_leave(const PendingLeave& leaving);
  void leave(const PendingLeave& leaving);
  void save_and_continue(const std::string& path);
  bool write(const std::string& path);
  void start_loading(const std::string& path, bool adds);
  void replace_scene(LoadedScene loaded, const std::string& path);
  void add_to_scene(LoadedScene loaded, const std::string& path);
  void offer_recovery();
  void add_to_recent(const std::string& path);

  ViewerContext& context_;
  CameraController& camera_;
  Viewport& viewport_;
  RecentFiles recent_files_;
  SceneLoader loader_;
  bool loading_joins_scene_ = false;        ///< what is being loaded joins the scene
  std::optional<PendingLeave> after_save_;  ///< what a save that succeeds goes on with
  bool has_quit_ = false;
  Autosave autosave_;  ///< what is not saved
  std::int64_t last_autosave_ns_ = 0;
  std::string autosave_error_;  ///< why, as it was said
};

}  // namespace catena::app
