/// These functions move the eye by itself or by held keys: flight and turntable. They are pure functions of the time that has passed, so
/// that fast and slow pictures show the same path. World units, seconds, radians; any thread.
#pragma once
#include "render/frame/camera.h"

namespace catena::app {

/// Held down now.
struct FlyKeys {
  bool forward = false, back = false, left = false, right = false, up = false, down = false, fast = false;
  bool any() const { return forward || back || left || right || up || down; }
};

inline constexpr double kFlyDiagonalsPerS = 0.25;  ///< of what is drawn (its diagonal), with `fast` four times that
inline constexpr double kFlyTimeConstantS = 0.12;  ///< the velocity follows the keys with this time constant
inline constexpr double kTurntableRadPerS = 0.5;

/// The velocity of a flight: v' = (wanted - v) / kFlyTimeConstantS, integrated exactly: a step of dt equals two of dt / 2.
struct Flight {
  Vec3 velocity{0.0};
  double zoom_rate = 0;  ///< orthographic: ln(height) per second
  bool is_at_rest(double scene_size) const { return norm(velocity) < 1e-4 * scene_size && zoom_rate > -1e-3 && zoom_rate < 1e-3; }
};

/// Eye and target move along the view's axes. Orthographic: forward makes the picture's height smaller. `speed` multiplies.
void fly(render::View& view, Flight& flight, const FlyKeys& keys, double scene_size, double speed, double dt_s);

/// Turns the target about the eye: yaw to the right about the view's up, pitch upwards, short of the poles.
void look_around(render::View& view, double yaw, double pitch);

/// Turns the eye about the target as a turntable does.
void advance_turntable(render::View& view, double dt_s);

}  // namespace catena::app
