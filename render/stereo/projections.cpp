#include "render/stereo/projections.h"

#include <cmath>
#include <numbers>

#include "engine/base/numbers.h"

namespace catena::render {
namespace {

constexpr double kSquare = 1e-6;  // cosine between the edges of a rectangle
constexpr double kDegrees = 180 / std::numbers::pi;

std::string text_of(const Vec3& p) { return "[" + to_text(p.x) + ", " + to_text(p.y) + ", " + to_text(p.z) + "]"; }

}  // namespace

Result<View> screen_view(const Screen& screen, const Vec3& eye) {
  const Vec3 across = screen.lower_right - screen.lower_left, upwards = screen.upper_left - screen.lower_left;
  const double width = norm(across), height = norm(upwards);
  const Vec3 right = direction(across), up = direction(upwards), normal = direction(cross(right, up));
  if (!(width > 0 && height > 0 && std::isfinite(width * height)) || std::fabs(dot(right, up)) > kSquare)
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
  return view;
}

Result<View> headset_view(const Vec3& position, const Mat3& world_from_eye, const Tangents& t) {
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

}  // namespace catena::render
