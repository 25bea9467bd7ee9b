// SPDX-License-Identifier: MIT
#include "render/frame/camera.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "engine/base/result.h"

namespace catena::render {

namespace {

constexpr double kNearestShare = 1e-4;  // near >= far * this; keeps the precision of a float depth buffer with the camera inside the scene
constexpr double kSlack = 1e-3;         // margin of near and far around the bounds, as a share

/// Sets an orthonormal frame with z along `back` and y as close to `up` as possible.
void set_axes(Camera& camera, const Vec3& back, const Vec3& up) {
  camera.back = direction(back);
  if (max_abs(camera.back) == 0) camera.back = {0.0, -1.0, 0.0};
  camera.right = cross(direction(up), camera.back);
  if (!(norm(camera.right) > 1e-9)) {
    const Vec3 other = std::fabs(camera.back.z) < 0.9 ? Vec3(0.0, 0.0, 1.0) : Vec3(0.0, 1.0, 0.0);
    camera.right = cross(other, camera.back);
  }
  camera.right = direction(camera.right);
  camera.up = direction(cross(camera.back, camera.right));
}

void set_depth_range(Camera& camera, const Bounds& bounds, double fallback_distance) {
  double nearest = std::numeric_limits<double>::infinity(), farthest = -nearest;
  if (!bounds.empty()) {
    for (int i = 0; i < 8; ++i) {
      const double depth = -dot(bounds.corner(i) - camera.position, camera.back);
      nearest = std::min(nearest, depth);
      farthest = std::max(farthest, depth);
    }
  }
  // no bounds, or all of them behind the camera
  if (!(farthest > 0)) {
    camera.near = 0.01 * fallback_distance;
    camera.far = 100 * fallback_distance;
    return;
  }
  const double slack = kSlack * std::max(farthest - nearest, kSlack * farthest);
  camera.far = farthest + slack;
  camera.near = std::max(nearest - slack, camera.orthographic ? 0.0 : kNearestShare * camera.far);
}

}  // namespace

double frustum_aspect(const View& view, double width_px, double height_px) {
  if (view.aspect > 0) return view.aspect;
  const FrustumWindow& w = view.window;
  return (w.top - w.bottom) / (w.right - w.left) * width_px / height_px;
}

Camera make_camera(const View& view, double width_px, double height_px, const Bounds& bounds) {
  CATENA_ASSERT(width_px >= 1 && height_px >= 1);
  Camera camera;
  camera.position = view.position;
  camera.stretch = view.stretch;
  camera.width = width_px;
  camera.height = height_px;
  camera.orthographic = view.orthographic;
  camera.half_height = view.orthographic ? 0.5 * view.height : std::tan(0.5 * view.fovy_deg * std::numbers::pi / 180);
  const FrustumWindow& w = view.window;
  const double share_x = 0.5 * (w.right - w.left), share_y = 0.5 * (w.top - w.bottom);
  CATENA_ASSERT(share_x > 0 && share_y > 0);
  const double whole_width = camera.half_height * frustum_aspect(view, width_px, height_px);
  camera.center_x = 0.5 * (w.left + w.right) * whole_width;
  camera.center_y = 0.5 * (w.bottom + w.top) * camera.half_height;
  camera.half_width = share_x * whole_width;
  camera.half_height *= share_y;
  set_axes(camera, view.position - view.target, view.up);
  const double distance = norm(view.position - view.target);
  set_depth_range(camera, bounds, distance > 0 ? distance : 1);
  return camera;
}

Camera make_display_camera(const View& view, double width_px, double height_px, const Bounds& bounds) {
  Camera camera = make_camera(view, width_px, height_px, bounds);
  camera.stretch = Vec3(1.0);
  return camera;
}

double min_pixel_size(const Camera& c, const Bounds& box) {
  double nearest = std::numeric_limits<double>::infinity();
  for (int i = 0; i < 8; ++i) nearest = std::min(nearest, -dot(box.corner(i) - c.position, c.back));
  return pixel_size(c, std::max(0.0, nearest));
}

bool may_be_visible(const Camera& c, const Vec3& centre, double radius) {
  const Vec3 from_eye = centre - c.position;
  const double x = dot(from_eye, c.right), y = dot(from_eye, c.up), depth = -dot(from_eye, c.back);
  if (!c.orthographic && depth < -radius) return false;
  // the four side planes of the view frustum
  const auto reaches = [&](double across, double middle, double half) {
    for (const double side : {-1.0, 1.0}) {
      const double edge = middle + side * half, away = side * (c.orthographic ? across - edge : across - edge * depth);
      if (away > radius * (c.orthographic ? 1 : std::sqrt(1 + edge * edge))) return false;
    }
    return true;
  };
  return reaches(x, c.center_x, c.half_width) && reaches(y, c.center_y, c.half_height);
}

Mat4 view_from_world(const Camera& c) {
  Mat4 m(1.0);
  for (int i = 0; i < 3; ++i) {
    m[i][0] = c.right[i];
    m[i][1] = c.up[i];
    m[i][2] = c.back[i];
  }
  m[3][0] = -dot(c.right, c.position);
  m[3][1] = -dot(c.up, c.position);
  m[3][2] = -dot(c.back, c.position);
  return m;
}

Mat4 clip_from_view(const Camera& c) {
  Mat4 m(0.0);
  m[0][0] = 1 / c.half_width;
  m[1][1] = -1 / c.half_height;
  if (c.orthographic) {
    m[3][0] = -c.center_x / c.half_width;
    m[3][1] = c.center_y / c.half_height;
    m[2][2] = -1 / (c.far - c.near);
    m[3][2] = -c.near / (c.far - c.near);
    m[3][3] = 1;
  } else {
    m[2][0] = c.center_x / c.half_width;
    m[2][1] = -c.center_y / c.half_height;
    m[2][2] = -c.far / (c.far - c.near);
    m[3][2] = -c.far * c.near / (c.far - c.near);
    m[2][3] = -1;
  }
  return m;
}

Mat4 clip_from_world(const Camera& c) { return clip_from_view(c) * view_from_world(c); }

Mat4 world_from_clip(const Camera& c) {
  Mat4 view_from_clip(0.0);
  view_from_clip[0][0] = c.half_width;
  view_from_clip[1][1] = -c.half_height;
  view_from_clip[3][0] = c.center_x;
  view_from_clip[3][1] = c.center_y;
  if (c.orthographic) {
    view_from_clip[2][2] = -(c.far - c.near);
    view_from_clip[3][2] = -c.near;
    view_from_clip[3][3] = 1;
  } else {
    view_from_clip[3][2] = -1;
    view_from_clip[2][3] = -(c.far - c.near) / (c.far * c.near);
    view_from_clip[3][3] = 1 / c.near;
  }
  Mat4 world_from_view(1.0);
  world_from_view[0] = {c.right, 0.0};
  world_from_view[1] = {c.up, 0.0};
  world_from_view[2] = {c.back, 0.0};
  world_from_view[3] = {c.position, 1.0};
  return world_from_view * view_from_clip;
}

Ray pixel_ray(const Camera& c, double x_px, double y_px) {
  const double x = c.center_x + (2 * x_px / c.width - 1) * c.half_width, y = c.center_y + (1 - 2 * y_px / c.height) * c.half_height;
  const Vec3 offset = x * c.right + y * c.up;
  const Vec3 along = c.orthographic ? -c.back : offset - c.back;
  return {(c.orthographic ? c.position + offset : c.position) / c.stretch, direction(along / c.stretch)};
}

std::optional<Vec3> project(const Camera& c, const Vec3& world) {
  const Vec3 d = c.stretch * world - c.position;
  const double depth = -dot(d, c.back);
  if (!c.orthographic && !(depth > 0)) return std::nullopt;
  const double scale = c.orthographic ? 1 : 1 / depth;
  const double x = (dot(d, c.right) * scale - c.center_x) / c.half_width, y = (dot(d, c.up) * scale - c.center_y) / c.half_height;
  return Vec3(0.5 * (x + 1) * c.width, 0.5 * (1 - y) * c.height, depth);
}

Vec3 unproject(const Camera& c, double x_px, double y_px, double depth) {
  const double scale = c.orthographic ? 1 : depth;
  const double x = (c.center_x + (2 * x_px / c.width - 1) * c.half_width) * scale;
  const double y = (c.center_y + (1 - 2 * y_px / c.height) * c.half_height) * scale;
  return (c.position + x * c.right + y * c.up - depth * c.back) / c.stretch;
}

double pixel_size(const Camera& c, double depth) { return 2 * c.half_height / c.height * (c.orthographic ? 1 : std::max(depth, c.near)); }

Vec3 default_view_direction() { return direction(Vec3(0.5, -1.0, 0.45)); }

View fit_view(const Bounds& data_bounds, double aspect, const Vec3& to_camera, double fovy_deg, const Vec3& up) {
  Bounds bounds = data_bounds;
  if (bounds.empty()) {
    bounds.extend(Vec3(-1.0));
    bounds.extend(Vec3(1.0));
  }
  Camera axes;
  set_axes(axes, to_camera, up);
  const double tan_y = std::tan(0.5 * fovy_deg * std::numbers::pi / 180), tan_x = tan_y * aspect;

  // minimum distance at which all corners lie inside the four side planes of the frustum
  double distance = 0, half_height = 0;
  for (int i = 0; i < 8; ++i) {
    const Vec3 q = bounds.corner(i) - bounds.center();
    const double x = std::fabs(dot(q, axes.right)), y = std::fabs(dot(q, axes.up)), z = dot(q, axes.back);
    distance = std::max(distance, z + std::max(x / tan_x, y / tan_y));
    half_height = std::max(half_height, std::max(y, x / aspect));
  }
  if (!(distance > 0)) distance = half_height = 1;  // the bounds are a single point
  View view;
  view.target = bounds.center();
  view.position = view.target + 1.05 * distance * axes.back;
  view.up = std::fabs(dot(axes.back, direction(up))) < 0.999 ? up : axes.up;
  view.fovy_deg = fovy_deg;
  view.height = 2.1 * half_height;
  return view;
}

namespace {

/// Returns the support function max of dot(p, along) over the points, or the quantile that leaves out outlier_share of a cloud.
double support(const std::vector<FitPoints>& clouds, const Vec3& along) {
  double max_distance = -INFINITY;
  std::vector<double> distances;
  for (const FitPoints& cloud : clouds) {
    if (cloud.points.empty()) continue;
    if (cloud.outlier_share == 0) {  // no outliers: the maximum
      for (const Vec3& p : cloud.points) max_distance = std::max(max_distance, dot(p, along));
      continue;
    }
    distances.clear();
    for (const Vec3& p : cloud.points) distances.push_back(dot(p, along));
    const auto n = static_cast<std::ptrdiff_t>((1 - cloud.outlier_share) * static_cast<double>(distances.size() - 1));
    std::nth_element(distances.begin(), distances.begin() + n, distances.end());
    max_distance = std::max(max_distance, distances[static_cast<std::size_t>(n)]);
  }
  return max_distance;
}

}  // namespace

View fit_view(const std::vector<FitPoints>& clouds, double aspect, double width, double height, const Vec3& to_camera, double fovy_deg,
              const Vec3& up) {
  if (std::ranges::all_of(clouds, [](const FitPoints& c) { return c.points.empty(); }))
    return fit_view(Bounds(), aspect, to_camera, fovy_deg, up);
  Camera axes;
  set_axes(axes, to_camera, up);
  const double tan_y = std::tan(0.5 * fovy_deg * std::numbers::pi / 180), tan_x = tan_y * aspect;
  // along an axis of the image: the camera's position, and its minimum distance back
  struct Across {
    double at = 0, back = 0;
  };
  const auto across = [&](const Vec3& axis, double t) {
    const double high = support(clouds, axis + t * axes.back), low = support(clouds, -1.0 * axis + t * axes.back);
    return Across{0.5 * (high - low), 0.5 * (high + low) / t};
  };
  const Across x = across(axes.right, width * tan_x), y = across(axes.up, height * tan_y);
  const double near = support(clouds, axes.back), far = -support(clouds, -1.0 * axes.back);
  const double middle = 0.5 * (near + far);
  double back = std::max(x.back, y.back);
  if (!(back > near))
    back =
        near + std::max(1e-6 * std::fabs(near), near > far ? near - far : 1.0);  // the points are a single point, or lie on a line of sight
  View view;
  view.target = x.at * axes.right + y.at * axes.up + middle * axes.back;
  view.position = view.target + (back - middle) * axes.back;
  view.up = std::fabs(dot(axes.back, direction(up))) < 0.999 ? up : axes.up;
  view.fovy_deg = fovy_deg;
  view.height = 2 * tan_y * (back - middle);
  return view;
}

namespace {

Vec3 turned_about(const Vec3& axis, double degrees, const Vec3& v) {
  const double angle = degrees * std::numbers::pi / 180;
  return v * std::cos(angle) + cross(axis, v) * std::sin(angle) + axis * (dot(axis, v) * (1 - std::cos(angle)));
}

}  // namespace

View orbit_view(const View& view, double azimuth_deg, double elevation_deg) {
  View moved = view;
  const Vec3 axis = direction(view.up);
  Vec3 arm = view.position - view.target;
  if (elevation_deg != 0) {
    const Camera camera = make_camera(view, 1, 1, {});
    // about the right axis, backwards: the camera rises towards up
    arm = turned_about(camera.right, -elevation_deg, arm);
    moved.up = turned_about(camera.right, -elevation_deg, camera.up);
  }
  moved.position = moved.target + turned_about(axis, azimuth_deg, arm);
  if (elevation_deg != 0) moved.up = turned_about(axis, azimuth_deg, moved.up);
  return moved;
}

View zoom_view(const View& view, double factor) {
  View closer = view;
  const double half = 0.5 * view.fovy_deg * std::numbers::pi / 180;
  closer.fovy_deg = 2 * std::atan(std::tan(half) / factor) * 180 / std::numbers::pi;
  closer.height = view.height / factor;
  return closer;
}

std::optional<Vec3> axis_direction(std::string_view name) {
  if (name == "iso") return direction(Vec3(1.0, -1.0, 1.0));
  if (name.size() != 2 || (name[0] != '+' && name[0] != '-') || name[1] < 'x' || name[1] > 'z') return std::nullopt;
  Vec3 to_camera(0.0);
  to_camera[name[1] - 'x'] = name[0] == '+' ? -1 : 1;
  return to_camera;
}

std::optional<View> axis_view(const Bounds& bounds, double aspect, std::string_view name, double fovy_deg) {
  const auto to_camera = axis_direction(name);
  if (!to_camera) return std::nullopt;
  return fit_view(bounds, aspect, *to_camera, fovy_deg);
}

View refit_view(const View& view, const Bounds& bounds, double aspect) {
  View fit = fit_view(bounds, aspect, view.position - view.target, view.fovy_deg, view.up);
  fit.orthographic = view.orthographic;
  fit.stretch = view.stretch;
  return fit;
}

}  // namespace catena::render
