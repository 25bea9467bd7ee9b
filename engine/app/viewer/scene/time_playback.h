/// TimePlayback shows a scene's steps in time (engine/scene/time_steps.h), one that is asked for or one after the other, in a window or for
/// a browser. Frame thread.
#pragma once
#include <cstdint>

#include "engine/app/viewer/scene/scene_model.h"

namespace catena::app {

class TimePlayback {
 public:
  bool is_playing = false;  ///< steps go by

  /// Round and round. What cannot be loaded is an error: the step stays, and no more go by.
  Outcome show(SceneModel& scene, int step);
  /// The next one, where they go by and its time has come. One that is not loaded yet is waited for, without holding up who asks.
  Outcome advance(SceneModel& scene);

 private:
  std::int64_t last_step_ns_ = 0;
  int prefetched_step_ = -1;  ///< the step that is loaded ahead
};

}  // namespace catena::app
