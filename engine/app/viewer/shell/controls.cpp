#include "engine/app/viewer/shell/controls.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "engine/app/viewer/shell/camera_paths.h"
#include "engine/base/eye_limits.h"
#include "render/frame/camera_moves.h"

namespace catena::app {

namespace {

constexpr double kTurnPerHeight = std::numbers::pi;  // a drag over the window's height
constexpr double kZoomPerNotch = 0.9;
constexpr double kDepthPerNotch = 0.01;  // of the distance from the eye
constexpr double kPoleAngle = 0.02;      // radians

Vec3 rotated(const Vec3& v, const Vec3& axis, double angle) {
  const double c = std::cos(angle), s = std::sin(angle);
  return c * v + s * cross(axis, v) + (1 - c) * dot(axis, v) * axis;
}

render::Camera camera_of(const render::View& view, const Input& input) {
  return render::make_camera(view, std::max(1.0, input.width), std::max(1.0, input.height), Bounds());
}

void pan(render::View& view, const Input& input) {
  const render::Camera camera = camera_of(view, input);
  const double unit = render::pixel_size(camera, norm(view.position - view.target));
  const Vec3 shift = unit * (input.dy * camera.up - input.dx * camera.right);
  view.position += shift;
  view.target += shift;
}

void move_hand(Controls& controls, const Input& input) {
  const render::Camera camera = camera_of(controls.view, input);
  auto place = render::project(camera, controls.hand);
  if (!place) place = render::project(camera, controls.view.target);  // the hand was behind the eye: back into the picture
  if (!place) return;
  double depth = place->z;
  const auto held = controls.held && controls.hand_mode ? render::project(camera, *controls.held) : std::nullopt;
  if (held) depth += std::min(1.0, std::hypot(input.dx, input.dy) / Controls::kDepthPixels) * (held->z - depth);
  depth *= 1 + kDepthPerNotch * input.wheel;
  const Vec3 moved = render::unproject(camera, place->x + input.dx, place->y + input.dy, depth);
  controls.hand = controls.hand_mode ? controls.hand + yielding(moved - controls.hand, controls.force_n, controls.max_force_n) : moved;
}

/// Along an axis, all in the picture; the angle and the projection stay.
void look_along(Controls& controls, const Input& input) {
  constexpr std::string_view kAlong[2][3] = {{"+x", "+y", "+z"}, {"-x", "-y", "-z"}};
  const std::string_view words = kAlong[input.shift ? 1 : 0][*input.axis];
  auto view = render::axis_view(controls.bounds, input.width / input.height, words, controls.view.fovy_deg);
  view->orthographic = controls.view.orthographic;
  controls.view = *view;
}

}  // namespace

Vec3 yielding(const Vec3& motion, const Vec3& force_n, double max_force_n) {
  constexpr double kLeast = 0.25;
  const double force = norm(force_n);
  if (!(max_force_n > 0) || !(force > 0)) return motion;
  const Vec3 away = 1 / force * force_n;
  const double along = dot(motion, away);
  if (along >= 0) return motion;
  return motion - (1 - kLeast) * std::min(1.0, force / max_force_n) * along * away;
}

void orbit(render::View& view, double yaw, double pitch) {
  const Vec3 up = direction(view.up);
  const double distance = norm(view.position - view.target);
  if (!(distance > 0) || max_abs(up) == 0) return;
  Vec3 back = direction(view.position - view.target);
  if (norm(cross(up, back)) < 1e-6) {
    // right over the pole: step off it first
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
  const bool high = !view.orthographic || (view.height >= kLeastEyeHeight && view.height <= kMostEyeHeight);
  return high && eye_problem(view.position, view.target).empty();
}

Changed apply(Controls& controls, const Input& input) {
  Changed changed;
  const render::View view_before = controls.view;
  const Vec3 hand_before = controls.hand;
  if (input.toggle_hand) controls.hand_mode = !controls.hand_mode;
  const bool moved = input.dx != 0 || input.dy != 0, wheeled = input.wheel != 0;
  const bool hand = controls.hand_mode || input.control || input.right;
  const bool navigates = input.middle || (input.left && input.shift);

  const std::uint32_t buttons = (input.space || (controls.hand_mode && input.left && !input.shift)) ? 1u : 0u;
  changed.hand = buttons != controls.buttons;
  controls.buttons = buttons;

  if (navigates && moved) {
    pan(controls.view, input);
    changed.view = true;
  } else if (hand && (moved || wheeled)) {
    move_hand(controls, input);
    changed.hand = true;
  } else if (controls.fly && input.left && moved) {
    const double turn = controls.view.fovy_deg * std::numbers::pi / 180 / input.height;
    look(controls.view, turn * input.dx, -turn * input.dy);
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
  const bool fits = !controls.bounds.empty();
  if (input.axis && fits) look_along(controls, input);
  if (input.fit && fits) controls.view = render::fitted(controls.view, controls.bounds, input.width / input.height);
  if (input.toggle_projection) toggle_projection(controls.view);
  if (input.reset_view) controls.view = controls.home;
  changed.view = changed.view || (fits && (input.axis || input.fit)) || input.toggle_projection || input.reset_view;
  // neither eye nor hand leaves the world
  if (!is_possible(controls.view)) controls.view = view_before;
  if (!is_finite(controls.hand) || max_abs(controls.hand) > kMostEyeCoordinate) controls.hand = hand_before;
  return changed;
}

const std::vector<KeyHelp>& key_list() {
  static const std::vector<KeyHelp> keys = {
      {"The eye", "left drag", "orbit"},
      {"The eye", "middle, shift+left", "pan"},
      {"The eye", "wheel", "zoom"},
      {"The eye", "1, 2, 3", "look along +x, +y, +z, at all that is drawn; with shift along -x, -y, -z"},
      {"The eye", "A, Home", "all that is drawn into the picture, from the same direction"},
      {"The eye", "O", "orthographic or perspective"},
      {"The eye", "R", "the first view again"},
      {"The eye", "T", "turntable, until T or the mouse"},
      {"The eye", "V", "fly: W S A D or arrows, E up, Q down, shift faster, left drag looks about, wheel: pace; V or Esc ends it"},
      {"The hand", "right drag, control", "move the hand in the picture's plane (wheel: depth)"},
      {"The hand", "H", "hand mode: the mouse is the hand, the left button its button 1"},
      {"The hand", "space", "the hand's button 1"},
      {"The hand", "F", "a haptic device's forces on and off (off at first)"},
      {"The hand", "device button 1", "takes hold of widgets, selects; what the scene's \"on\" says"},
      {"The scene", "Ctrl+O", "open; a file can be dropped on the window as well"},
      {"The scene", "Ctrl+S, Ctrl+Shift+S", "save (with the view, if it was moved), save as"},
      {"The scene", "Ctrl+Z, Ctrl+Y", "undo, redo"},
      {"The scene", "P", "the pulses along streamlines stand or run"},
      {"The window", "Tab", "panels"},
      {"The window", "F2", "the next stereo mode"},
      {"The window", "F11", "full screen"},
      {"The window", "F12, Shift+F12", "write the picture, the window, as SCENE-001.png"},
      {"The window", "F1, ?", "these keys"},
      {"The window", "Esc", "closes or cancels what is open, ends flying, hand mode, full screen"},
      {"The window", "Ctrl+Q", "quit"}};
  return keys;
}

std::string key_help() {
  std::string text;
  for (const KeyHelp& key : key_list()) {
    const std::string keys = key.keys;
    text += keys + std::string(keys.size() < 21 ? 21 - keys.size() : 1, ' ') + key.does + "\n";
  }
  return text;
}

}  // namespace catena::app
