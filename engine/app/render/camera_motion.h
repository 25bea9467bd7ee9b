/// Where the camera is in each frame: the scene's, a key-framed path's, or along an axis; fitted, zoomed, raised and turned.
#pragma once
#include <optional>
#include <string>

#include "engine/app/render/options.h"
#include "render/frame/camera.h"
#include "render/frame/camera_path.h"

namespace catena::app {

class CameraMotion {
 public:
  /// Checks the words and numbers of the options and reads the path.
  /// `hand_s`: the duration of the hand's path where it is played, else 0.
  static Result<CameraMotion> make(const RenderOptions& options, double hand_s);
  /// --frames, or what the duration of --camera or of the hand's path comes to at --fps, or 1.
  int frames() const { return frames_; }
  /// Of frame 0 .. frames() - 1. `base`: the scene's view; `bounds`: of all that is drawn.
  render::View at(const render::View& base, const Bounds& bounds, double aspect, int frame) const;

 private:
  std::optional<render::CameraPath> path_;
  std::optional<Vec3> towards_eye_;
  bool fit_ = false;
  double orbit_deg_ = 0, elevation_deg_ = 0, zoom_ = 1;
  int frames_ = 1;
};

}  // namespace catena::app
