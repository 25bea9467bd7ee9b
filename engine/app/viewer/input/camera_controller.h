// SPDX-License-Identifier: MIT
/// Moves the view by commands, held keys and the turntable, and keeps the scene's camera equal to it. Frame thread.
#pragma once
#include "engine/app/viewer/input/camera_motion.h"
#include "engine/app/viewer/input/haptic_session.h"
#include "engine/app/viewer/input/navigation.h"
#include "engine/app/viewer/scene/scene_model.h"

namespace catena::app {

/// Returns the view as a camera of the scene.
scene::Camera to_scene_camera(const render::View& view);

/// Refers to navigation and scene, which must outlive it.
class CameraController {
 public:
  CameraController(Navigation& controls, SceneModel& scene, const HapticSession& hand)
      : navigation_(controls), scene_(scene), haptic_session_(hand) {}

  /// Adopts the initial view, probe and bounds of a scene that has just become the visible one.
  void adopt_scene(const LoadedScene& loaded);
  /// Stores the current view as the scene's camera (a fitted camera would follow the cursor).
  void pin_camera();
  /// Executes a camera command for an image of width / height `aspect`. Returns true if the view has changed.
  bool handle(Action action, double aspect);
  /// Advances flight by held keys and the turntable by the time since the last call. Returns true if the view has changed.
  bool update(const FlyKeys& keys);

  /// Returns whether the view differs from that of the last read or save.
  bool has_unsaved_view() const;
  /// Returns the state of the orthogonal views that are shown; nothing: none.
  std::optional<scene::OrthogonalViews> shown_planes() const;
  /// Returns whether the orthogonal views differ from those of the last read or save.
  bool has_unsaved_planes() const { return shown_planes() != saved_planes_; }
  void mark_saved();

 private:
  Navigation& navigation_;
  SceneModel& scene_;
  const HapticSession& haptic_session_;
  Flight flight_;
  std::int64_t last_update_ns_ = 0;                     ///< 0: update() has not been called.
  render::View saved_view_;                             ///< The view in the scene's text, or the initial one.
  std::optional<scene::OrthogonalViews> saved_planes_;  ///< Those in the scene's text.
};

}  // namespace catena::app
