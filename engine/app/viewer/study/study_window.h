/// StudyWindow is the loop of a live session's window: strokes and motion go in, the trial's picture and the pages over it come out. There
/// are no panels, no menu and no edits; the eye stands where the scene puts it. Frame thread.
#pragma once
#include <array>
#include <optional>
#include <string>
#include <vector>

#include "engine/app/study/live_session.h"
#include "engine/app/viewer/shell/eye.h"
#include "engine/app/viewer/shell/picture_view.h"
#include "engine/app/viewer/shell/scene_files.h"
#include "engine/app/viewer/study/study_pages.h"

namespace catena::app {

class StudyWindow {
 public:
  /// `options`: size and quality; `hand` has its device. `interrupt` is made where a device needs it, and outlives the hand.
  StudyWindow(const ViewOptions& options, LiveSession& session, SceneHost& scene, HandHost& hand, Window& window,
              std::optional<Interrupt>& interrupt);
  ~StudyWindow();  ///< the hand is let go first
  StudyWindow(const StudyWindow&) = delete;
  StudyWindow& operator=(const StudyWindow&) = delete;

  /// Loads the first scene; the hand takes hold.
  std::optional<Failure> open();
  /// Until the session is over, or somebody closes the window.
  std::optional<Failure> run();

 private:
  bool goes_on() const;
  bool shows_picture() const;
  Outcome take_input(double wait_s);
  Outcome take_key(const KeyEvent& key);
  Outcome open_next();
  void show_scene(const LoadedScene& loaded);
  void move_hand(Input piece);
  void put_hand_under_pointer();
  std::optional<NextPicture> next_picture(bool moved, bool hand_moved);
  void draw_pages();
  void update_title();

  LiveSession& session_;
  Gui gui_;
  Shared shared_;
  Eye eye_;
  PictureView picture_;
  std::optional<Interrupt>& interrupt_;
  bool closed_ = false;
  bool moved_ = true;                             ///< the picture has to be drawn anew
  bool hand_moved_ = false;                       ///< since the last picture
  Procedure::Stage stage_{};                      ///< that was shown last
  std::optional<std::array<double, 2>> pointer_;  ///< window coordinates, once it has been seen
  std::int64_t last_change_ns_ = 0;
  std::string title_;
};

}  // namespace catena::app
