/// Session is the loop of one open window, again and again: input -> newest haptic state -> picture -> interface. It reads strokes and
/// carries out commands; files are in scene_files.h, the picture in picture_view.h, the eye in eye.h. Frame thread.
#pragma once
#include <optional>
#include <string>

#include "engine/app/haptics/signal_handlers.h"
#include "engine/app/viewer/edit/scene_items.h"
#include "engine/app/viewer/input/camera_controller.h"
#include "engine/app/viewer/input/tracked_head.h"
#include "engine/app/viewer/scene/scene_files.h"
#include "engine/app/viewer/scene/time_step_watcher.h"
#include "engine/app/viewer/window/progressive_scheduler.h"
#include "engine/app/viewer/window/viewer_context.h"
#include "engine/app/viewer/window/viewport.h"

namespace catena::app {

class Session {
 public:
  /// `head`: where one is tracked. `hand` has its device; `scene` is read, and not loaded yet. `interrupt` is made where a device needs it,
  /// and outlives the hand.
  Session(const ViewOptions& options, SceneModel& scene, HapticSession& hand, Window& window, std::optional<ShaderReload> reload,
          std::unique_ptr<TrackedHead> head, std::optional<InterruptHandler>& interrupt);
  ~Session();  ///< the hand is let go first
  Session(const Session&) = delete;
  Session& operator=(const Session&) = delete;

  std::optional<Failure> open();
  std::optional<Failure> run();

 private:
  // the loop
  bool should_continue() const;
  std::optional<FrameRequest> next_frame(bool moved, bool hand_moved);
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

  // session_input.cpp
  NavigationChanges process_input(double wait_s);
  NavigationChanges process_segment(Input piece);
  Input route_to_viewport(Input input);
  Gui::Frame make_gui_frame();

  // session_input.cpp
  void execute();
  void execute(const Command& command);
  void perform(Action action);
  void begin_probe_mode();
  void end_probe_mode();
  void bind_haptics(const std::string& item, std::optional<Vec3> at);
  void remove_item(const std::string& item, const std::string& what);
  void dismiss();

  Gui gui_;
  ViewerContext context_;
  CameraController camera_;
  std::unique_ptr<TrackedHead> head_;  ///< none: the mouse moves the eye
  render::View view_without_head_;     ///< but for where the head is
  Viewport viewport_;
  SceneFiles files_;
  TimeStepWatcher step_watcher_;
  std::optional<InterruptHandler>& interrupt_;
  WidgetEdits widget_edits_;
  BandAnimationClock band_clock_;
  bool has_animated_bands_ = false, bands_animated_ = true;
  std::int64_t start_ns_ = 0;                 ///< of the loop
  bool content_changed_ = false;              ///< a command has changed what the picture shows
  bool estimate_requested_ = false;           ///< of the picture at rest
  bool measurement_requested_ = false;        ///< what a plan goes by
  std::int64_t last_tracking_report_ns_ = 0;  ///< the hand
  bool gui_captures_pointer_ = false;         ///< the buttons that are down went down on it
  int settle_frames_ = 0;                     ///< interfaces to come though nothing happens: they settle their sizes
  std::int64_t last_title_ns_ = 0;
  int frames_at_last_title_ = 0;  ///< drawn when it was last made
};

}  // namespace catena::app
