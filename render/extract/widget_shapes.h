// SPDX-License-Identifier: MIT
/// Module-internal: shapes of the widgets, and the outline of a plane in a box. World units.
#pragma once
#include <span>
#include <vector>

#include "render/frame/camera.h"
#include "render/frame/frame_packet.h"

namespace catena::render {

/// Two unit vectors perpendicular to `normal` (a unit vector) and to each other, right-handed with it. Any thread.
struct PlaneBasis {
  Vec3 u, v;
};
/// Returns a basis of the plane. Any thread.
PlaneBasis make_plane_basis(const Vec3& normal);

/// Returns the intersection of a plane with a box: a convex polygon of 3 to 6 corners, in order around the normal. Empty if there is no
/// area in common. A face of the box that lies in the plane is its own outline. Any thread.
std::vector<Vec3> plane_outline(const Vec3& point, const Vec3& normal, const Bounds& box);

/// Returns the mixture of two colors.
Color mix_colors(const Color& a, const Color& b, float share_of_b);
/// Returns a brighter color, slightly closer to white; share 0: unchanged.
Color brighten(const Color& color, float share);
/// Returns red, green or blue for axis 0, 1 or 2.
Color axis_color(int axis);

/// Appends shapes to a packet's widgets, none too thin to be visible in the packet's view. Positions and sizes are in world units; the
/// packet's stretch moves the points, while tubes and spheres stay round. Frame thread.
class WidgetShapes {
 public:
  /// Appends to the widgets of `packet`, for its view.
  explicit WidgetShapes(FramePacket& packet);
  /// Sets the object id of the following shapes, and the radius of their lines: `line`, or the minimum visible radius, times the weight.
  void begin_object(std::uint32_t id, double line) {
    id_ = id;
    line_radius_ = line;
  }

  /// Adds a tube through the points; its radius is the line radius times `weight`.
  void tube(std::vector<Vec3> points, double weight, const Color& color);
  /// Adds a closed loop through the points.
  void loop(std::span<const Vec3> points, double weight, const Color& color);
  /// Adds a circle in the plane perpendicular to `normal`.
  void circle(const Vec3& centre, const Vec3& normal, double radius, double weight, const Color& color);
  /// Adds a filled parallelogram with the corners middle +- u +- v.
  void parallelogram(const Vec3& middle, const Vec3& u, const Vec3& v, const Color& color);
  /// Adds a sphere of at least the minimum visible radius.
  void sphere(const Vec3& centre, double radius, const Color& color);
  /// Adds a shaft with a cone of length `head` at its tip.
  void arrow(const Vec3& from, const Vec3& tip, double weight, double head, const Color& color);
  /// Adds two arrows from the center `middle`, to middle +- half.
  void double_arrow(const Vec3& middle, const Vec3& half, double weight, double head, const Color& color);

  /// Returns the radius, or the minimum visible radius of a sphere at that position.
  double visible_radius(const Vec3& centre, double radius) const;
  /// Returns the unit vector from a position to the camera.
  Vec3 direction_to_camera(const Vec3& p) const;

 private:
  void add(std::vector<Vec3> points, double radius, const Color& color);
  /// Returns the size of a pixel at a position, world units; 0 behind the camera.
  double pixel_size_at(const Vec3& p) const;

  WidgetItems* items_;
  Camera camera_;      ///< for display positions
  Vec3 stretch_;       ///< display units per world unit along the axes
  double size_scale_;  ///< display units per world unit of radii
  std::uint32_t id_ = 0;
  double line_radius_ = 0;
};

}  // namespace catena::render
