/// Eye moves the view as commands, held keys and the turntable say, and the scene's camera with it. Frame thread.
#pragma once
#include "engine/app/viewer/input/camera_motion.h"
#include "engine/app/viewer/input/haptic_session.h"
#include "engine/app/viewer/input/navigation.h"
#include "engine/app/viewer/scene/scene_model.h"

namespace catena::app {

/// As the scene states it.
scene::Camera to_scene_camera(const render::View& view);

class CameraController {
 public:
  CameraController(Navigation& controls, SceneModel& scene, const HapticSession& hand)
      : navigation_(controls), scene_(scene), haptic_session_(hand) {}

  /// The place in a scene that has just become the one that is shown.
  void adopt_scene(const LoadedScene& loaded);
  /// From now on the camera is where the controls have it (a fitted one would follow the cursor).
  void pin_camera();
  /// A command of the eye, in a picture of that width / height; true: the view has changed.
  bool handle(Action action, double aspect);
  /// Flight by the keys that are held, and the turntable, by the time since the last call. True: the view has changed.
  bool update(const FlyKeys& keys);

  /// The person has moved the view since it was read or saved.
  bool has_unsaved_view() const;
  void mark_saved() { saved_view_ = navigation_.view; }

 private:
  Navigation& navigation_;
  SceneModel& scene_;
  const HapticSession& haptic_session_;
  Flight flight_;
  std::int64_t last_update_ns_ = 0;  ///< 0: it has not been asked to move yet
  render::View saved_view_;          ///< that the scene's text has, or began with
};

}  // namespace catena::app
