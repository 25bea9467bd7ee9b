/// What the widgets are and remember (paper, section 6.2 and Figure 6): things in the scene that the hand takes hold of. Plain components;
/// the machine that steps them (machine.h) is a function over these, run by the tick, so that the mouse, a haptic device and a replayed
/// path all drive the same one. Lengths in world units. The functions use + - * / and square roots only, so that bits repeat; any thread,
/// no allocation.
#pragma once
#include <array>
#include <memory>
#include <type_traits>
#include <vector>

#include "engine/base/haptic_state.h"
#include "engine/base/vec.h"
#include "engine/field/field.h"

namespace catena::widget {

/// Axis i of the frame q, world: unit.
inline Vec3 frame_axis(const Quat& q, int i) noexcept { return rotate(q, i == 0 ? Vec3(1, 0, 0) : i == 1 ? Vec3(0, 1, 0) : Vec3(0, 0, 1)); }

/// u beyond -zone..zone, 0 within: continuous, and one to one beyond.
inline double deadzone(double u, double zone) noexcept { return u > zone ? u - zone : u < -zone ? u + zone : 0; }

/// v without its part along the unit vector n, unit; zero where nothing is left.
inline Vec3 perpendicular_direction(const Vec3& v, const Vec3& n) noexcept {
  const Vec3 d = direction(v - n * dot(n, v));
  return direction(d - n * dot(n, d));
}

/// The rotation about the unit axis e that turns a onto b, both unit and square to e. Its vector part is a multiple of e to the bit.
///   cos(t/2) = |a + b| / 2,  sin(t/2) = |b - a| / 2, with the sign of e . (a x b)
inline Quat rotation_about(const Vec3& e, const Vec3& a, const Vec3& b) noexcept {
  const double c = 0.5 * norm(a + b), s = dot(e, cross(a, b)) < 0 ? -0.5 * norm(b - a) : 0.5 * norm(b - a);
  const double length = std::sqrt(c * c + s * s);
  if (!(length > 0)) return kIdentityRotation;
  return {c / length, e.x * (s / length), e.y * (s / length), e.z * (s / length)};
}

/// What a widget does.
using Mode = WidgetMode;
/// Where a widget is.
using Pose = WidgetPose;
/// What a tick says of a widget.
using Report = WidgetReport;

/// What a widget is. `points` and the orientation are those of its Pose.
///   cutting_plane  a sphere and three orthogonal planes, in the chain by mode; points[0] is the centre, the orientation's z the normal
///   seed           one handle, points[0]
///   rake           a line of seeds from points[0] to points[1]
///   isolevel       a handle on an isosurface, points[0]; its level is the field's value there
///   box            from points[0], the least corner, to points[1]
///   ruler          from points[0] to points[1]
enum class Kind : std::uint8_t { cutting_plane, seed, rake, isolevel, box, ruler };

/// The turns of a cutting plane that the hand may make: about an axis where it takes the sphere near one of the three great circles and
/// else freely; freely only; about the nearest axis only.
enum class RotationMode : std::uint8_t { any, free, axis };

/// What a widget is made of. Off the tick; it does not change while a program runs.
struct Spec {
  Kind kind = Kind::cutting_plane;  ///< what it is
  Pose pose;                        ///< at the start, or as set since
  double value = 0;                 ///< isolevel: at the start, where the field says nothing at the handle
  std::uint32_t revision = 0;       ///< counts the poses that were set from outside (a panel, undo): a higher one replaces the hand's
  double length = 4;                ///< L, which the sizes that are not stated follow
  double radius = 0;                ///< of the sphere; of a handle's ball
  double snap = 0;                  ///< the cutting plane takes hold of a probe this near
  double release = 0;               ///< and lets it go this far; more than snap
  double grab_distance = 0;         ///< the sphere, a great circle, a handle: taken hold of within it
  double step = 0;                  ///< a plane that holds an axis lets go where the probe is this far from it
  RotationMode rotation = RotationMode::any;        ///< which turns the hand may make
  bool rotate_on_contact = false;                   ///< the sphere turns without the button
  int button = 1;                                   ///< 1..32
  std::shared_ptr<const field::ScalarField> field;  ///< isolevel
  std::vector<int> along_links;                     ///< ruler: links of the program that its ends keep to while they are dragged
};

/// What a widget remembers from tick to tick, and what it asks of the chain. Plain data, no pointers. World units.

/// A feature that a link of the program has been put on; widgets share four links: planes x, y, z, and the sphere.
struct LinkShape {
  /// What the link is put on.
  enum class Kind : std::uint8_t { none, plane, sphere, point };
  Kind kind = Kind::none;  ///< none: the link lets its probe through
  Vec3 origin{0.0};        ///< a place on it; a sphere's centre
  Vec3 normal{0.0};        ///< plane: unit
  double radius = 0;       ///< sphere
  bool operator==(const LinkShape&) const = default;
};

inline constexpr int kSharedLinks = 4, kSphereLink = 3;  ///< Links that widgets share; the one that is the sphere.
inline constexpr std::array<const char*, kSharedLinks> kSharedLinkNames{
    "widget_x", "widget_y", "widget_z", "widget_sphere"};  ///< Their names, which no link of a scene may have.

/// The chain that a widget asks for in this tick.
struct ChainRequest {
  bool disables_scene_links = false;              ///< the scene's links are off
  bool uses_along_links = false;                  ///< Spec::along in place of slots
  int count = 0;                                  ///< slots in use
  std::array<std::int8_t, kSharedLinks> order{};  ///< in order
  std::array<LinkShape, kSharedLinks> shapes{};   ///< by slot
  /// Puts the next link in order on a shape.
  void add_link(int slot, const LinkShape& shape) noexcept {
    order[static_cast<std::size_t>(count++)] = static_cast<std::int8_t>(slot);
    shapes[static_cast<std::size_t>(slot)] = shape;
  }
};

/// A translation: planes through `grab` across the axes of `frame`.
///   held where fixed, or within `step` of the plane and not loose;  displacement along axis i: 0 where held, u_i where loose, else
///   deadzone(u_i, step), with u_i = axis_i . (proxy - grab): continuous, and a function of the probe alone (no path)
struct Grip {
  Vec3 grab_point{0.0};           ///< the probe at the press
  Quat frame{kIdentityRotation};  ///< world from the axes
  std::uint8_t fixed_axes = 0;    ///< bits: axes that never move
  std::uint8_t free_axes = 0;     ///< bits: axes that always move
};

/// What a widget remembers.
struct State {
  bool is_initialized = false;     ///< begun
  bool is_gripped = false;         ///< by the button
  bool rebase_arm = false;         ///< a turn: the next arm is where it goes on from
  Mode mode = Mode::idle;          ///< what it does
  std::int8_t handle = -1;         ///< as in Report
  std::int8_t axis = -1;           ///< of a turn; -1: free
  std::uint8_t active_planes = 0;  ///< planes that are active
  std::uint32_t revision = 0;      ///< of the pose that the hand began with
  Pose pose;                       ///< where it is now
  double value = 0;                ///< isolevel: the field's value at the handle
  Pose start_pose;                 ///< at the press
  Grip grip;                       ///< translate, drag
  Vec3 arm{0.0};                   ///< turn: unit, about an axis at its start, freely in the last tick
};
static_assert(std::is_trivially_copyable_v<State> && std::is_trivially_copyable_v<ChainRequest>);

}  // namespace catena::widget
