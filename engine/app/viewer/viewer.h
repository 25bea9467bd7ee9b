/// `catena view`: a window that shows the scene while the hand (by default the mouse) feels it.
/// The servo thread runs the haptic program; the frame takes its newest state and never waits for it.
#pragma once
#include <cstdint>
#include <string>

#include "engine/scene/scene.h"

namespace catena::app {

struct ViewOptions {
  scene::Scene scene;            ///< read already (its errors are the caller's)
  std::string device = "mouse";  ///< what holds the probe
  std::uint32_t width = 1024, height = 768;
  int frames = 0;          ///< quit after so many frames; 0: until the window is closed
  std::string screenshot;  ///< .png of the last frame, written at the end; empty: none
};

/// Exit code: 0 done, 1 no display or no device, 2 the scene cannot be shown or felt (one line on stderr).
int view(ViewOptions options);

}  // namespace catena::app
