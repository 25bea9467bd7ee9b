// SPDX-License-Identifier: MIT
#include "render/stereo/stereo_views.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "engine/base/numbers.h"
#include "engine/base/result.h"
#include "render/frame/camera.h"

namespace catena::render {
namespace {

constexpr double kRectangleTolerance = 1e-6;  // maximum cosine between the edges of a rectangle
constexpr double kDegrees = 180 / std::numbers::pi;

std::string text_of(const Vec3& p) { return "[" + to_text(p.x) + ", " + to_text(p.y) + ", " + to_text(p.z) + "]"; }

}  // namespace

Result<View> make_screen_view(const Screen& screen, const Vec3& eye) {
  const Vec3 across = screen.lower_right - screen.lower_left, upwards = screen.upper_left - screen.lower_left;
  const double width = norm(across), height = norm(upwards);
  const Vec3 right = direction(across), up = direction(upwards), normal = direction(cross(right, up));
  if (!(width > 0 && height > 0 && std::isfinite(width * height)) || std::fabs(dot(right, up)) > kRectangleTolerance)
    return Error{"the screen's corners " + text_of(screen.lower_left) + ", " + text_of(screen.lower_right) + ", " +
                 text_of(screen.upper_left) + " span no rectangle; lower left, lower right and upper left of one were expected"};
  const Vec3 corner = screen.lower_left - eye;
  const double distance = -dot(normal, corner);
  if (!(distance > 1e-9 * (width + height)))
    return Error{"the eye " + text_of(eye) +
                 " is not before the screen; a place from which its corners turn counter-clockwise was expected"};

  View view;
  view.position = eye;
  view.target = eye - distance * normal;
  view.up = up;
  view.fovy_deg = 2 * kDegrees * std::atan(0.5 * height / distance);
  view.aspect = width / height;
  view.window.left = dot(right, corner) / (0.5 * width);
  view.window.right = view.window.left + 2;
  view.window.bottom = dot(up, corner) / (0.5 * height);
  view.window.top = view.window.bottom + 2;
  if (!(std::fabs(view.window.left) <= kMaxWindowShift && std::fabs(view.window.bottom) <= kMaxWindowShift))
    return Error{"the eye " + text_of(eye) +
                 " is too far beside the screen; at most half a million of its widths and heights were expected"};
  return view;
}

Result<View> make_headset_view(const Vec3& position, const Mat3& world_from_eye, const FovTangents& t) {
  const double half_width = 0.5 * (t.right - t.left), half_height = 0.5 * (t.up - t.down);
  const bool finite = is_finite(position) && std::isfinite(half_width) && std::isfinite(half_height);
  if (!finite || !(half_width > 0 && half_height > 0))
    return Error{"an eye has the tangents left " + to_text(t.left) + ", right " + to_text(t.right) + ", up " + to_text(t.up) + ", down " +
                 to_text(t.down) + "; left below right, down below up were expected"};
  View view;
  view.position = position;
  view.target = position - world_from_eye[2];
  view.up = world_from_eye[1];
  view.fovy_deg = 2 * kDegrees * std::atan(half_height);
  view.aspect = half_width / half_height;
  view.window = {t.left / half_width, t.right / half_width, t.down / half_height, t.up / half_height};
  return view;
}

namespace {

View perspective_eye(const View& centre, const Camera& axes, double aspect, double offset, double zero_parallax) {
  View eye = centre;
  eye.position += offset * axes.right;
  eye.target += offset * axes.right;
  const double half_width = aspect * std::tan(0.5 * centre.fovy_deg * std::numbers::pi / 180);
  const double shift = std::clamp(offset / (zero_parallax * half_width), -kMaxWindowShift, kMaxWindowShift);
  eye.window.left -= shift;
  eye.window.right -= shift;
  return eye;
}

View orthographic_eye(const View& centre, const Camera& axes, double aspect, double offset, double zero_parallax) {
  const double angle = std::atan(offset / zero_parallax), length = norm(centre.target - centre.position);
  const double distance = length > 0 ? length : zero_parallax;
  View eye = centre;
  eye.position += offset * axes.right;
  eye.target = eye.position - distance * (std::cos(angle) * axes.back + std::sin(angle) * axes.right);
  eye.aspect = aspect * std::cos(angle);
  return eye;
}

}  // namespace

double zero_parallax_distance(const View& centre, const StereoSettings& settings) {
  if (settings.zero_parallax) return *settings.zero_parallax;
  const double distance = norm(centre.target - centre.position);
  return distance > 0 ? distance : 1;
}

std::vector<View> make_stereo_views(const View& centre, double aspect, const StereoSettings& settings) {
  const double zero_parallax = zero_parallax_distance(centre, settings);
  const double separation = settings.separation.value_or(kDefaultSeparationRatio * zero_parallax);
  CATENA_ASSERT(settings.views > 0 && aspect > 0 && zero_parallax > 0 && separation >= 0);
  const Camera axes = make_camera(centre, 1, 1, {});
  View same_up = centre;
  same_up.up = axes.up;  // an up direction along the axis is replaced once for all eyes
  std::vector<View> result;
  for (std::size_t k = 0; k < settings.views; ++k) {
    const double offset = (double(k) - 0.5 * double(settings.views - 1)) * separation;
    const auto eye = centre.orthographic ? orthographic_eye : perspective_eye;
    result.push_back(eye(same_up, axes, aspect, offset, zero_parallax));
  }
  return result;
}

}  // namespace catena::render
