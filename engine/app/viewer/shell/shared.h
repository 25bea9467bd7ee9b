/// Shared is what loop (session.h), files (scene_files.h), picture (picture_view.h) and eye (eye.h) work on together, and what the panels
/// read. Each of them owns its own state beside it. Frame thread.
#pragma once
#include <string>

#include "engine/app/viewer/panels/panel.h"
#include "engine/app/viewer/shell/gui.h"
#include "engine/app/viewer/viewer.h"
#include "engine/base/machine_failure.h"

namespace catena::app {

/// Why the program ends, in one line, and with which exit code.
struct Failure {
  int exit_code;
  std::string message;
};
/// With the exit code of the error.
inline Failure failure_of(const Error& error) { return {exit_code_of(error), error.message}; }

// what a window's loop goes by, seconds
inline constexpr double kIdleWaitS = 0.004;  ///< between looks at the servo's news when nothing else happens
inline constexpr double kMinimisedWaitS = 0.1;

struct Shared {
  const ViewOptions& options;
  SceneHost& scene;
  HandHost& hand;
  Window& window;
  Gui& gui;
  Pacing pacing{options.quality};
  LivePlan plan = options.plan;
  Controls controls{};
  FrameTimes times{};
  ViewState state{};
  Commands commands{};
};

}  // namespace catena::app
