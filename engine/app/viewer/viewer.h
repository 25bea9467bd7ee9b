/// `catena view`: a window that shows the scene while the hand (by default the mouse) feels it.
/// Any other device has its forces off until F turns them on; the mouse cannot push: its force is only drawn.
/// The servo thread runs the haptic program; the frame takes its newest state and never waits for it.
#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "engine/app/render/quality_words.h"
#include "engine/scene/scene.h"
#include "haptics/servo/realtime.h"

namespace catena::app {

struct ViewOptions {
  scene::Scene scene;            ///< read already (its errors are the caller's)
  std::string device = "mouse";  ///< what holds the probe: the mouse, or a name of haptics/device/registry.h
  std::uint32_t width = 1024, height = 768;
  Quality quality;                    ///< of a picture at rest (pacing.h)
  std::string shaders;                ///< folder of shaders to watch; empty: none
  int frames = 0;                     ///< quit after so many frames; 0: until the window is closed
  double seconds = 0;                 ///< draw all the time and quit after so long; 0: until the window is closed
  std::string screenshot;             ///< .png of the last frame, written at the end; empty: none
  std::string servo_stats;            ///< .json of the servo, written at the end; empty: none
  std::string record;                 ///< .catlog of every tick; empty: none
  std::vector<std::string> fields;    ///< --field options, for the recording
  std::string firmware;               ///< falcon: before the scene's
  haptics::RealtimeOptions realtime;  ///< of the servo
};

/// Exit code: 0 done, 1 no display or no GPU, 2 the scene cannot be shown or felt, or the device not opened (one line on stderr).
int view(ViewOptions options);

}  // namespace catena::app
