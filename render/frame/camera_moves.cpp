#include "render/frame/camera_moves.h"

#include <cmath>
#include <numbers>

namespace catena::render {
namespace {

Vec3 turned_about(const Vec3& axis, double degrees, const Vec3& v) {
  const double angle = degrees * std::numbers::pi / 180;
  return v * std::cos(angle) + cross(axis, v) * std::sin(angle) + axis * (dot(axis, v) * (1 - std::cos(angle)));
}

}  // namespace

View turned(const View& view, double azimuth_deg, double elevation_deg) {
  View moved = view;
  const Vec3 axis = direction(view.up);
  Vec3 arm = view.position - view.target;
  if (elevation_deg != 0) {
    const Camera camera = make_camera(view, 1, 1, {});
    // about the right axis, backwards: the eye rises towards up
    arm = turned_about(camera.right, -elevation_deg, arm);
    moved.up = turned_about(camera.right, -elevation_deg, camera.up);
  }
  moved.position = moved.target + turned_about(axis, azimuth_deg, arm);
  if (elevation_deg != 0) moved.up = turned_about(axis, azimuth_deg, moved.up);
  return moved;
}

View zoomed(const View& view, double factor) {
  View closer = view;
  const double half = 0.5 * view.fovy_deg * std::numbers::pi / 180;
  closer.fovy_deg = 2 * std::atan(std::tan(half) / factor) * 180 / std::numbers::pi;
  closer.height = view.height / factor;
  return closer;
}

std::optional<Vec3> axis_direction(std::string_view words) {
  if (words == "iso") return direction(Vec3(1.0, -1.0, 1.0));
  if (words.size() != 2 || (words[0] != '+' && words[0] != '-') || words[1] < 'x' || words[1] > 'z') return std::nullopt;
  Vec3 towards_eye(0.0);
  towards_eye[words[1] - 'x'] = words[0] == '+' ? -1 : 1;
  return towards_eye;
}

std::optional<View> axis_view(const Bounds& bounds, double aspect, std::string_view words, double fovy_deg) {
  const auto towards_eye = axis_direction(words);
  if (!towards_eye) return std::nullopt;
  return fit_view(bounds, aspect, *towards_eye, fovy_deg);
}

View fitted(const View& view, const Bounds& bounds, double aspect) {
  View fit = fit_view(bounds, aspect, view.position - view.target, view.fovy_deg, view.up);
  fit.orthographic = view.orthographic;
  return fit;
}

}  // namespace catena::render
