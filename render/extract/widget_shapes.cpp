#include "render/extract/widget_shapes.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "render/extract/plane_outline.h"

namespace catena::render {
namespace {

constexpr double kLeastTubePx = 0.9, kLeastBallPx = 3;  // radii
constexpr double kHeadWidth = 0.38;                     // a cone's radius by its length
constexpr double kLeastHeadPx = 9;
constexpr int kCircleSteps = 72;

}  // namespace

Color mixed(const Color& a, const Color& b, float share_of_b) {
  return {a.r + share_of_b * (b.r - a.r), a.g + share_of_b * (b.g - a.g), a.b + share_of_b * (b.b - a.b)};
}

Color brighter(const Color& color, float share) {
  const float more = 1 + 0.6f * share;  // what is lit stays below its colour
  return mixed({more * color.r, more * color.g, more * color.b}, {1, 1, 1}, 0.55f * share);
}

Color axis_color(int axis) {
  constexpr Color kAxes[3] = {{0.98f, 0.30f, 0.27f}, {0.32f, 0.80f, 0.32f}, {0.34f, 0.56f, 1.0f}};
  return kAxes[axis];
}

WidgetShapes::WidgetShapes(FramePacket& packet)
    : items_(&packet.widgets), camera_(make_camera(packet.view, packet.width, packet.height, {})) {}

double WidgetShapes::pixel_at(const Vec3& p) const {
  const double depth = dot(camera_.position - p, camera_.back);
  return depth > 0 || camera_.orthographic ? pixel_size(camera_, depth) : 0;
}

Vec3 WidgetShapes::towards_eye(const Vec3& p) const { return camera_.orthographic ? camera_.back : direction(camera_.position - p); }

void WidgetShapes::tube(std::vector<Vec3> points, double weight, const Color& color) {
  double radius = line_;
  for (const Vec3& p : points) radius = std::max(radius, kLeastTubePx * pixel_at(p));
  add(std::move(points), weight * radius, color);
}

void WidgetShapes::add(std::vector<Vec3> points, double radius, const Color& color) {
  TubeItem item;
  item.points = std::move(points);
  item.radius = radius;
  item.color = color;
  item.id = id_;
  item.clipped = false;
  items_->tubes.push_back(std::move(item));
}

void WidgetShapes::loop(std::span<const Vec3> points, double weight, const Color& color) {
  std::vector<Vec3> closed(points.begin(), points.end());
  if (!closed.empty()) closed.push_back(closed.front());
  tube(std::move(closed), weight, color);
}

void WidgetShapes::circle(const Vec3& centre, const Vec3& normal, double radius, double weight, const Color& color) {
  const auto [u, v] = across(direction(normal));
  std::vector<Vec3> points;
  for (int k = 0; k < kCircleSteps; ++k) {
    const double angle = 2 * std::numbers::pi * k / kCircleSteps;
    points.push_back(centre + radius * std::cos(angle) * u + radius * std::sin(angle) * v);
  }
  loop(points, weight, color);
}

void WidgetShapes::plate(const Vec3& middle, const Vec3& u, const Vec3& v, const Color& color) {
  auto geometry = std::make_shared<MeshGeometry>();
  geometry->vertices = {middle + u + v, middle - u + v, middle - u - v, middle + u - v};
  geometry->triangles = {0, 1, 2, 0, 2, 3};
  items_->meshes.push_back({std::move(geometry), color, id_, false});
}

void WidgetShapes::ball(const Vec3& centre, double radius, const Color& color) { add({centre}, ball_radius(centre, radius), color); }

double WidgetShapes::ball_radius(const Vec3& centre, double radius) const { return std::max(radius, kLeastBallPx * pixel_at(centre)); }

void WidgetShapes::arrow(const Vec3& from, const Vec3& tip, double weight, double head, const Color& color) {
  const double length = norm(tip - from);
  if (!(length > 0)) return;
  const double cone = std::min(std::max(head, kLeastHeadPx * pixel_at(tip)), 0.6 * length);
  const Vec3 along = direction(tip - from), neck = tip - cone * along;
  tube({from, neck}, weight, color);
  ArrowItem item;
  item.base = neck;
  item.tip = tip;
  item.radius = std::max(kHeadWidth * cone, 1.6 * items_->tubes.back().radius);
  item.color = color;
  item.id = id_;
  item.clipped = false;
  items_->arrows.push_back(item);
}

void WidgetShapes::double_arrow(const Vec3& middle, const Vec3& half, double weight, double head, const Color& color) {
  arrow(middle, middle + half, weight, head, color);
  arrow(middle, middle - half, weight, head, color);
}

}  // namespace catena::render
