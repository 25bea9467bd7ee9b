// SPDX-License-Identifier: MIT
#include "render/extract/widget_shapes.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace catena::render {

PlaneBasis make_plane_basis(const Vec3& normal) {
  const Vec3 axis = std::fabs(normal.x) < 0.6 ? Vec3(1.0, 0.0, 0.0) : Vec3(0.0, 1.0, 0.0);
  const Vec3 u = direction(cross(axis, normal));
  return {u, cross(normal, u)};
}

std::vector<Vec3> plane_outline(const Vec3& point, const Vec3& normal, const Bounds& box) {
  const Vec3 n = direction(normal);
  if (box.empty() || max_abs(n) == 0) return {};
  const double flat = 1e-9 * box.diagonal();  // corners within this distance count as in the plane
  std::array<double, 8> height;
  std::vector<Vec3> corners;
  for (int i = 0; i < 8; ++i) {
    height[std::size_t(i)] = dot(box.corner(i) - point, n);
    if (std::fabs(height[std::size_t(i)]) <= flat) corners.push_back(box.corner(i));
  }
  for (int i = 0; i < 8; ++i)
    for (int axis = 1; axis < 8; axis *= 2) {
      if ((i & axis) != 0) continue;
      const double a = height[std::size_t(i)], b = height[std::size_t(i | axis)];
      if (std::fabs(a) <= flat || std::fabs(b) <= flat || (a > 0) == (b > 0)) continue;
      corners.push_back(box.corner(i) + (a / (a - b)) * (box.corner(i | axis) - box.corner(i)));
    }
  if (corners.size() < 3) return {};

  // in order around their centroid
  Vec3 middle(0.0);
  for (const Vec3& p : corners) middle += p / double(corners.size());
  const auto [u, v] = make_plane_basis(n);
  const auto angle = [&](const Vec3& p) { return std::atan2(dot(p - middle, v), dot(p - middle, u)); };
  std::sort(corners.begin(), corners.end(), [&](const Vec3& a, const Vec3& b) { return angle(a) < angle(b); });
  return corners;
}

namespace {

constexpr double kMinTubePx = 0.9, kMinBallPx = 3;  // minimum radii on the screen
constexpr double kHeadWidth = 0.38;                 // cone radius / cone length
constexpr double kMinHeadPx = 9;
constexpr int kCircleSteps = 72;

}  // namespace

Color mix_colors(const Color& a, const Color& b, float share_of_b) {
  return {a.r + share_of_b * (b.r - a.r), a.g + share_of_b * (b.g - a.g), a.b + share_of_b * (b.b - a.b)};
}

Color brighten(const Color& color, float share) {
  const float more = 1 + 0.6f * share;  // tube and ball colors are shaded, so that they stay below the plain color
  return mix_colors({more * color.r, more * color.g, more * color.b}, {1, 1, 1}, 0.55f * share);
}

Color axis_color(int axis) {
  constexpr Color kAxes[3] = {{0.98f, 0.30f, 0.27f}, {0.32f, 0.80f, 0.32f}, {0.34f, 0.56f, 1.0f}};
  return kAxes[axis];
}

WidgetShapes::WidgetShapes(FramePacket& packet)
    : items_(&packet.widgets),
      camera_(make_display_camera(packet.view, packet.width, packet.height, {})),
      stretch_(packet.view.stretch),
      size_scale_(packet.size_scale) {}

double WidgetShapes::pixel_size_at(const Vec3& p) const {
  const double depth = dot(camera_.position - stretch_ * p, camera_.back);
  return depth > 0 || camera_.orthographic ? pixel_size(camera_, depth) / size_scale_ : 0;
}

Vec3 WidgetShapes::direction_to_camera(const Vec3& p) const {
  return direction(stretch_ * (camera_.orthographic ? camera_.back : direction(camera_.position - stretch_ * p)));
}

void WidgetShapes::tube(std::vector<Vec3> points, double weight, const Color& color) {
  double radius = line_radius_;
  for (const Vec3& p : points) radius = std::max(radius, kMinTubePx * pixel_size_at(p));
  add(std::move(points), weight * radius, color);
}

void WidgetShapes::add(std::vector<Vec3> points, double radius, const Color& color) {
  TubeItem item;
  for (Vec3& p : points) p *= stretch_;
  item.points = std::move(points);
  item.radius = size_scale_ * radius;
  item.color = color;
  item.id = id_;
  item.is_clipped = false;
  items_->tubes.push_back(std::move(item));
}

void WidgetShapes::loop(std::span<const Vec3> points, double weight, const Color& color) {
  std::vector<Vec3> closed(points.begin(), points.end());
  if (!closed.empty()) closed.push_back(closed.front());
  tube(std::move(closed), weight, color);
}

void WidgetShapes::circle(const Vec3& centre, const Vec3& normal, double radius, double weight, const Color& color) {
  const auto [u, v] = make_plane_basis(direction(normal));
  std::vector<Vec3> points;
  for (int k = 0; k < kCircleSteps; ++k) {
    const double angle = 2 * std::numbers::pi * k / kCircleSteps;
    points.push_back(centre + radius * std::cos(angle) * u + radius * std::sin(angle) * v);
  }
  loop(points, weight, color);
}

void WidgetShapes::parallelogram(const Vec3& middle, const Vec3& u, const Vec3& v, const Color& color) {
  auto geometry = std::make_shared<MeshGeometry>();
  geometry->vertices = {middle + u + v, middle - u + v, middle - u - v, middle + u - v};
  for (Vec3& p : geometry->vertices) p *= stretch_;
  geometry->triangles = {0, 1, 2, 0, 2, 3};
  items_->meshes.push_back({std::move(geometry), color, id_, false});
}

void WidgetShapes::sphere(const Vec3& centre, double radius, const Color& color) { add({centre}, visible_radius(centre, radius), color); }

double WidgetShapes::visible_radius(const Vec3& centre, double radius) const {
  return std::max(radius, kMinBallPx * pixel_size_at(centre));
}

void WidgetShapes::arrow(const Vec3& from, const Vec3& tip, double weight, double head, const Color& color) {
  const double length = norm(tip - from);
  if (!(length > 0)) return;
  const Vec3 along = direction(tip - from);
  const double display_per_world = norm(stretch_ * along) / size_scale_;  // of lengths along the arrow, against radii
  const double cone = std::min(std::max(head, kMinHeadPx * pixel_size_at(tip)), 0.6 * length * display_per_world);
  const Vec3 neck = tip - cone / display_per_world * along;
  tube({from, neck}, weight, color);
  ArrowItem item;
  item.base = stretch_ * neck;
  item.tip = stretch_ * tip;
  item.radius = std::max(kHeadWidth * cone * size_scale_, 1.6 * items_->tubes.back().radius);
  item.color = color;
  item.id = id_;
  item.is_clipped = false;
  items_->arrows.push_back(item);
}

void WidgetShapes::double_arrow(const Vec3& middle, const Vec3& half, double weight, double head, const Color& color) {
  arrow(middle, middle + half, weight, head, color);
  arrow(middle, middle - half, weight, head, color);
}

}  // namespace catena::render
