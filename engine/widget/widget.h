/// What the widgets are (paper, section 6.2 and Figure 6): things in the scene that the hand takes hold of. Plain components; the machine
/// that steps them is a function over these, run by the tick, so that the mouse, a haptic device and a replayed path drive one and the
/// same. World units.
///   cutting_plane  a sphere and three orthogonal planes, in the chain by mode; points[0] is the centre, the orientation's z the normal
///   seed           one handle, points[0]
///   rake           a line of seeds from points[0] to points[1]
///   isolevel       a handle on an isosurface, points[0]; its level is the field's value there
///   box            from points[0], the least corner, to points[1]
///   ruler          from points[0] to points[1]
#pragma once
#include <memory>
#include <vector>

#include "engine/exchange/widget_report.h"
#include "engine/field/field.h"

namespace catena::widget {

using exchange::kMaxWidgets;
using Mode = exchange::WidgetMode;
using Pose = exchange::WidgetPose;
using Report = exchange::WidgetReport;

enum class Kind : std::uint8_t { cutting_plane, seed, rake, isolevel, box, ruler };

/// The turns of a cutting plane that the hand may make: about an axis where it takes the sphere near one of the three great circles and
/// else freely; freely only; about the nearest axis only.
enum class Turning : std::uint8_t { any, free, axis };

struct Spec {
  Kind kind = Kind::cutting_plane;
  Pose pose;                   ///< at the start, or as set since
  double value = 0;            ///< isolevel: at the start, where the field says nothing at the handle
  std::uint32_t revision = 0;  ///< counts the poses that were set from outside (a panel, undo): a higher one replaces the hand's
  double length = 4;           ///< L, which the sizes that are not stated follow
  double radius = 0;           ///< of the sphere; of a handle's ball
  double snap = 0;             ///< the cutting plane takes hold of a probe this near
  double release = 0;          ///< and lets it go this far; more than snap
  double near = 0;             ///< the sphere, a great circle, a handle: taken hold of within it
  double step = 0;             ///< a plane that holds an axis lets go where the probe is this far from it
  Turning turning = Turning::any;
  bool touch = false;                               ///< the sphere turns without the button
  int button = 1;                                   ///< 1..32
  std::shared_ptr<const field::ScalarField> field;  ///< isolevel
  std::vector<int> along;                           ///< ruler: links of the program that its ends keep to while they are dragged
};

}  // namespace catena::widget
