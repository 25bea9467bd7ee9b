// SPDX-License-Identifier: MIT
/// Command `catena view`: a window that shows the scene while the device (by default the mouse) touches it. Other devices have their forces
/// off until F enables them; the mouse has no actuators, so its force is only shown. The servo thread runs the haptic program; the frame
/// thread takes its latest state and never waits for it.
#pragma once
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "engine/app/render/render_options.h"
#include "engine/app/viewer/input/haptic_session.h"
#include "engine/app/viewer/window/live_tuning.h"
#include "engine/app/viewer/window/loading_screen.h"
#include "engine/scene/document.h"
#include "render/vk/device.h"

namespace catena::app {

/// Options of the command line.
struct ViewOptions {
  std::string source;                                     ///< Scene or data file; empty: start with an empty window.
  scene::FileColors colors;                               ///< Colors of a data file, and a data file over it.
  std::string grid_name;                                  ///< Grid to use from a data file with several; empty: the default one.
  std::vector<scene::FieldOverride> overrides;            ///< Values of the option --field.
  std::function<Outcome(scene::Scene&)> apply_overrides;  ///< Applies overrides of the command line; called whenever the scene is read.
  HapticSession::Options haptic_options;
  std::uint32_t width = 1024, height = 768;
  EarlyWindow early;                  ///< Window that the program has opened while it read the scene.
  Quality quality;                    ///< Quality of a refined frame (progressive_scheduler.h).
  bool has_explicit_quality = false;  ///< Set on the command line; a quality stated by the scene does not count.
  LiveTuning tuning{};                ///< Targets. The tick tuning is made before the window opens, the image tuning with the first frame.
  std::uint64_t gpu_memory = 0;       ///< Bytes; 0: what the driver offers.
  std::string shader_folder;          ///< Folder of shaders to watch; empty: none.
  int max_frames = 0;                 ///< Quit after this many frames; 0: run until the window is closed.
  double max_seconds = 0;             ///< Render continuously and quit after this time; 0: run until the window is closed.
  std::string device_file;            ///< Device settings used in place of the scene's; registrations are saved there. Empty: none.
  /// Source of head positions in front of the scene's display screen (tracked_head.h); empty: none, the mouse moves the camera.
  std::string head_source;
  bool show_panels = true;
  bool follow_time_steps = false;  ///< Show new time steps as they are added (apply_overrides marks the scene).
  bool use_headset = false;        ///< Render for a headset; the window mirrors one eye.
  std::string screenshot;          ///< Path of a .png of the last image, written at the end; empty: none.
  std::string ui_screenshot;       ///< The same including the GUI.
  std::function<VkResult(render::vk::DriverCall)> inject_failure{};  ///< For tests only (vk::DeviceOptions).
  std::string servo_stats;                                           ///< Path of servo statistics (.json), written at the end; empty: none.
  std::string frame_stats;                                           ///< Path of frame statistics (.json), written at the end; empty: none.
};

/// Runs the viewer. Returns the exit code: 0 done, 1 no display or no GPU, 2 the scene cannot be rendered or touched, or the device cannot
/// be opened (one line on stderr).
int run_viewer(ViewOptions options);

}  // namespace catena::app
