/// Eye moves the view as commands, held keys and the turntable say, and the scene's camera with it. Frame thread.
#pragma once
#include "engine/app/viewer/shell/camera_paths.h"
#include "engine/app/viewer/shell/controls.h"
#include "engine/app/viewer/shell/hand_host.h"
#include "engine/app/viewer/shell/scene_host.h"

namespace catena::app {

/// As the scene states it.
scene::Camera camera_of(const render::View& view);

class Eye {
 public:
  Eye(Controls& controls, SceneHost& scene, const HandHost& hand) : controls_(controls), scene_(scene), hand_(hand) {}

  /// The place in a scene that has just become the one that is shown.
  void look_at(const LoadedScene& loaded);
  /// From now on the camera is where the controls have it (a fitted one would follow the cursor).
  void pin();
  /// A command of the eye, in a picture of that width / height; true: the view has changed.
  bool act(Action action, double aspect);
  /// Flight by the keys that are held, and the turntable, by the time since the last call. True: the view has changed.
  bool move(const FlyKeys& keys);

  /// The person has moved the view since it was read or saved.
  bool is_moved() const;
  void saved() { saved_ = controls_.view; }

 private:
  Controls& controls_;
  SceneHost& scene_;
  const HandHost& hand_;
  Flight flight_;
  std::int64_t last_move_ns_ = 0;  ///< 0: it has not been asked to move yet
  render::View saved_;             ///< that the scene's text has, or began with
};

}  // namespace catena::app
