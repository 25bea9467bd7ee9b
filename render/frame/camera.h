/// The camera of one picture: a View, the size in pixels and what there is to see, worked out in double precision.
///   view axes: right-handed, x right, y up, z towards the viewer (the camera looks along -z = -back)
///   clip axes: Vulkan's, x right, y *down*, depth 0 at near and 1 at far
///   pixels: x right, y down, row 0 at the top; the centre of pixel (i, j) is at (i + 0.5, j + 0.5)
/// Perspective: vertical field of view. Orthographic: `height` world units from bottom to top.
/// The view's window is a part of the symmetric frustum of that angle or height; pixels are square unless the view states an aspect.
/// Near and far enclose the bounds that are given (what lies behind the eye is not seen). Pure functions, any thread.
#pragma once
#include <glm/mat4x4.hpp>
#include <limits>
#include <optional>
#include <string_view>

#include "engine/base/bounds.h"
#include "render/frame/frame_packet.h"

namespace catena::render {

/// Four by four doubles, columns first.
using Mat4 = glm::dmat4;

/// A camera as pictures need it.
struct Camera {
  Vec3 position{0.0};                                                 ///< the eye, world units
  Vec3 right{1.0, 0.0, 0.0}, up{0.0, 1.0, 0.0}, back{0.0, 0.0, 1.0};  ///< unit, orthogonal
  bool orthographic = false;                                          ///< no perspective
  // the window, at the distance 1 (perspective) or everywhere (orthographic), world units
  double half_height = 1, half_width = 1;  ///< of the window
  double center_x = 0, center_y = 0;       ///< of the window, from the axis, right and up
  double near = 1, far = 2;                ///< along the axis, world units
  double width = 1, height = 1;            ///< pixels
};

/// A half line; `direction` is unit.
struct Ray {
  Vec3 origin{0.0}, direction{0.0};  ///< where it begins, world units; where it goes
};

/// Width by height of the view's symmetric frustum: as stated, or by square pixels.
double frustum_aspect(const View& view, double width_px, double height_px);

/// A degenerate up (along the axis) is replaced by another; a target at the position looks along +y.
Camera make_camera(const View& view, double width_px, double height_px, const Bounds& bounds);

/// View axes from the world.
Mat4 view_from_world(const Camera& camera);
/// Vulkan's clip axes from view axes.
Mat4 clip_from_view(const Camera& camera);
/// Vulkan's clip axes from the world.
Mat4 clip_from_world(const Camera& camera);
/// The world from Vulkan's clip axes: the inverse of clip_from_world(), from the closed form (not by elimination). A place (x, y, depth) in
/// clip axes lies in the world at the product with (x, y, depth, 1), divided by its last component.
Mat4 world_from_clip(const Camera& camera);

/// Through a place in the picture, in pixels. From the eye (perspective) or the plane of the eye (orthographic).
Ray pixel_ray(const Camera& camera, double x_px, double y_px);
/// Pixels x, y and the distance along the axis (view depth, world units); nothing at or behind the eye (perspective).
std::optional<Vec3> project(const Camera& camera, const Vec3& world);
/// The inverse: the point at view depth `depth` in the pixel place.
Vec3 unproject(const Camera& camera, double x_px, double y_px, double depth);
/// World units that one pixel covers at the view depth.
double pixel_size(const Camera& camera, double depth);
/// The same where a box is nearest to the eye; 0 where it reaches behind the eye of a perspective.
double min_pixel_size(const Camera& camera, const Bounds& box);
/// Whether any part of a ball may be in the window, however far away.
bool may_be_visible(const Camera& camera, const Vec3& centre, double radius);

/// From the scene towards the eye: oblique, +z up.
Vec3 default_view_direction();
/// A view that frames the box: all its corners inside the picture with a margin of 5 % of the distance.
/// An empty box counts as -1..1. `direction_to_camera` and `up` need not be unit.
View fit_view(const Bounds& bounds, double aspect, const Vec3& towards_eye = default_view_direction(), double fovy_deg = 30,
              const Vec3& up = Vec3(0.0, 0.0, 1.0));

/// Places to fit a picture to. `ignored`: the share of them that may lie outside, for specks.
struct FitPoints {
  std::vector<Vec3> points;  ///< world units
  double outlier_share = 0;  ///< share from 0 to 1
};
/// A view whose middle is the middle of the places as it shows them, and in which they take `width` and `height` of the picture: one of
/// the two exactly, the other at most. Shares from 0 to 1. In perspective every place p = (x, y, z) in the axes of the eye (z towards it)
/// lies between two planes through the eye e, and so for y:
///   p_y - e_y <= t (e_z - p_z),  e_y - p_y <= t (e_z - p_z),   t = share tan(fovy / 2)
/// whose sums over the farthest places to either side give e_y, and the least e_z. No places count as the box -1..1.
View fit_view(const std::vector<FitPoints>& clouds, double aspect, double width, double height,
              const Vec3& towards_eye = default_view_direction(), double fovy_deg = 30, const Vec3& up = Vec3(0.0, 0.0, 1.0));

/// Moves of a camera: turned about what it looks at, closer, along an axis, fitted. Angles in degrees. Pure functions, any thread.

/// Turns the camera by `azimuth` about the axis `up` through its target (counter-clockwise seen from above), after raising it by
/// `elevation` about the picture's horizontal. It takes its own up along: the picture never flips at a pole.
View orbit_view(const View& view, double azimuth_deg, double elevation_deg);

/// Enlarges the middle of the picture: the same eye and perspective, a smaller field of view (or height).
///   tan(fovy' / 2) = tan(fovy / 2) / factor
View zoom_view(const View& view, double factor);

/// "+x", "-x", "+y", "-y", "+z", "-z": the way the camera looks (from the other side of the scene); up is +z, for +-z it is +y.
/// "iso": from +x, -y, +z at equal angles. What comes back points from the scene towards the eye.
std::optional<Vec3> axis_direction(std::string_view words);

/// fit_view() along such an axis.
std::optional<View> axis_view(const Bounds& bounds, double aspect, std::string_view words, double fovy_deg = 30);

/// The same direction, up, angle and projection, with all of the box in the picture.
View refit_view(const View& view, const Bounds& bounds, double aspect);

}  // namespace catena::render
