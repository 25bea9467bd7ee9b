// SPDX-License-Identifier: MIT
#include "engine/app/viewer/input/widget_drag.h"

#include <cmath>
#include <numbers>
#include <span>

#include "engine/widget/cutting_plane.h"
#include "engine/widget/state_machine.h"
#include "render/extract/stretch.h"
#include "render/extract/widget_shapes.h"

namespace catena::app {

namespace {

using widget::Kind;

constexpr int kCircleSegments = 64;
constexpr double kFlat = 0.25;  // cosine of the angle between ray and circle's axis below which the circle is seen from its edge

/// Point of the segment a..b that is nearest to the ray.
Vec3 nearest_on_segment(const render::Ray& ray, const Vec3& a, const Vec3& b) {
  const Vec3 d = b - a, w = ray.origin - a;
  const double along = dot(d, ray.direction), square = dot(d, d), determinant = square - along * along;
  // parallel to the ray: all points are as near
  const double t = determinant > 1e-12 * square ? (dot(d, w) - along * dot(ray.direction, w)) / determinant : 0;
  return a + std::clamp(t, 0.0, 1.0) * d;
}

/// Search for the part nearest to a ray.
class PartSearch {
 public:
  PartSearch(const render::Camera& camera, const Bounds& drawn, double x, double y)
      : camera_(camera), size_scale_(render::size_scale(drawn, camera.stretch)) {
    render::Camera display = camera;
    display.stretch = Vec3(1.0);
    ray_ = render::pixel_ray(display, x, y);
  }

  /// Offers a point of the world; parts of a lower rank come first.
  void offer(const Vec3& p, int rank, const WidgetPart& part, double radius = 0) {
    const Vec3 shown = camera_.stretch * p;
    const double depth = dot(ray_.direction, shown - ray_.origin), away = norm(shown - ray_.origin - depth * ray_.direction);
    if (!(depth > 0)) return;
    const auto place = render::project(camera_, p);
    if (!place) return;
    const double pixel = render::pixel_size(camera_, place->z), px = std::max(0.0, away - size_scale_ * radius) / pixel;
    if (!(px <= kWidgetTolerancePx) || (found_ && (rank > rank_ || (rank == rank_ && px >= px_)))) return;
    found_ = part;
    found_->point = p;
    found_->pixel = pixel;
    rank_ = rank;
    px_ = px;
  }
  void offer_line(std::span<const Vec3> points, bool closed, int rank, const WidgetPart& part) {
    for (std::size_t i = 0; i + (closed ? 0 : 1) < points.size(); ++i)
      offer(nearest_on_segment(ray_, camera_.stretch * points[i], camera_.stretch * points[(i + 1) % points.size()]) / camera_.stretch,
            rank, part);
  }
  const std::optional<WidgetPart>& found() const { return found_; }

 private:
  const render::Camera& camera_;
  double size_scale_;  ///< display units per world unit of radii
  render::Ray ray_;    ///< in display units
  std::optional<WidgetPart> found_;
  int rank_ = 0;
  double px_ = 0;
};

constexpr int kHandleRank = 0, kArrowRank = 1, kCircleRank = 2, kLineRank = 3;

void offer_cutting_plane(PartSearch& search, WidgetPart part, const scene::Widget& widget, const Bounds& drawn) {
  const Vec3& center = widget.report.pose.points[0];
  const auto axis = [&](int i) { return widget::frame_axis(widget.report.pose.orientation, i); };
  const double radius = widget.spec.radius;
  part.handle = 0;
  const Vec3 arrow[] = {center, center + widget::kArrowLength * radius * axis(2)};
  search.offer_line(arrow, false, kArrowRank, part);
  search.offer_line(render::plane_outline(center, axis(2), drawn), true, kLineRank, part);
  part.handle = -1;
  for (part.axis = 0; part.axis < 3; ++part.axis) {
    const Vec3 u = axis((part.axis + 1) % 3), v = axis((part.axis + 2) % 3);
    std::vector<Vec3> circle;
    for (int k = 0; k < kCircleSegments; ++k) {
      const double angle = 2 * std::numbers::pi * k / kCircleSegments;
      circle.push_back(center + radius * std::cos(angle) * u + radius * std::sin(angle) * v);
    }
    search.offer_line(circle, true, kCircleRank, part);
  }
}

void offer_handles(PartSearch& search, WidgetPart part, const scene::Widget& widget) {
  const Kind kind = widget.spec.kind;
  const widget::Pose& pose = widget.report.pose;
  for (part.handle = 0; part.handle < widget::handle_count(kind); ++part.handle)
    search.offer(widget::handle_position(kind, pose, part.handle), kHandleRank, part, widget.spec.radius);
  part.handle = static_cast<std::int8_t>(widget::handle_count(kind) - 1);  // the one that moves the whole widget
  if (kind == Kind::rake || kind == Kind::ruler) search.offer_line(pose.points, false, kLineRank, part);
  if (kind != Kind::box) return;
  Bounds box;
  for (const Vec3& p : pose.points) box.extend(p);
  for (int i = 0; i < 8; ++i)
    for (int axis = 1; axis < 8; axis *= 2) {
      const Vec3 edge[] = {box.corner(i), box.corner(i | axis)};
      if ((i & axis) == 0) search.offer_line(edge, false, kLineRank, part);
    }
}

}  // namespace

std::optional<WidgetPart> find_widget_part(const scene::Scene& scene, const Bounds& drawn, const render::Camera& camera, double x,
                                           double y) {
  PartSearch search(camera, drawn, x, y);
  scene.entities.each<scene::Widget>([&](scene::Entity e, const scene::Widget& widget) {
    if (!widget.is_complete) return;
    if (widget.spec.kind == Kind::cutting_plane)
      offer_cutting_plane(search, {e}, widget, drawn);
    else
      offer_handles(search, {e}, widget);
  });
  return search.found();
}

WidgetDrag::WidgetDrag(const scene::Widget& widget, const WidgetPart& part, const render::Camera& camera) : spec_(widget.spec) {
  spec_.along_links.clear();
  widget::reset_state(spec_, state_);
  state_.pose = state_.start_pose = widget.report.pose;
  state_.value = widget.report.value;
  state_.is_gripped = true;
  if (part.axis >= 0) {
    state_.mode = widget::Mode::turn;
    state_.axis = part.axis;
    state_.grip = {part.point, state_.pose.orientation, 0, 0};
    center_ = state_.pose.points[0];
    axis_ = widget::frame_axis(state_.pose.orientation, part.axis);
    const double facing = std::fabs(dot(axis_, direction(part.point - camera.position / camera.stretch)));
    path_ = facing > kFlat ? Path::circle : Path::sphere;
    state_.arm = widget::perpendicular_direction(part.point - center_, axis_);
    return;
  }
  state_.mode = widget::Mode::drag;
  state_.handle = part.handle;
  state_.grip = widget::make_grip(spec_, state_, part.point);
  state_.grip.free_axes = static_cast<std::uint8_t>(7u & ~state_.grip.fixed_axes);
  state_.active_planes = state_.grip.fixed_axes;
  axis_ = direction(camera.stretch * camera.back);  // of the plane of the image, in the world
  for (int i = 0; i < 3; ++i)
    if (state_.grip.free_axes == 1u << i) {
      path_ = Path::line;
      axis_ = widget::frame_axis(state_.grip.frame, i);
    }
}

/// Point of the path at the pointer.
Vec3 WidgetDrag::follow(const render::Camera& camera, double x, double y) const {
  const Vec3& from = state_.grip.grab_point;
  const render::Ray ray = render::pixel_ray(camera, x, y);
  if (path_ == Path::line) {
    const Vec3 w = ray.origin - from;
    const double along = dot(axis_, ray.direction), determinant = 1 - along * along;
    if (determinant < 1e-4) return from;  // seen end on
    return from + (dot(axis_, w) - along * dot(ray.direction, w)) / determinant * axis_;
  }
  if (path_ == Path::sphere) {
    const Vec3 w = ray.origin - center_;
    const double radius = norm(from - center_), along = dot(ray.direction, w), square = along * along - dot(w, w) + radius * radius;
    // beyond the rim: the rim's point beside the pointer
    return square > 0 ? ray.origin + (-along - std::sqrt(square)) * ray.direction : ray.origin - along * ray.direction;
  }
  const Vec3& origin = path_ == Path::circle ? center_ : from;
  const double rate = dot(axis_, ray.direction);
  if (std::fabs(rate) < 1e-4) return from;
  const double t = dot(axis_, origin - ray.origin) / rate;
  return t > 0 ? ray.origin + t * ray.direction : from;
}

widget::Pose WidgetDrag::pose_at(const render::Camera& camera, double x, double y) const {
  widget::State state = state_;
  widget::update_pose(spec_, state, follow(camera, x, y));
  return state.pose;
}

}  // namespace catena::app
