// SPDX-License-Identifier: MIT
/// Camera of one image: a View resolved to axes, a window, near and far for one image size and scene extent, in double precision.
///   view axes: right-handed, x right, y up, z towards the viewer (the camera looks along -z = -back)
///   clip axes: Vulkan's, x right, y *down*, depth 0 at near and 1 at far
///   pixels: x right, y down, row 0 at the top; the center of pixel (i, j) is at (i + 0.5, j + 0.5)
/// Perspective: vertical field of view. Orthographic: `height` world units from bottom to top. The view's window is a part of the symmetric
/// frustum of that angle or height; pixels are square unless the view states an aspect. Near and far enclose the given bounds, as far as
/// they lie in front of the camera. Everything is in display units (View::stretch) but the positions of the world that project(),
/// unproject() and pixel_ray() take and return. Pure functions, any thread.
#pragma once
#include <glm/mat4x4.hpp>
#include <limits>
#include <optional>
#include <string_view>

#include "engine/base/bounds.h"
#include "engine/base/export.h"
#include "render/frame/frame_packet.h"

namespace catena::render {

/// 4 x 4 matrix of doubles, column-major.
using Mat4 = glm::dmat4;

/// Position, axes, window and depth range of a camera, as the renderer uses them.
struct Camera {
  Vec3 position{0.0};                                                 ///< camera position, world units
  Vec3 right{1.0, 0.0, 0.0}, up{0.0, 1.0, 0.0}, back{0.0, 0.0, 1.0};  ///< unit vectors of the view axes in world axes, mutually orthogonal
  bool orthographic = false;                                          ///< orthographic projection instead of perspective
  // Window: measured at view depth 1 (perspective) or at any depth (orthographic), world units.
  double half_height = 1, half_width = 1;  ///< half extents of the window
  double center_x = 0, center_y = 0;       ///< center of the window relative to the view axis, to the right and up
  double near = 1, far = 2;                ///< view depths of the near and far planes, world units
  double width = 1, height = 1;            ///< image size, pixels
  Vec3 stretch{1.0};  ///< display units per world unit along the world's axes, for project(), unproject() and pixel_ray()
};

/// Half line in world space; `direction` is a unit vector.
struct Ray {
  Vec3 origin{0.0}, direction{0.0};  ///< start point, world units; unit direction
};

/// Returns width / height of the view's symmetric frustum: View::aspect if it is set, else the aspect at which pixels are square.
CATENA_EXPORT double frustum_aspect(const View& view, double width_px, double height_px);

/// Returns the camera of `view` for an image of width_px x height_px (at least 1 x 1) with near and far enclosing `bounds`. If `up` is
/// parallel to the view direction, another up is chosen; if the target coincides with the position, the camera looks along +y.
CATENA_EXPORT Camera make_camera(const View& view, double width_px, double height_px, const Bounds& bounds);
/// Returns the same camera for positions in display units, as the items of a packet are.
CATENA_EXPORT Camera make_display_camera(const View& view, double width_px, double height_px, const Bounds& bounds);

/// Returns the transform from world to view axes.
CATENA_EXPORT Mat4 view_from_world(const Camera& camera);
/// Returns the projection from view axes to Vulkan clip axes.
CATENA_EXPORT Mat4 clip_from_view(const Camera& camera);
/// Returns the transform from world to Vulkan clip axes.
CATENA_EXPORT Mat4 clip_from_world(const Camera& camera);
/// Returns the inverse of clip_from_world(), in closed form (not by elimination). The point (x, y, depth) in clip axes is at the product
/// with (x, y, depth, 1), divided by its last component, in the world.
CATENA_EXPORT Mat4 world_from_clip(const Camera& camera);

/// Returns the ray through a pixel coordinate; it starts at the camera position (perspective) or in the camera plane (orthographic).
CATENA_EXPORT Ray pixel_ray(const Camera& camera, double x_px, double y_px);
/// Returns the pixel coordinates x, y and the view depth (distance along the view axis, world units) of a world point; nullopt at or behind
/// the camera plane (perspective only).
CATENA_EXPORT std::optional<Vec3> project(const Camera& camera, const Vec3& world);
/// Inverse of project(): returns the world point at view depth `depth` behind the pixel coordinate.
CATENA_EXPORT Vec3 unproject(const Camera& camera, double x_px, double y_px, double depth);
/// Returns the size of one pixel at the view depth, world units.
CATENA_EXPORT double pixel_size(const Camera& camera, double depth);
/// Returns pixel_size() at the nearest corner of the box; corners in front of the near plane count as on it (perspective).
CATENA_EXPORT double min_pixel_size(const Camera& camera, const Bounds& box);
/// Returns false only if no part of the sphere (world units) can be in the window, at any distance.
CATENA_EXPORT bool may_be_visible(const Camera& camera, const Vec3& centre, double radius);

/// Returns the unit direction from the scene towards the camera of the default view: oblique, with +z up.
CATENA_EXPORT Vec3 default_view_direction();
/// Returns a perspective view that fits the box: all its corners are inside the image, with a margin of 5 % of the distance. `aspect`:
/// width / height. An empty box counts as -1..1. `to_camera` (from the scene to the camera) and `up` need not be unit vectors.
CATENA_EXPORT View fit_view(const Bounds& bounds, double aspect, const Vec3& to_camera = default_view_direction(), double fovy_deg = 30,
                            const Vec3& up = Vec3(0.0, 0.0, 1.0));

/// Point cloud to fit a view to.
struct FitPoints {
  std::vector<Vec3> points;  ///< positions, world units
  double outlier_share = 0;  ///< share of the points that may lie outside the image (outliers), 0 to 1
};
/// Returns a view centered on the points as seen in the image, in which they fill at most the shares `width` and `height` (0 to 1) of the
/// image, one of the two exactly. In perspective, every point p = (x, y, z) in view axes (z towards the camera) lies between two planes
/// through the camera position e, and so for y:
///   p_y - e_y <= t (e_z - p_z),  e_y - p_y <= t (e_z - p_z),   t = share tan(fovy / 2)
/// The sums of these over the extreme points on either side give e_y and the minimum e_z. Without points, the box -1..1 is fitted.
CATENA_EXPORT View fit_view(const std::vector<FitPoints>& clouds, double aspect, double width, double height,
                            const Vec3& to_camera = default_view_direction(), double fovy_deg = 30, const Vec3& up = Vec3(0.0, 0.0, 1.0));

/// Camera moves: orbit, zoom, view along an axis, refit. Angles in degrees. Pure functions, any thread.

/// Raises the camera by `elevation` about the horizontal axis of the image, then turns it by `azimuth` about the axis `up` through its
/// target (counter-clockwise seen from above). `up` turns with the camera, so the image never flips at a pole.
CATENA_EXPORT View orbit_view(const View& view, double azimuth_deg, double elevation_deg);

/// Magnifies the center of the image: same camera position and projection, smaller field of view (or height).
///   tan(fovy' / 2) = tan(fovy / 2) / factor
CATENA_EXPORT View zoom_view(const View& view, double factor);

/// Returns the unit direction from the scene towards the camera for the name of a view direction: "+x", "-x", "+y", "-y", "+z" or "-z" (the
/// direction in which the camera looks), or "iso" (camera at +x, -y, +z at equal angles). nullopt for any other text.
CATENA_EXPORT std::optional<Vec3> axis_direction(std::string_view name);

/// Returns fit_view() along axis_direction(name), up +z (+y if the camera looks along z); nullopt for an unknown name.
CATENA_EXPORT std::optional<View> axis_view(const Bounds& bounds, double aspect, std::string_view name, double fovy_deg = 30);

/// Returns a view with the same direction, up, field of view and projection that fits the box.
CATENA_EXPORT View refit_view(const View& view, const Bounds& bounds, double aspect);

}  // namespace catena::render
