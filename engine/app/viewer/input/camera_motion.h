// SPDX-License-Identifier: MIT
/// Camera motion by itself or by held keys: flight and turntable. Pure functions of the elapsed time, so that the path is independent of
/// the frame rate. World units, seconds, radians; any thread.
#pragma once
#include "render/frame/camera.h"

namespace catena::app {

/// The fly keys currently held down.
struct FlyKeys {
  bool forward = false, back = false, left = false, right = false, up = false, down = false, fast = false;
  bool any() const { return forward || back || left || right || up || down; }
};

inline constexpr double kFlyDiagonalsPerS = 0.25;  ///< Fraction of the diagonal of everything visible; four times that with `fast`.
inline constexpr double kFlyTimeConstantS = 0.12;  ///< Time constant with which the velocity follows the keys.
inline constexpr double kTurntableRadPerS = 0.5;

/// State of a flight: v' = (target - v) / kFlyTimeConstantS, integrated exactly, so that a step of dt equals two of dt / 2.
struct Flight {
  Vec3 velocity{0.0};
  double zoom_rate = 0;  ///< Orthographic: ln(height) per second.
  bool is_at_rest(double scene_size) const { return norm(velocity) < 1e-4 * scene_size && zoom_rate > -1e-3 && zoom_rate < 1e-3; }
};

/// Moves position and target along the view's axes. Orthographic: forward decreases the image height. `scene_size`: diagonal of the scene;
/// `speed`: factor.
void fly(render::View& view, Flight& flight, const FlyKeys& keys, double scene_size, double speed, double dt_s);

/// Rotates the target about the camera: yaw to the right about the view's up, pitch upwards, stopping short of the poles.
void look_around(render::View& view, double yaw, double pitch);

/// Rotates the camera about the target at kTurntableRadPerS.
void advance_turntable(render::View& view, double dt_s);

}  // namespace catena::app
