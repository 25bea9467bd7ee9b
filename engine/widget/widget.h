// SPDX-License-Identifier: MIT
/// Widgets: objects in the scene that the user can grab (paper, section 6.2 and Figure 6), as plain specs and states. The state machine
/// (state_machine.h) is a set of functions over these, run by the tick, so that mouse, haptic device and replayed path drive the same
/// machine. Lengths in world units. The functions use only + - * / and square roots, so that results are bit-identical everywhere. Any
/// thread, no allocation.
#pragma once
#include <array>
#include <memory>
#include <type_traits>
#include <vector>

#include "engine/base/haptic_state.h"
#include "engine/base/vec.h"
#include "engine/field/field.h"

namespace catena::widget {

/// Returns axis i of the frame q in world coordinates, unit length.
inline Vec3 frame_axis(const Quat& q, int i) noexcept { return rotate(q, i == 0 ? Vec3(1, 0, 0) : i == 1 ? Vec3(0, 1, 0) : Vec3(0, 0, 1)); }

/// Returns u reduced by the dead zone: 0 within -zone..zone, u - zone or u + zone outside; continuous.
inline double deadzone(double u, double zone) noexcept { return u > zone ? u - zone : u < -zone ? u + zone : 0; }

/// Returns the direction of v without its component along the unit vector n; zero if nothing is left.
inline Vec3 perpendicular_direction(const Vec3& v, const Vec3& n) noexcept {
  const Vec3 d = direction(v - n * dot(n, v));
  return direction(d - n * dot(n, d));
}

/// Returns the rotation about the unit axis e that turns a onto b, both unit and perpendicular to e. Its vector part is an exact multiple
/// of e.
///   cos(t/2) = |a + b| / 2,  sin(t/2) = |b - a| / 2, with the sign of e . (a x b)
inline Quat rotation_about(const Vec3& e, const Vec3& a, const Vec3& b) noexcept {
  const double c = 0.5 * norm(a + b), s = dot(e, cross(a, b)) < 0 ? -0.5 * norm(b - a) : 0.5 * norm(b - a);
  const double length = std::sqrt(c * c + s * s);
  if (!(length > 0)) return kIdentityRotation;
  return {c / length, e.x * (s / length), e.y * (s / length), e.z * (s / length)};
}

/// Interaction mode of a widget.
using Mode = WidgetMode;
/// Position and orientation of a widget.
using Pose = WidgetPose;
/// State of a widget as reported by a tick.
using Report = WidgetReport;

/// Kind of widget. `points` and the orientation are those of its Pose.
///   cutting_plane  a sphere and three orthogonal planes, in the chain by mode; points[0] is the center, the orientation's z the normal
///   seed           one handle, points[0]
///   rake           a segment with seeds from points[0] to points[1]
///   isolevel       a handle on an isosurface, points[0]; its level is the field's value there
///   box            from points[0], the min corner, to points[1], the max corner
///   ruler          from points[0] to points[1]
enum class Kind : std::uint8_t { cutting_plane, seed, rake, isolevel, box, ruler };

/// Rotation of a cutting plane. any: about an axis if grabbed near one of the three great circles of the sphere, else freely; free: freely
/// only; axis: about the nearest axis only.
enum class RotationMode : std::uint8_t { any, free, axis };

/// Description of a widget. Created off the tick; constant while a program runs.
struct Spec {
  Kind kind = Kind::cutting_plane;  ///< Kind of widget
  Pose pose;                        ///< Pose at the start, or as last set from outside
  double value = 0;                 ///< Isolevel: value at the start, used where the field has none at the handle
  /// Number of times the pose was set from outside (a panel, undo): a higher revision replaces the user's pose.
  std::uint32_t revision = 0;
  double length = 4;                                ///< L, which scales the sizes that are not specified
  double radius = 0;                                ///< Radius of the sphere or of a handle's ball
  double snap = 0;                                  ///< Cutting plane: distance within which it snaps to the probe
  double release = 0;                               ///< Cutting plane: distance beyond which it releases the probe; more than `snap`
  double grab_distance = 0;                         ///< Distance within which the sphere, a great circle or a handle can be grabbed
  double step = 0;                                  ///< Distance of the probe at which a plane that holds an axis releases it
  RotationMode rotation = RotationMode::any;        ///< Rotation of a cutting plane
  bool rotate_on_contact = false;                   ///< True: the sphere turns on contact, without the button
  int button = 1;                                   ///< Button that grabs, 1..32
  std::shared_ptr<const field::ScalarField> field;  ///< Isolevel: field whose value at the handle is the level; else null
  std::vector<int> along_links;                     ///< Ruler: links of the program that its ends stay on while dragged
};

// State of a widget between ticks, and its request to the chain. Plain data without pointers. World units.

/// Geometric feature assigned to one of the four links that the widgets share: planes x, y, z, and the sphere.
struct LinkShape {
  /// Kind of feature.
  enum class Kind : std::uint8_t { none, plane, sphere, point };
  Kind kind = Kind::none;  ///< none: the link passes its probe on unchanged
  Vec3 origin{0.0};        ///< Point on the plane; center of the sphere; the point
  Vec3 normal{0.0};        ///< Plane: unit normal
  double radius = 0;       ///< Sphere: radius
  bool operator==(const LinkShape&) const = default;
};

inline constexpr int kSharedLinks = 4, kSphereLink = 3;  ///< Number of links that the widgets share; index of the sphere among them
inline constexpr std::array<const char*, kSharedLinks> kSharedLinkNames{
    "widget_x", "widget_y", "widget_z", "widget_sphere"};  ///< Names of the shared links; no link of a scene may have one

/// Chain that the engaged widget requests for one tick.
struct ChainRequest {
  bool disables_scene_links = false;              ///< The scene's links are off
  bool uses_along_links = false;                  ///< Spec::along_links in place of the shared links
  int count = 0;                                  ///< Number of entries of `order` in use
  std::array<std::int8_t, kSharedLinks> order{};  ///< Shared links in the order of the chain
  std::array<LinkShape, kSharedLinks> shapes{};   ///< Features, by shared link
  /// Appends a shared link to the order and assigns it a feature.
  void add_link(int slot, const LinkShape& shape) noexcept {
    order[static_cast<std::size_t>(count++)] = static_cast<std::int8_t>(slot);
    shapes[static_cast<std::size_t>(slot)] = shape;
  }
};

/// Translation of a widget: planes through `grab_point` across the axes of `frame`. A plane holds its axis if the axis is fixed, or if the
/// probe is within `step` of the plane and the axis is not free. Displacement along axis i: 0 if held, u_i if free, else
/// deadzone(u_i, step), with u_i = axis_i . (proxy - grab_point): continuous, and a function of the probe alone (not of its path).
struct Grip {
  Vec3 grab_point{0.0};           ///< Probe position at the press
  Quat frame{kIdentityRotation};  ///< Rotation from the axes to the world
  std::uint8_t fixed_axes = 0;    ///< Bit i: axis i never moves
  std::uint8_t free_axes = 0;     ///< Bit i: axis i always moves
};

/// State of a widget between ticks.
struct State {
  bool is_initialized = false;     ///< True after reset_state
  bool is_gripped = false;         ///< Grabbed by the button
  bool rebase_arm = false;         ///< Turn: the next arm becomes the new start arm
  Mode mode = Mode::idle;          ///< Current mode
  std::int8_t handle = -1;         ///< Handle in use, numbered as in WidgetReport; -1: none
  std::int8_t axis = -1;           ///< Turn: axis; -1: free
  std::uint8_t active_planes = 0;  ///< Bit i: the plane across axis i is active
  std::uint32_t revision = 0;      ///< Revision of the pose at the reset
  Pose pose;                       ///< Current pose
  double value = 0;                ///< Isolevel: field value at the handle
  Pose start_pose;                 ///< Pose at the press
  Grip grip;                       ///< Translate, drag: the grip
  Vec3 arm{0.0};                   ///< Turn: unit arm; about an axis that of its start, freely that of the last tick
};
static_assert(std::is_trivially_copyable_v<State> && std::is_trivially_copyable_v<ChainRequest>);

}  // namespace catena::widget
