// SPDX-License-Identifier: MIT
#include "engine/app/viewer/input/camera_motion.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "engine/app/viewer/input/navigation.h"

namespace catena::app {

namespace {

constexpr double kFast = 4, kZoomRate = 1;  // per second
constexpr double kPathPoleAngle = 0.02;

/// Integral over the time step of a value that converges from v to w, and the value at its end.
template <class T>
T settle(T& v, const T& w, double dt_s) {
  const double rest = std::exp(-dt_s / kFlyTimeConstantS);
  const T way = dt_s * w + kFlyTimeConstantS * (1 - rest) * (v - w);
  v = w + rest * (v - w);
  return way;
}

}  // namespace

void fly(render::View& view, Flight& flight, const FlyKeys& keys, double scene_size, double speed, double dt_s) {
  if (!(dt_s > 0)) return;
  const render::Camera camera = render::make_camera(view, 1, 1, Bounds());
  const auto along = [](bool plus, bool minus) { return (plus ? 1.0 : 0.0) - (minus ? 1.0 : 0.0); };
  const double pace = kFlyDiagonalsPerS * scene_size * speed * (keys.fast ? kFast : 1);
  const double ahead = along(keys.forward, keys.back);
  Vec3 wanted = along(keys.right, keys.left) * camera.right + along(keys.up, keys.down) * camera.up;
  if (!view.orthographic) wanted += -ahead * camera.back;
  const double length = norm(wanted);
  if (length > 1) wanted *= 1 / length;
  const Vec3 way = settle(flight.velocity, pace * wanted, dt_s);
  view.position += way;
  view.target += way;
  const double zoomed = settle(flight.zoom_rate, view.orthographic ? -kZoomRate * speed * (keys.fast ? kFast : 1) * ahead : 0.0, dt_s);
  if (view.orthographic) view.height *= std::exp(zoomed);
}

void look_around(render::View& view, double yaw, double pitch) {
  const Vec3 up = direction(view.up), arm = view.target - view.position;
  const double distance = norm(arm);
  if (!(distance > 0) || max_abs(up) == 0) return;
  Vec3 ahead = direction(arm);
  const Vec3 side = cross(ahead, up);
  if (norm(side) < 1e-9) return;
  const auto rotated = [](const Vec3& v, const Vec3& axis, double angle) {
    return std::cos(angle) * v + std::sin(angle) * cross(axis, v) + (1 - std::cos(angle)) * dot(axis, v) * axis;
  };
  const double polar = std::atan2(norm(side), dot(up, ahead));
  const double turn = polar - std::clamp(polar - pitch, kPathPoleAngle, std::numbers::pi - kPathPoleAngle);
  ahead = rotated(ahead, direction(side), turn);
  ahead = rotated(ahead, up, -yaw);
  view.target = view.position + distance * direction(ahead);
}

void advance_turntable(render::View& view, double dt_s) { orbit(view, kTurntableRadPerS * dt_s, 0); }

}  // namespace catena::app
