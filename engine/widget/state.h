/// What a widget remembers from tick to tick, and what it asks of the chain. Plain data, no pointers. World units.
#pragma once
#include <array>
#include <type_traits>

#include "engine/widget/widget.h"

namespace catena::widget {

/// A feature that a link of the program has been put on; widgets share four links: planes x, y, z, and the sphere.
struct Shape {
  enum class Kind : std::uint8_t { none, plane, sphere, point };
  Kind kind = Kind::none;
  Vec3 origin{0.0};
  Vec3 normal{0.0};   ///< plane: unit
  double radius = 0;  ///< sphere
  bool operator==(const Shape&) const = default;
};

inline constexpr int kSlots = 4, kSphereSlot = 3;
inline constexpr std::array<const char*, kSlots> kLinkNames{"widget_x", "widget_y", "widget_z", "widget_sphere"};

/// The chain that a widget asks for in this tick.
struct Plan {
  bool alone = false;  ///< the scene's links are off
  bool along = false;  ///< Spec::along in place of slots
  int count = 0;
  std::array<std::int8_t, kSlots> slots{};  ///< in order
  std::array<Shape, kSlots> shapes{};       ///< by slot
  void add(int slot, const Shape& shape) noexcept {
    slots[static_cast<std::size_t>(count++)] = static_cast<std::int8_t>(slot);
    shapes[static_cast<std::size_t>(slot)] = shape;
  }
};

/// A translation: planes through `grab` across the axes of `frame`.
///   held where fixed, or within `step` of the plane and not loose;  displacement along axis i: 0 where held, u_i where loose, else
///   deadzone(u_i, step), with u_i = axis_i . (proxy - grab): continuous, and a function of the probe alone (no path)
struct Grip {
  Vec3 grab{0.0};           ///< the probe at the press
  Quat frame{kNoRotation};  ///< world from the axes
  std::uint8_t fixed = 0;   ///< bits: axes that never move
  std::uint8_t loose = 0;   ///< bits: axes that always move
};

struct State {
  bool known = false;    ///< begun
  bool gripped = false;  ///< by the button
  bool rebase = false;   ///< a turn: the next arm is where it goes on from
  Mode mode = Mode::away;
  std::int8_t handle = -1;
  std::int8_t axis = -1;  ///< of a turn; -1: free
  std::uint8_t held = 0;  ///< planes that are active
  std::uint32_t revision = 0;
  Pose pose;
  double value = 0;
  Pose start;     ///< at the press
  Grip grip;      ///< translate, drag
  Vec3 arm{0.0};  ///< turn: unit, about an axis at its start, freely in the last tick
};
static_assert(std::is_trivially_copyable_v<State> && std::is_trivially_copyable_v<Plan>);

}  // namespace catena::widget
