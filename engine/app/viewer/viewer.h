/// `catena view` opens a window that shows the scene while the hand (by default the mouse) feels it.
/// Any other device has its forces off until F turns them on; the mouse cannot push: its force is only drawn.
/// The servo thread runs the haptic program; the frame takes its newest state and never waits for it.
#pragma once
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "engine/app/render/render_options.h"
#include "engine/app/viewer/input/haptic_session.h"
#include "engine/app/viewer/window/live_tuning.h"
#include "engine/scene/document.h"
#include "render/vk/device.h"

namespace catena::app {

struct ViewOptions {
  std::string source;                                     ///< a scene or a data file; empty: the window begins with nothing
  std::string grid_name;                                  ///< of a data file that holds several; empty: the one that is looked at first
  std::vector<scene::FieldOverride> overrides;            ///< --field
  std::function<Outcome(scene::Scene&)> apply_overrides;  ///< what the command line wants otherwise than the scene, whenever it is read
  HapticSession::Options haptic_options;
  std::uint32_t width = 1024, height = 768;
  Quality quality;                    ///< of a picture at rest (pacing.h)
  bool has_explicit_quality = false;  ///< a scene's own does not count
  LiveTuning tuning{};                ///< what is wanted; the hand's is made before the window opens, the eye's with its first picture
  std::uint64_t gpu_memory = 0;       ///< bytes; 0: what the driver offers
  std::string shader_folder;          ///< folder of shaders to watch; empty: none
  int max_frames = 0;                 ///< quit after so many frames; 0: until the window is closed
  double max_seconds = 0;             ///< draw all the time and quit after so long; 0: until the window is closed
  std::string device_file;            ///< settings of the device in place of the scene's; a registration is written there. Empty: none
  std::string head_source;            ///< what tells where the head is before a screen of the scene (tracked_head.h); empty: the mouse
  bool show_panels = true;
  bool follow_time_steps = false;                                    ///< steps in time that are added are shown (`adjust` marks the scene)
  bool use_headset = false;                                          ///< draw for a headset; the window mirrors one eye
  std::string screenshot;                                            ///< .png of the last picture, written at the end; empty: none
  std::string ui_screenshot;                                         ///< the same with the interface
  std::function<VkResult(render::vk::DriverCall)> inject_failure{};  ///< tests only (vk::DeviceOptions)
  std::string servo_stats;                                           ///< .json of the servo, written at the end; empty: none
  std::string frame_stats;                                           ///< .json of the pictures, written at the end; empty: none
};

/// Exit code: 0 done, 1 no display or no GPU, 2 the scene cannot be shown or felt, or the device not opened (one line on stderr).
int run_viewer(ViewOptions options);

}  // namespace catena::app
