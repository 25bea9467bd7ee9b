/// `catena serve` shows a scene in browsers: the picture, which gets better while nothing moves, and the mouse as the hand. It is the
/// window (engine/app/viewer) with a network in the place of the display: the same scene, hand, controls and pacing. One session for all
/// pages: the first one has the hand, and with it the eye and all that can be changed; the others watch. Nothing is written to the scene's
/// file.
#pragma once
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "engine/app/render/render_options.h"
#include "engine/app/server/http/server.h"
#include "engine/app/viewer/input/haptic_session.h"
#include "engine/scene/document.h"

namespace catena::app {

struct ServeOptions {
  std::string source;  ///< a scene or a data file
  std::string grid;    ///< of a data file that holds several; empty: the one that is looked at first
  std::vector<scene::FieldOverride> overrides;
  std::function<Outcome(scene::Scene&)> adjust_scene;  ///< what the command line wants otherwise than the scene
  HapticSession::Options haptic_options;               ///< its device is the mouse
  http::ServerOptions server;                          ///< the page is set here
  std::uint32_t width = 1024, height = 768;            ///< of the picture before a page says its own size
  Quality quality;
  bool is_quality_explicit = false;  ///< by the command line or the scene: a plan leaves it alone
  std::uint64_t gpu_memory = 0;      ///< bytes; 0: what the driver offers
  double seconds = 0;                ///< ends after so long; 0: by Ctrl-C
  bool exit_with_stdin = false;
  bool follow = false;  ///< steps in time that are added are shown (`adjust` marks the scene)
};

/// Until Ctrl-C, or the time is over. Errors are one line: the scene's (bad input), or the machine's.
Outcome serve(ServeOptions options);

}  // namespace catena::app
