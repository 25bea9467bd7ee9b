// SPDX-License-Identifier: MIT
#include "engine/app/viewer/input/navigation.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "engine/app/viewer/input/camera_motion.h"
#include "engine/app/viewer/input/commands.h"
#include "engine/base/camera_limits.h"
#include "render/frame/camera.h"

namespace catena::app {

namespace {

constexpr double kTurnPerHeight = std::numbers::pi;  // radians for a drag over the window's height
constexpr double kZoomPerNotch = 0.9;
constexpr double kDepthPerNotch = 0.01;  // fraction of the height of the visible area at the probe's depth
constexpr double kPoleAngle = 0.02;      // radians

Vec3 rotated(const Vec3& v, const Vec3& axis, double angle) {
  const double c = std::cos(angle), s = std::sin(angle);
  return c * v + s * cross(axis, v) + (1 - c) * dot(axis, v) * axis;
}

render::Camera make_viewport_camera(const render::View& view, const Input& input) {
  return make_area_camera(view, input.width, input.height);
}

void pan(render::View& view, const Input& input) {
  const render::Camera camera = make_viewport_camera(view, input);
  const double unit = render::pixel_size(camera, norm(view.position - view.target));
  const Vec3 shift = unit * (input.dy * camera.up - input.dx * camera.right);
  view.position += shift;
  view.target += shift;
}

/// Depth of the surface under the probe of a mouse; `now` if no surface is there.
double depth_beneath(const Navigation& controls, const render::Camera& camera, const Input& input, double now) {
  constexpr double kNear = 0.05;  // fraction of the depth: the visible surface counts as the one in contact
  const auto under = controls.pointer_hit ? render::project(camera, *controls.pointer_hit) : std::nullopt;
  const auto held = controls.last_proxy ? render::project(camera, *controls.last_proxy) : std::nullopt;
  if (under && (!held || std::abs(under->z - held->z) <= kNear * held->z + 1.5 * std::abs(controls.wheel_depth))) return under->z;
  if (!held) return now;
  return now + std::min(1.0, std::hypot(input.dx, input.dy) / Navigation::kDepthBlendPixels) * (held->z - now);
}

void move_hand(Navigation& controls, const Input& input) {
  const render::Camera camera = make_viewport_camera(controls.view, input);
  auto place = render::project(camera, controls.probe);
  if (!place)
    place = render::project(camera,
                            controls.view.target / controls.view.stretch);  // the probe was behind the camera: bring it back into the image
  if (!place) return;
  const double notch = kDepthPerNotch * camera.height * render::pixel_size(camera, place->z);
  if (!controls.probe_mode) {
    const double depth = place->z + notch * input.wheel;
    controls.probe = render::unproject(camera, place->x + input.dx, place->y + input.dy, depth);
    return;
  }
  const Vec3 ahead = -1.0 * camera.back, pushed = notch * input.wheel * ahead;
  const double by_wheel = dot(compliant_motion(pushed, controls.force_n, controls.max_force_n), ahead);
  // depth from which the wheel's push is measured
  double base = place->z - controls.wheel_depth;
  if ((input.dx != 0 || input.dy != 0) && controls.buttons == 0) base = depth_beneath(controls, camera, input, base);
  controls.wheel_depth += by_wheel;
  controls.probe = render::unproject(camera, input.x + input.dx, input.y + input.dy, base + controls.wheel_depth);
}

/// Views the scene along an axis so that all of it is in the image; keeps the angle and the projection.
void look_along(Navigation& controls, std::string_view axis, double aspect) {
  auto view = render::axis_view(controls.bounds, aspect, axis, controls.view.fovy_deg);
  view->orthographic = controls.view.orthographic;
  view->stretch = controls.view.stretch;
  controls.view = *view;
}

}  // namespace

render::Camera make_area_camera(const render::View& view, double width, double height) {
  return render::make_camera(view, std::max(1.0, width), std::max(1.0, height), Bounds());
}

Vec3 compliant_motion(const Vec3& motion, const Vec3& force_n, double max_force_n) {
  constexpr double kMinimum = 0.25;
  const double force = norm(force_n);
  if (!(max_force_n > 0) || !(force > 0)) return motion;
  const Vec3 away = 1 / force * force_n;
  const double along = dot(motion, away);
  if (along >= 0) return motion;
  return motion - (1 - kMinimum) * std::min(1.0, force / max_force_n) * along * away;
}

void orbit(render::View& view, double yaw, double pitch) {
  const Vec3 up = direction(view.up);
  const double distance = norm(view.position - view.target);
  if (!(distance > 0) || max_abs(up) == 0) return;
  Vec3 back = direction(view.position - view.target);
  if (norm(cross(up, back)) < 1e-6) {
    // exactly at the pole: move off it first
    const Vec3 side = std::fabs(up.x) < 0.9 ? Vec3(1.0, 0.0, 0.0) : Vec3(0.0, 1.0, 0.0);
    back = rotated(back, direction(cross(up, side)), kPoleAngle);
  }
  back = rotated(back, up, yaw);
  const double polar = std::atan2(norm(cross(up, back)), dot(up, back));
  const double turn = std::clamp(polar - pitch, kPoleAngle, std::numbers::pi - kPoleAngle) - polar;
  back = direction(rotated(back, direction(cross(up, back)), turn));
  view.position = view.target + distance * back;
}

void zoom(render::View& view, double factor) {
  if (view.orthographic)
    view.height *= factor;
  else
    view.position = view.target + factor * (view.position - view.target);
}

void toggle_projection(render::View& view) {
  const double height_at_1 = 2 * std::tan(0.5 * view.fovy_deg * std::numbers::pi / 180);
  const Vec3 arm = view.position - view.target;
  if (view.orthographic)
    view.position = view.target + view.height / height_at_1 * direction(arm);
  else
    view.height = height_at_1 * norm(arm);
  view.orthographic = !view.orthographic;
}

static bool is_possible(const render::View& view) {
  const bool high = !view.orthographic || (view.height >= kMinOrthoHeight && view.height <= kMaxOrthoHeight);
  return high && validate_view(view.position, view.target).empty();
}

void begin_probe_mode(Navigation& controls) {
  controls.wheel_depth = 0;
  if (controls.pointer_hit) controls.probe = *controls.pointer_hit;
}

NavigationChanges apply(Navigation& controls, const Input& input) {
  NavigationChanges changed;
  const render::View view_before = controls.view;
  const Vec3 hand_before = controls.probe;
  const bool moved = input.dx != 0 || input.dy != 0, wheeled = input.wheel != 0;
  const bool hand = controls.probe_mode || input.control || input.right;
  const bool navigates = input.middle || (input.left && input.shift);

  const std::uint32_t buttons = (input.space || (controls.probe_mode && input.left && !input.shift)) ? 1u : 0u;
  changed.probe = buttons != controls.buttons;
  controls.buttons = buttons;

  if (navigates && moved) {
    pan(controls.view, input);
    changed.view = true;
  } else if (hand && (moved || wheeled)) {
    move_hand(controls, input);
    changed.probe = true;
  } else if (controls.fly && input.left && moved) {
    const double turn = controls.view.fovy_deg * std::numbers::pi / 180 / input.height;
    look_around(controls.view, turn * input.dx, -turn * input.dy);
    changed.view = true;
  } else if (input.left && moved) {
    orbit(controls.view, -kTurnPerHeight * input.dx / input.height, kTurnPerHeight * input.dy / input.height);
    changed.view = true;
  }
  if (controls.fly && wheeled && !hand) {
    controls.fly_speed = std::clamp(controls.fly_speed * std::pow(1 / kZoomPerNotch, input.wheel), 0.02, 50.0);
  } else if (!hand && wheeled) {
    zoom(controls.view, std::pow(kZoomPerNotch, input.wheel));
    changed.view = true;
  }
  // keep camera and probe within representable coordinates
  if (!is_possible(controls.view)) controls.view = view_before;
  if (!is_finite(controls.probe) || max_abs(controls.probe) > kMaxCameraCoordinate) controls.probe = hand_before;
  return changed;
}

bool apply(Navigation& controls, Action action, double aspect) {
  const render::View before = controls.view;
  const bool fits = !controls.bounds.empty();
  switch (action) {
    case Action::view_along_plus_x:
    case Action::view_along_plus_y:
    case Action::view_along_plus_z:
    case Action::view_along_minus_x:
    case Action::view_along_minus_y:
    case Action::view_along_minus_z:
      if (!fits) return false;
      look_along(controls, menu_label(action), aspect);
      break;
    case Action::fit_view:
      if (!fits) return false;
      controls.view = render::refit_view(controls.view, controls.bounds, aspect);
      controls.ortho.zoom = 1;
      controls.ortho.center.reset();
      break;
    case Action::toggle_projection:
      toggle_projection(controls.view);
      break;
    case Action::reset_view:
      controls.view = controls.home;
      break;
    default:
      return false;
  }
  if (!is_possible(controls.view)) controls.view = before;
  return true;
}

bool stops_turntable(const Input& input) { return input.left || input.middle || input.wheel != 0; }

bool stops_turntable(Action action) {
  return action == Action::fit_view || action == Action::reset_view ||
         (action >= Action::view_along_plus_x && action <= Action::view_along_minus_z);
}

}  // namespace catena::app
