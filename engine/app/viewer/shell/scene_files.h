/// SceneFiles opens, adds to, saves and leaves the scene, and keeps what is not saved. What takes long runs beside the window;
/// what fails is said in one line and leaves all as it was. Frame thread.
#pragma once
#include <optional>
#include <string>

#include "engine/app/viewer/shell/draft.h"
#include "engine/app/viewer/shell/eye.h"
#include "engine/app/viewer/shell/file_list.h"
#include "engine/app/viewer/shell/picture_view.h"
#include "engine/app/viewer/shell/scene_host.h"
#include "engine/app/viewer/shell/shared.h"

namespace catena::app {

/// What a recording says of the scene that is felt.
RecordedScene recorded(const SceneHost& scene, const HandHost& hand);
/// Loads what the first scene draws and feels; the hand takes hold. `scene` is the host of the answer again.
Result<LoadedScene> load_first(SceneHost& scene, HandHost& hand, std::uint32_t width, std::uint32_t height);

class SceneFiles {
 public:
  SceneFiles(Shared& shared, Eye& eye, PictureView& picture);

  /// The scene has just become the one that is shown. From now on an edit counts if the hand can feel what it makes.
  void show(const LoadedScene& loaded);
  /// The list of recent files begins, and what an earlier run left unsaved is offered.
  void begin();

  // commands
  void open(const std::string& path) { leave_or_ask({path}); }
  void drop(const std::string& dropped);
  void save();
  void save_as(const std::string& path);
  void give_up_saving() { after_save_.reset(); }
  void quit() { leave_or_ask({}); }
  void answer(AnswerToUnsaved given);
  void answer(AnswerToDropped given);
  void answer(AnswerToChanged given);
  void answer(AnswerToLeft given);

  /// What was being opened is there; true: the picture has to be made again.
  bool take_loaded();
  bool is_loading() const { return loader_.is_busy(); }
  /// Every few seconds, beside the scene, and (`now`) at the end where nobody was asked. What cannot be kept is said once.
  void keep_unsaved(bool now = false);
  /// The person has quit, and was asked where something would be lost.
  bool has_ended() const { return ended_; }

 private:
  void leave_or_ask(const Leaving& leaving);
  void leave(const Leaving& leaving);
  void write_and_go_on(const std::string& path);
  bool write(const std::string& path);
  void start_loading(const std::string& path, bool adds);
  void replace_scene(LoadedScene loaded, const std::string& path);
  void add_to_scene(LoadedScene loaded, const std::string& path);
  void look_for_left();
  void remember(const std::string& path);

  Shared& shared_;
  Eye& eye_;
  PictureView& picture_;
  RecentFiles recent_;
  SceneLoader loader_;
  bool loading_adds_ = false;          ///< what is being loaded joins the scene
  std::optional<Leaving> after_save_;  ///< what a save that succeeds goes on with
  bool ended_ = false;
  Draft draft_;  ///< what is not saved
  std::int64_t last_kept_ns_ = 0;
  std::string not_kept_;  ///< why, as it was said
};

}  // namespace catena::app
