// SPDX-License-Identifier: MIT
/// Main loop of an open window: input -> latest haptic state -> frame -> GUI. Processes key presses and executes commands; files are in
/// scene_files.h, the image in viewport.h, the camera in camera_controller.h. Frame thread.
#pragma once
#include <optional>
#include <string>

#include "engine/app/haptics/signal_handlers.h"
#include "engine/app/viewer/edit/scene_items.h"
#include "engine/app/viewer/input/camera_controller.h"
#include "engine/app/viewer/input/tracked_head.h"
#include "engine/app/viewer/input/widget_drag.h"
#include "engine/app/viewer/scene/scene_files.h"
#include "engine/app/viewer/scene/time_step_watcher.h"
#include "engine/app/viewer/window/progressive_scheduler.h"
#include "engine/app/viewer/window/viewer_context.h"
#include "engine/app/viewer/window/viewport.h"

namespace catena::app {

/// Owns the GUI and all parts of the window.
class Session {
 public:
  /// `head`: the tracked head, or null. `hand` has its device open; `scene` has been read but not loaded. `interrupt` is created if the
  /// device needs it, and must outlive the haptic session.
  Session(const ViewOptions& options, SceneModel& scene, HapticSession& hand, Window& window, std::optional<ShaderReload> reload,
          std::unique_ptr<TrackedHead> head, std::optional<InterruptHandler>& interrupt);
  ~Session();  ///< Stops the servo first.
  Session(const Session&) = delete;
  Session& operator=(const Session&) = delete;

  /// Loads the scene and starts the servo. Returns the failure, if any.
  std::optional<Failure> open();
  /// Runs until the user quits. Returns the failure, if any.
  std::optional<Failure> run();

 private:
  // The loop.
  bool should_continue() const;
  std::optional<FrameRequest> next_frame(bool moved, bool probe_moved);
  bool process_edits();
  void store_widget_edits();
  void find_animated_bands();
  void reset_tracking_observer();
  void report_tracking_error();
  void reset_tuning();
  std::optional<Failure> measure_costs();
  bool animate_bands();
  bool update_head();
  void poll_time_steps();
  void show_time_step(int step);
  void update_title();
  PanelContext panel_context();
  std::optional<Failure> finish();
  void print_statistics();

  // Input (session_input.cpp).
  NavigationChanges process_input(double wait_s);
  NavigationChanges process_segment(Input piece);
  Input route_to_viewport(Input input);
  bool drag_widget(const Input& input, const render::Camera& camera, const std::function<std::optional<WidgetPart>()>& find);
  bool drag_window_level(const Input& input);
  std::optional<NavigationChanges> process_plane_input(const Input& input);
  Gui::Frame make_gui_frame();

  // Commands (session_input.cpp).
  void execute();
  void execute(const Command& command);
  void perform(Action action);
  void begin_probe_mode();
  void end_probe_mode();
  void explain_unfelt(const std::string& item, const Vec3& at);
  void bind_haptics(const std::string& item, std::optional<Vec3> at);
  void remove_item(const std::string& item, const std::string& what);
  void dismiss();

  Gui gui_;
  ViewerContext context_;
  CameraController camera_;
  std::unique_ptr<TrackedHead> head_;  ///< Null: the mouse moves the camera.
  render::View view_without_head_;     ///< The view apart from the position of the head.
  Viewport viewport_;
  SceneFiles files_;
  TimeStepWatcher step_watcher_;
  std::optional<InterruptHandler>& interrupt_;
  WidgetEdits widget_edits_;
  /// Widget dragged with the mouse.
  struct DraggedWidget {
    std::string name;
    WidgetDrag drag;
  };
  std::optional<DraggedWidget> dragged_widget_;
  std::optional<Viewport::PlaneAt> plane_;  ///< Plane of orthogonal views under the pointer, or in which the present drag began.
  bool plane_pressed_ = false;              ///< A button was down in the segment before.
  int window_level_drag_ = 0;               ///< Number of the press that changes the range of the colors; 0: none
  bool left_was_down_ = false;              ///< The left button was down in the segment before.
  BandAnimationClock band_clock_;
  bool has_animated_bands_ = false, bands_animated_ = true;
  std::int64_t start_ns_ = 0;                 ///< Start of the loop.
  bool content_changed_ = false;              ///< A command has changed what the image shows.
  bool estimate_requested_ = false;           ///< An error estimate of the refined frame is pending.
  bool measurement_requested_ = false;        ///< A measurement of the tuning's costs is pending.
  std::int64_t last_tracking_report_ns_ = 0;  ///< Time of the last tracking error report.
  bool gui_captures_pointer_ = false;         ///< The pressed mouse buttons were pressed on the GUI.
  int settle_frames_ = 0;                     ///< GUI frames to come without events, until sizes have settled.
  std::int64_t last_title_ns_ = 0;
};

}  // namespace catena::app
