// SPDX-License-Identifier: MIT
/// Window of a live study session: processes key presses and probe motion, and shows the image of the trial with its pages. No panels, menu
/// or edits; the camera is fixed by the scene. Frame thread.
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

/// Loop of the window.
class StudyWindow {
 public:
  /// `options`: size and quality; `hand` has its device open. `interrupt` is created if the device needs it, and must outlive the haptic
  /// session.
  StudyWindow(const ViewOptions& options, LiveSession& session, SceneModel& scene, HapticSession& hand, Window& window,
              std::optional<InterruptHandler>& interrupt);
  ~StudyWindow();  ///< Stops the servo first.
  StudyWindow(const StudyWindow&) = delete;
  StudyWindow& operator=(const StudyWindow&) = delete;

  /// Loads the first scene, opens the viewport and starts the servo. Returns the failure, if any.
  std::optional<Failure> open();
  /// Runs until the session is finished or the window is closed. Returns the failure, if any.
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
  std::optional<FrameRequest> next_frame(bool moved, bool probe_moved);
  void draw_pages();
  void update_title();

  LiveSession& session_;
  Gui gui_;
  ViewerContext context_;
  CameraController camera_;
  Viewport viewport_;
  std::optional<InterruptHandler>& interrupt_;
  bool is_closed_ = false;
  bool needs_redraw_ = true;                           ///< The image must be rendered again.
  bool probe_moved_ = false;                           ///< Since the last frame.
  Procedure::Stage last_stage_{};                      ///< The stage shown last.
  std::optional<std::array<double, 2>> last_pointer_;  ///< Window coordinates; empty until the pointer has been seen.
  std::int64_t last_change_ns_ = 0;
  std::string title_;
};

}  // namespace catena::app
