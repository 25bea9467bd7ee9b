// SPDX-License-Identifier: MIT
#include "render/extract/extract_internal.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "engine/scene/ruler.h"
#include "engine/widget/cutting_plane.h"
#include "render/extract/widget_shapes.h"

namespace catena::render {
namespace {

using widget::Kind;
using widget::Mode;

// shares of L, the length that a widget's sizes follow
constexpr double kSphere = 0.12, kBall = 0.012, kLine = 0.0035;
// shares of the sphere's radius
constexpr double kFreeLength = 2.1, kHead = 0.34, kGrabbedSquare = 0.36;
// shares of the handle's radius
constexpr double kGradientLength = 6, kHandleLength = 7, kHandleHead = 2.4, kHandleSquare = 2.8;

double length_of(const scene::Widget& widget) { return widget.spec.length > 0 ? widget.spec.length : 4; }

double radius_of(const scene::Widget& widget) {
  if (widget.spec.radius > 0) return widget.spec.radius;
  return (widget.spec.kind == Kind::cutting_plane ? kSphere : kBall) * length_of(widget);
}

bool is_held(const scene::Widget& widget, int axis) { return (widget.report.active_planes >> axis & 1) != 0; }

Vec3 axis_of(const scene::Widget& widget, int axis) {
  Vec3 e(0.0);
  e[axis] = 1;
  return rotate(widget.report.pose.orientation, e);
}

bool is_drawable(const scene::Widget& widget) {
  const widget::Pose& pose = widget.report.pose;
  return is_finite(pose.points[0]) && is_finite(pose.points[1]) && is_finite(pose.orientation) && std::isfinite(radius_of(widget));
}

bool is_measured(const scene::Widget& widget) { return widget.spec.kind == Kind::ruler && is_drawable(widget); }

/// Draws a double arrow along each free axis and a square across each held axis.
void draw_axes(WidgetShapes& shapes, const scene::Widget& widget, const Vec3& at, double reach, double square, double head) {
  for (int i = 0; i < 3; ++i) {
    if (is_held(widget, i))
      shapes.parallelogram(at, square * axis_of(widget, (i + 1) % 3), square * axis_of(widget, (i + 2) % 3), axis_color(i));
    else
      shapes.double_arrow(at, reach * axis_of(widget, i), 1.8, head, brighten(axis_color(i), 0.2f));
  }
}

void draw_border(WidgetShapes& shapes, const scene::Widget& widget, const Bounds& drawn) {
  const Vec3 &centre = widget.report.pose.points[0], normal = axis_of(widget, 2);
  std::vector<Vec3> border = plane_outline(centre, normal, drawn);
  if (border.empty()) {
    const Vec3 u = 0.5 * length_of(widget) * axis_of(widget, 0), v = 0.5 * length_of(widget) * axis_of(widget, 1);
    border = {centre + u + v, centre - u + v, centre - u - v, centre + u - v};
  }
  const bool explored = widget.report.mode == Mode::explore, moved = widget.report.mode == Mode::translate;
  const Color color = widget.color;
  shapes.loop(border, explored ? 2.2 : moved ? 1.6 : 1, explored ? brighten(color, 0.6f) : color);
}

/// Draws the arrow along the normal; its width and brightness show hover and drag.
void draw_arrow(WidgetShapes& shapes, const scene::Widget& widget, const Vec3& centre, double radius) {
  const bool hovered = widget.report.mode == Mode::hover, dragged = widget.report.mode == Mode::drag;
  const Vec3 tip = centre + widget::kArrowLength * radius * axis_of(widget, 2);
  shapes.arrow(centre, tip,
               dragged   ? 3.2
               : hovered ? 2.4
                         : 1.5,
               kHead * radius,
               brighten(widget.color, dragged   ? 0.7f
                                      : hovered ? 0.4f
                                                : 0));
}

void draw_cutting_plane(WidgetShapes& shapes, const scene::Widget& widget, const Bounds& drawn) {
  const Vec3& centre = widget.report.pose.points[0];
  const double radius = radius_of(widget);
  const Mode mode = widget.report.mode;
  const bool turns = mode == Mode::turn, rotates = turns || mode == Mode::rotate, moves = mode == Mode::translate;
  draw_border(shapes, widget, drawn);
  for (int i = 0; i < 3; ++i) {
    const bool active = rotates && is_held(widget, i);
    const Color muted = mix_colors(axis_color(i), {0.5f, 0.5f, 0.5f}, rotates ? 0 : moves ? 0.7f : 0.2f);
    const Color color = active ? brighten(axis_color(i), turns ? 0.9f : 0.6f) : muted;
    const double weight = active ? 3.2 : turns ? 2.2 : rotates ? 1.8 : 1;
    shapes.circle(centre, axis_of(widget, i), radius, weight, color);
  }
  if (moves)
    draw_axes(shapes, widget, centre, kFreeLength * radius, kGrabbedSquare * radius, kHead * radius);
  else
    draw_arrow(shapes, widget, centre, radius);
}

/// Draws a handle as a ball; its size and brightness show hover and drag.
void draw_handle(WidgetShapes& shapes, const scene::Widget& widget, int handle, const Vec3& at, double radius) {
  const bool mine = widget.report.handle == handle || widget.spec.kind == Kind::seed || widget.spec.kind == Kind::isolevel;
  const bool hovered = mine && widget.report.mode == Mode::hover, dragged = mine && widget.report.mode == Mode::drag;
  const Color color = brighten(widget.color, dragged ? 0.7f : hovered ? 0.4f : 0);
  shapes.sphere(at, (dragged ? 1.5 : hovered ? 1.4 : 1) * shapes.visible_radius(at, radius), color);
}

bool is_dragged(const scene::Widget& widget) { return widget.report.mode == Mode::drag; }

void draw_handle_axes(WidgetShapes& shapes, const scene::Widget& widget, const Vec3& at) {
  const double r = shapes.visible_radius(at, radius_of(widget));
  draw_axes(shapes, widget, at, kHandleLength * r, kHandleSquare * r, kHandleHead * r);
}

void draw_seed(WidgetShapes& shapes, const scene::Widget& widget) {
  const Vec3& at = widget.report.pose.points[0];
  const double radius = shapes.visible_radius(at, radius_of(widget));
  draw_handle(shapes, widget, 0, at, radius);
  if (is_dragged(widget)) return draw_handle_axes(shapes, widget, at);
  const bool hovered = widget.report.mode == Mode::hover;
  shapes.circle(at, shapes.direction_to_camera(at), (hovered ? 2.6 : 2.1) * radius, 0.8, widget.color);
}

/// Draws a rake's line of seeds, or a ruler with its measured path.
void draw_line(WidgetShapes& shapes, const scene::Widget& widget, const scene::RulerMeasure* ruler) {
  const auto& [a, b] = widget.report.pose.points;
  const Vec3 middle = 0.5 * a + 0.5 * b;
  const double radius = radius_of(widget);
  const bool bent = ruler != nullptr && ruler->path_kind != scene::RulerMeasure::PathKind::straight;
  const Color color = widget.color;
  shapes.tube({a, b}, bent ? 0.8 : 1.2, bent ? mix_colors(color, {0.5f, 0.5f, 0.5f}, 0.6f) : color);
  if (bent) shapes.tube(ruler->points, 1.6, color);
  draw_handle(shapes, widget, 0, a, radius);
  draw_handle(shapes, widget, 1, b, radius);
  draw_handle(shapes, widget, 2, middle, 0.8 * radius);
  if (is_dragged(widget)) draw_handle_axes(shapes, widget, widget.report.handle == 0 ? a : widget.report.handle == 1 ? b : middle);
}

void draw_isolevel(WidgetShapes& shapes, const scene::Widget& widget) {
  const Vec3& at = widget.report.pose.points[0];
  const double radius = shapes.visible_radius(at, radius_of(widget));
  draw_handle(shapes, widget, 0, at, radius);
  if (!widget.spec.field) return;
  field::Cursor cursor;
  const Vec3 along = direction(widget.spec.field->sample(at, cursor).gradient);
  if (max_abs(along) == 0) return;
  const Color color = widget.color;
  shapes.arrow(at, at + kGradientLength * radius * along, 1, kHandleHead * radius, color);
  if (is_dragged(widget)) shapes.arrow(at, at - kGradientLength * radius * along, 1, kHandleHead * radius, color);
}

void draw_box(WidgetShapes& shapes, const scene::Widget& widget) {
  Bounds box;
  for (const Vec3& p : widget.report.pose.points) box.extend(p);
  const Color color = widget.color;
  const double radius = radius_of(widget);
  for (int i = 0; i < 8; ++i)
    for (int axis = 1; axis < 8; axis *= 2)
      if ((i & axis) == 0) shapes.tube({box.corner(i), box.corner(i | axis)}, 1, color);
  for (int face = 0; face < 6; ++face) {
    Vec3 at = box.center(), out(0.0);
    at[face / 2] = face % 2 ? box.hi[face / 2] : box.lo[face / 2];
    out[face / 2] = kHandleLength * shapes.visible_radius(at, radius);
    draw_handle(shapes, widget, face, at, radius);
    if (is_dragged(widget) && widget.report.handle == face)
      shapes.double_arrow(at, out, 1.5, kHandleHead / kHandleLength * norm(out), brighten(axis_color(face / 2), 0.15f));
  }
  draw_handle(shapes, widget, 6, box.center(), 1.2 * radius);
  if (is_dragged(widget) && widget.report.handle == 6) draw_handle_axes(shapes, widget, box.center());
}

void draw(WidgetShapes& shapes, const scene::Widget& widget, const scene::RulerMeasure* ruler, const Bounds& drawn) {
  switch (widget.spec.kind) {
    case Kind::cutting_plane:
      return draw_cutting_plane(shapes, widget, drawn);
    case Kind::seed:
      return draw_seed(shapes, widget);
    case Kind::isolevel:
      return draw_isolevel(shapes, widget);
    case Kind::box:
      return draw_box(shapes, widget);
    case Kind::rake:
    case Kind::ruler:
      return draw_line(shapes, widget, ruler);
  }
}

/// Returns the midpoint of a polyline by arc length.
Vec3 halfway(const std::vector<Vec3>& points) {
  double length = 0;
  for (std::size_t i = 1; i < points.size(); ++i) length += norm(points[i] - points[i - 1]);
  double left = 0.5 * length;
  for (std::size_t i = 1; i < points.size(); ++i) {
    const double step = norm(points[i] - points[i - 1]);
    if (step > 0 && left <= step) return points[i - 1] + (left / step) * (points[i] - points[i - 1]);
    left -= step;
  }
  return points.empty() ? Vec3(0.0) : points.back();
}

/// Returns the object id of a widget; an existing widget keeps its id when it is extracted again.
std::uint32_t id_of(FramePacket& packet, const std::string& name) {
  for (const ObjectName& object : packet.objects)
    if (object.kind == "widget" && object.name == name) return object.id;
  return packet.add_object("widget", name);
}

}  // namespace

void update_widgets(const scene::Scene& scene, const Bounds& drawn, FramePacket& packet) {
  packet.widgets = {};
  WidgetShapes shapes(packet);
  const Bounds world = drawn.scaled(1.0 / scene.stretch);
  scene.entities.each<scene::Widget>([&](scene::Entity e, const scene::Widget& widget) {
    if (!is_drawable(widget)) return;
    shapes.begin_object(id_of(packet, entity_name(scene, e)), kLine * length_of(widget));
    draw(shapes, widget, scene::find_ruler_measure(scene, e), world);
  });
}

Outcome prepare_widgets(scene::Scene& scene) {
  for (const scene::Entity e : entities_with<scene::Widget>(scene.entities))
    if (is_measured(scene.entities.get<scene::Widget>(e))) CATENA_CHECK(scene::resolve_ruler(scene, e));
  return Done{};
}

void extract_widgets(const scene::Scene& scene, const Bounds& drawn, FramePacket& packet) {
  scene.entities.each<scene::Widget>([&](scene::Entity e, const scene::Widget& widget) {
    if (!is_measured(widget)) return;
    const scene::RulerMeasure& measure = *scene::find_ruler_measure(scene, e);
    LabelItem label;
    label.position = scene.stretch * halfway(measure.points);
    label.text = fmt::format("{:.4g} units{}", measure.length, measure.note.empty() ? "" : " (straight)");
    label.anchor = Anchor::bottom_left;
    label.offset_pt = {6.0, -6.0};
    packet.overlay.labels.push_back(std::move(label));
  });
  update_widgets(scene, drawn, packet);
}

}  // namespace catena::render
