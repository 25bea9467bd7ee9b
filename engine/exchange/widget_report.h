/// What the tick tells the frame of a widget (engine/widget/widget.h says what the members mean for each kind). World units.
#pragma once
#include <array>
#include <cstdint>

#include "engine/base/rotation.h"

namespace catena::exchange {

inline constexpr int kMaxWidgets = 8;

/// One word a widget and tick.
///   cutting plane: away, explore (the probe is held on the plane), translate, rotate (on the sphere), turn (on the sphere, turning it)
///   the others:    away, hover (the probe is drawn to a handle), drag
enum class WidgetMode : std::uint8_t { away, explore, translate, rotate, turn, hover, drag };
const char* mode_word(WidgetMode mode);

struct WidgetPose {
  std::array<Vec3, 2> points{Vec3(0.0), Vec3(0.0)};
  Quat orientation{kNoRotation};  ///< world from widget, unit
  bool operator==(const WidgetPose&) const = default;
};

struct WidgetReport {
  WidgetPose pose;
  double value = 0;            ///< isolevel: of the field at the handle
  std::uint32_t revision = 0;  ///< of the pose that the hand began with; Spec::revision
  WidgetMode mode = WidgetMode::away;
  std::int8_t handle = -1;  ///< rake, ruler: 0, 1 its ends, 2 the whole; box: 0..5 faces -x +x -y +y -z +z, 6 the whole; -1: none
  std::uint8_t held = 0;    ///< bit i: the plane across the widget's axis i is active
};

}  // namespace catena::exchange
