// SPDX-License-Identifier: MIT
/// Reads a plane: a point with a normal, an axis with a position on that axis, or a widget.
#include "engine/base/text.h"
#include "engine/scene/readers.h"
#include "engine/scene/widgets.h"

namespace catena::scene {
namespace {

/// Reads a plane that is bound to a widget.
Outcome read_followed(const Scene& scene, const json::Node& item, const std::string& word, Vec3& point, Vec3& normal, Entity& widget) {
  for (const char* key : {"point", "normal", "axis", "at"})
    if (const json::Node* node = item.find(key))
      return json::error_at(*node,
                            in_quotes(key) + " is given beside \"widget\", whose plane the " + word + " follows; one of them was expected");
  CATENA_TRY(widget, read_widget_name(scene, item, {widget::Kind::cutting_plane}, "a cutting plane"));
  const widget::Pose& pose = scene.entities.get<Widget>(widget).spec.pose;
  point = pose.points[0];
  normal = plane_normal(pose);
  return Done{};
}

}  // namespace

Keys plane_keys() {
  return {schema::vec3("point", "world", "Point on the plane; given with `normal`."),
          schema::direction("normal", "Normal of the plane, of any length; given with `point`."),
          schema::choice("axis", {"x", "y", "z"}, "Axis perpendicular to the plane; given with `at`, in place of `point` and `normal`."),
          schema::number("at", "world", "Coordinate of the plane on `axis`."),
          schema::reference("widget", Role::widget,
                            "Cutting plane widget that sets the plane, in place of `point` and `normal` or `axis` and `at`.")};
}

Outcome read_plane(const Scene& scene, const json::Node& item, const std::string& word, Vec3& point, Vec3& normal, Entity& widget) {
  if (item.find("widget") != nullptr) return read_followed(scene, item, word, point, normal, widget);
  const json::Node *axis = item.find("axis"), *at = item.find("at"), *from = item.find("point"), *across = item.find("normal");
  if ((axis || at) && (from || across))
    return json::error_at(from ? *from : *across, "a " + word +
                                                      " has both an axis and a point or normal; \"axis\" with \"at\", or \"point\" "
                                                      "with \"normal\", was expected");
  if (!axis && !at && !from && !across)
    return json::error_at(item,
                          "a " + word + " has no plane; \"widget\", \"axis\" with \"at\", or \"point\" with \"normal\", was expected");
  if (axis || at) {
    if (!axis) return json::error_at(*at, "\"at\" is given without \"axis\"; \"x\", \"y\" or \"z\" was expected beside it");
    CATENA_TRY(const int axis_index, json::get_choice(item, "axis", 0, {"x", "y", "z"}));
    point = normal = Vec3(0.0);
    CATENA_TRY(point[axis_index], json::require_number(item, "at"));
    normal[axis_index] = 1;
    return Done{};
  }
  CATENA_TRY(point, json::require_vec3(item, "point"));
  CATENA_TRY(normal, json::require_vec3(item, "normal"));
  if (max_abs(normal) == 0) return json::error_at(*across, "\"normal\" is zero; a vector other than [0, 0, 0] was expected");
  return Done{};
}

schema::Members plane_members(const Scene& scene, const Vec3& point, const Vec3& normal, Entity widget) {
  if (widget) return {{"widget", schema::write_value(scene.entities.get<Name>(widget).value)}};
  for (int i = 0; i < 3; ++i) {
    Vec3 axis(0.0), at(0.0);
    axis[i] = 1;
    at[i] = point[i];
    if (normal == axis && point == at)
      return {{"axis", schema::write_value(std::string(1, "xyz"[i]))}, {"at", schema::write_value(point[i])}};
  }
  return {{"point", schema::write_value(point)}, {"normal", schema::write_value(normal)}};
}

}  // namespace catena::scene
