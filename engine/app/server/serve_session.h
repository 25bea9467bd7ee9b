/// ServeSession is the loop of `catena serve`: what pages ask for -> newest haptic state -> picture -> pages. Frame thread.
#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "engine/app/haptics/signal_handlers.h"
#include "engine/app/server/frame_encoder.h"
#include "engine/app/server/requests.h"
#include "engine/app/server/serve.h"
#include "engine/app/server/served_recording.h"
#include "engine/app/viewer/edit/scene_items.h"
#include "engine/app/viewer/input/camera_controller.h"
#include "engine/app/viewer/scene/time_playback.h"
#include "engine/app/viewer/scene/time_step_watcher.h"
#include "engine/app/viewer/window/live_tuning.h"

namespace catena::app {

class ServeSession {
 public:
  /// `scene` is loaded, `hand` prepared and not started; all outlive the session.
  ServeSession(const ServeOptions& options, const LoadedScene& loaded, SceneModel& scene, HapticSession& hand, http::Server& server,
               FrameEncoder& maker, const InterruptHandler& interrupt);
  Outcome run();

 private:
  bool is_running() const;
  // pages
  void on_message(const http::ViewerEvent& news);
  void on_connect(http::ViewerId viewer);
  void on_disconnect(http::ViewerId viewer);
  void give_control_to(http::ViewerId viewer);
  // what the page that has the hand asks for
  void handle(const MoveRequest& wish);
  void handle(const SizeRequest& wish);
  void handle(Action action);
  void handle(const LevelRequest& wish);
  void handle(const OpacityRequest& wish);
  void handle(const ColormapRequest& wish);
  void handle(const StepRequest& wish);
  void handle(const RecordRequest& wish);
  void handle(const TuningRequest& wish);
  void end_recording();
  void start_haptics();
  void stop_haptics();
  void apply_edits(const TextEdits& edits, const std::string& what, const std::string& item);
  // what pages are told
  void send_roles();
  void send_state();
  void send_note(const std::string& line);
  void send_note_on_error(const Outcome& outcome);
  Outcome apply_stated_targets();
  Outcome measure_image();
  Outcome show_next_frame();
  Outcome send_frame(bool exact);

  const ServeOptions& options_;
  SceneModel& scene_;
  HapticSession& haptics_;
  http::Server& server_;
  FrameEncoder& encoder_;
  const InterruptHandler& interrupt_;
  ProgressiveScheduler scheduler_;
  Navigation controls_;
  FrameBuilder frame_builder_;
  CameraController camera_;
  FrameTimes frame_times_;
  HistogramCache field_values_;
  WidgetEdits widget_edits_;
  TimePlayback playback_;
  TimeStepWatcher step_follower_;
  LiveTuning tuning_;
  ServedRecording recording_;
  std::vector<http::ViewerId> viewers_;  ///< in the order in which they came
  http::ViewerId controller_ = 0;        ///< of the hand; 0: it is free
  std::size_t max_viewers_ = 0;
  std::uint32_t width_, height_;
  double pointer_x_ = 0.5, pointer_y_ = 0.5;       ///< shares of the picture
  std::uint32_t input_number_ = 0;                 ///< number of the newest one
  bool has_changed_ = true, probe_moved_ = false;  ///< since the last picture
  bool sent_lossless_ = false;                     ///< the pages have the last picture as it is
  bool scene_sent_ = false;
  std::string last_frame_, last_state_;
  std::int64_t start_ns_ = 0, last_state_ns_ = 0, last_scene_ns_ = 0, last_frame_ns_ = 0;
};

}  // namespace catena::app
