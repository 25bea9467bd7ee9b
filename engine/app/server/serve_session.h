// SPDX-License-Identifier: MIT
/// ServeSession is the main loop of `catena serve`: requests of the pages -> newest haptic state -> frame -> pages. Frame thread.
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

/// One session for all pages. One page at a time is in control; requests of the others are ignored.
class ServeSession {
 public:
  /// `scene` is loaded, `hand` has an open device and is started before run(). All arguments except `loaded` must outlive this object.
  ServeSession(const ServeOptions& options, const LoadedScene& loaded, SceneModel& scene, HapticSession& hand, http::Server& server,
               FrameEncoder& maker, const InterruptHandler& interrupt);
  /// Runs until interrupted or until the time limit.
  Outcome run();

 private:
  bool is_running() const;
  // Pages.
  void on_message(const http::ViewerEvent& event);
  void on_connect(http::ViewerId viewer);
  void on_disconnect(http::ViewerId viewer);
  void give_control_to(http::ViewerId viewer);
  // Requests of the page in control.
  void handle(const MoveRequest& request);
  void handle(const SizeRequest& request);
  void handle(Action action);
  void handle(const LevelRequest& request);
  void handle(const OpacityRequest& request);
  void handle(const ColormapRequest& request);
  void handle(const StepRequest& request);
  void handle(const RecordRequest& request);
  void handle(const TuningRequest& request);
  void end_recording();
  void start_haptics();
  void stop_haptics();
  void apply_edits(const TextEdits& edits, const std::string& what, const std::string& item);
  // Messages to the pages.
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
  std::vector<http::ViewerId> viewers_;  ///< In the order in which they connected
  http::ViewerId controller_ = 0;        ///< The viewer in control; 0: none
  std::size_t max_viewers_ = 0;
  std::uint32_t width_, height_;
  double pointer_x_ = 0.5, pointer_y_ = 0.5;       ///< Fractions of the image's width and height
  std::uint32_t input_number_ = 0;                 ///< Number of the newest input
  bool has_changed_ = true, probe_moved_ = false;  ///< Since the last frame
  bool sent_lossless_ = false;                     ///< The last frame was also sent lossless
  bool scene_sent_ = false;
  std::string last_frame_, last_state_;
  std::int64_t start_ns_ = 0, last_state_ns_ = 0, last_scene_ns_ = 0, last_frame_ns_ = 0;
};

}  // namespace catena::app
