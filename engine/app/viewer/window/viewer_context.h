// SPDX-License-Identifier: MIT
/// State shared by the parts of a window: loop (session.h), files (scene_files.h), viewport (viewport.h), camera (camera_controller.h), and
/// read by the panels. Each part also has state of its own. Frame thread.
#pragma once
#include <string>

#include "engine/app/viewer/panels/panel.h"
#include "engine/app/viewer/viewer.h"
#include "engine/app/viewer/window/gui.h"
#include "engine/base/system_failure.h"

namespace catena::app {

/// The reason why the program ends, in one line, and its exit code.
struct Failure {
  int exit_code;
  std::string message;
};
/// Returns the failure for an error, with its exit code.
inline Failure to_failure(const Error& error) { return {to_exit_code(error), error.message}; }

// Timing of the window's loop, seconds.
inline constexpr double kIdleWaitS = 0.004;  ///< Interval of polling the servo when nothing else happens.
/// Interval of the loop while the window is minimized.
inline constexpr double kMinimizedWaitS = 0.1;

/// References to what the loop owns, and the shared state.
struct ViewerContext {
  const ViewOptions& options;
  SceneModel& scene;
  HapticSession& haptic_session;
  Window& window;
  Gui& gui;
  ProgressiveScheduler scheduler{options.quality};
  LiveTuning tuning = options.tuning;
  Navigation navigation{};
  FrameTimes frame_times{};
  ViewState state{};
  Commands commands{};
};

}  // namespace catena::app
