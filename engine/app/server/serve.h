// SPDX-License-Identifier: MIT
/// `catena serve` shows a scene in browsers: progressively refined images, with the mouse as the haptic device. It is the viewer
/// (engine/app/viewer) with a network in place of the display: same scene, haptics, controls and frame scheduling. All pages share one
/// session: the first page is in control of the probe, the camera and all edits; the others watch. The scene file is never written.
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

/// Options of `catena serve`.
struct ServeOptions {
  std::string source;  ///< A scene or a data file
  /// Grid of a data file that holds several; empty: the default one
  std::string grid;
  std::vector<scene::FieldOverride> overrides;
  /// Applies the command line's changes to the scene
  std::function<Outcome(scene::Scene&)> adjust_scene;
  HapticSession::Options haptic_options;  ///< The device is the mouse
  http::ServerOptions server;             ///< serve() sets the page
  /// Size of the image until a page sends its size, pixels
  std::uint32_t width = 1024, height = 768;
  Quality quality;
  /// The quality was set by the command line or the scene: the tuning does not change it
  bool has_fixed_quality = false;
  std::uint64_t gpu_memory = 0;  ///< Limit in bytes; 0: what the driver reports
  double seconds = 0;            ///< Time limit, s; 0: until Ctrl-C
  /// Exits when standard input is closed.
  bool exit_with_stdin = false;
  /// Shows time steps as they are added (`adjust_scene` marks the scene)
  bool follow = false;
};

/// Runs until Ctrl-C or the time limit. Error: one line; bad input of the scene, or a system failure.
Outcome serve(ServeOptions options);

}  // namespace catena::app
