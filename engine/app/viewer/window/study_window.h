/// StudyWindow is the loop of a live session's window: strokes and motion go in, the trial's picture and the pages over it come out. There
/// are no panels, no menu and no edits; the eye stands where the scene puts it. Frame thread.
#pragma once
#include <array>
#include <optional>
#include <string>
#include <vector>

#include "engine/app/study/live_session.h"
#include "engine/app/viewer/input/camera_controller.h"
#include "engine/app/viewer/scene/scene_files.h"
#include "engine/app/viewer/window/study_pages.h"
#include "engine/app/viewer/window/viewport.h"

namespace catena::app {

class StudyWindow {
 public:
  /// `options`: size and quality; `hand` has its device. `interrupt` is made where a device needs it, and outlives the hand.
  StudyWindow(const ViewOptions& options, LiveSession& session, SceneModel& scene, HapticSession& hand, Window& window,
              std::optional<InterruptHandler>& interrupt);
  ~StudyWindow();  ///< the hand is let go first
  StudyWindow(const StudyWindow&) = delete;
  StudyWindow& operator=(const StudyWindow&) = delete;

  /// Loads the first scene; the hand takes hold.
  std::optional<Failure> open();
  /// Until the session is over, or somebody closes the window.
  std::optional<Failure> run();

 private:
  bool should_continue() const;
  bool shows_image() const;
  Outcome process_input(double wait_s);
  Outcome process_key(const KeyEvent& key);
  Outcome open_next_scene();
  void show_scene(const LoadedScene& loaded);
  void move_probe(Input piece);
  void place_probe_under_pointer();
  std::optional<FrameRequest> next_frame(bool moved, bool hand_moved);
  void draw_pages();
  void update_title();

  LiveSession& session_;
  Gui gui_;
  ViewerContext context_;
  CameraController camera_;
  Viewport viewport_;
  std::optional<InterruptHandler>& interrupt_;
  bool is_closed_ = false;
  bool needs_redraw_ = true;                           ///< the picture has to be drawn anew
  bool probe_moved_ = false;                           ///< since the last picture
  Procedure::Stage last_stage_{};                      ///< that was shown last
  std::optional<std::array<double, 2>> last_pointer_;  ///< window coordinates, once it has been seen
  std::int64_t last_change_ns_ = 0;
  std::string title_;
};

}  // namespace catena::app
