/// Shared is what loop (session.h), files (scene_files.h), picture (picture_view.h) and eye (eye.h) work on together, and what the panels
/// read. Each of them owns its own state beside it. Frame thread.
#pragma once
#include <string>

#include "engine/app/viewer/panels/panel.h"
#include "engine/app/viewer/viewer.h"
#include "engine/app/viewer/window/gui.h"
#include "engine/base/system_failure.h"

namespace catena::app {

/// Why the program ends, in one line, and with which exit code.
struct Failure {
  int exit_code;
  std::string message;
};
/// With the exit code of the error.
inline Failure to_failure(const Error& error) { return {to_exit_code(error), error.message}; }

// what a window's loop goes by, seconds
inline constexpr double kIdleWaitS = 0.004;  ///< between looks at the servo's news when nothing else happens
inline constexpr double kMinimizedWaitS = 0.1;

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
