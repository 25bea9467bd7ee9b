/// Where a plane cuts a box: a convex polygon of 3 to 6 corners, in order around the normal. World units. Any thread.
#pragma once
#include <span>
#include <vector>

#include "render/frame/camera.h"
#include "render/frame/frame_packet.h"

namespace catena::render {

/// Two unit vectors across `normal` (unit), right-handed with it.
struct PlaneBasis {
  Vec3 u, v;
};
PlaneBasis make_plane_basis(const Vec3& normal);

/// Empty where they do not meet in an area. A face of the box that lies in the plane is its outline.
std::vector<Vec3> plane_outline(const Vec3& point, const Vec3& normal, const Bounds& box);

/// Private to this room: the parts that widgets are drawn with, none too thin for the view. Frame thread.
Color mix_colors(const Color& a, const Color& b, float share_of_b);
/// Brighter and a little towards white; 0: as it is.
Color brighten(const Color& color, float share);
/// Red, green, blue: the colour of axis 0, 1, 2.
Color axis_color(int axis);

class WidgetShapes {
 public:
  /// Appends to the packet's widgets, for the packet's view.
  explicit WidgetShapes(FramePacket& packet);
  /// What is drawn from now on belongs to it. Its lines have this radius, or the least that is seen from the eye, times their weight.
  void begin_object(std::uint32_t id, double line) {
    id_ = id;
    line_radius_ = line;
  }

  void tube(std::vector<Vec3> points, double weight, const Color& color);
  /// Through the points and back to the first.
  void loop(std::span<const Vec3> points, double weight, const Color& color);
  void circle(const Vec3& centre, const Vec3& normal, double radius, double weight, const Color& color);
  /// A filled parallelogram, middle +- u +- v.
  void parallelogram(const Vec3& middle, const Vec3& u, const Vec3& v, const Color& color);
  void sphere(const Vec3& centre, double radius, const Color& color);
  /// A shaft with a cone at its tip, `head` long.
  void arrow(const Vec3& from, const Vec3& tip, double weight, double head, const Color& color);
  void double_arrow(const Vec3& middle, const Vec3& half, double weight, double head, const Color& color);

  /// Or the least that a ball there may have.
  double visible_radius(const Vec3& centre, double radius) const;
  /// Unit.
  Vec3 direction_to_camera(const Vec3& p) const;

 private:
  void add(std::vector<Vec3> points, double radius, const Color& color);
  /// World units of a pixel at a place; 0 behind the eye.
  double pixel_size_at(const Vec3& p) const;

  WidgetItems* items_;
  Camera camera_;
  std::uint32_t id_ = 0;
  double line_radius_ = 0;
};

}  // namespace catena::render
