// SPDX-License-Identifier: MIT
/// Dragging of widgets with the mouse: the part under the pointer, and the pose that keeps this part under the pointer. The rules of the
/// tick apply (engine/widget/handles.h, cutting_plane.h), without dead zones. Positions of the pointer in pixels of the image. Pure, frame
/// thread.
#pragma once
#include <optional>

#include "engine/scene/scene.h"
#include "render/frame/camera.h"

namespace catena::app {

/// A part of a widget: a handle, the arrow or a circle of a cutting plane, or a line that stands for a handle (the outline of a cutting
/// plane for its arrow, the edges of a box for its center, the segment of a rake or ruler for its middle).
struct WidgetPart {
  scene::Entity widget;
  std::int8_t handle = -1;  ///< Handle as in WidgetReport; -1: a circle.
  std::int8_t axis = -1;    ///< Axis of the circle; -1: a handle.
  Vec3 point{0.0};          ///< Point of the part nearest to the pointer's ray, world units.
  double pixel = 0;         ///< Size of a pixel at the point, display units (render::View).
};

inline constexpr double kWidgetTolerancePx = 9;  ///< Distance from a drawn part within which the pointer is on it.

/// Returns the part at the pointer, whether it is hidden by other objects or not; of several, handles come before arrows, these before
/// circles, these before lines. `drawn`: bounds of the visible objects, which cut the outline of a cutting plane.
std::optional<WidgetPart> find_widget_part(const scene::Scene& scene, const Bounds& drawn, const render::Camera& camera, double x,
                                           double y);

/// A drag of a part with the mouse.
class WidgetDrag {
 public:
  WidgetDrag(const scene::Widget& widget, const WidgetPart& part, const render::Camera& camera);
  /// Returns the pose with the part at the pointer. The arrow, a box's face and an isolevel move along their line, a circle turns, other
  /// handles move parallel to the image.
  widget::Pose pose_at(const render::Camera& camera, double x, double y) const;

 private:
  /// Path of the grabbed point.
  enum class Path { line, circle, sphere, plane };

  Vec3 follow(const render::Camera& camera, double x, double y) const;

  widget::Spec spec_;
  widget::State state_;
  Path path_ = Path::plane;
  Vec3 center_{0.0}, axis_{0.0};  ///< Line: direction; circle, sphere: center and axis; plane: normal.
};

}  // namespace catena::app
