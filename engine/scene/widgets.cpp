// SPDX-License-Identifier: MIT
#include "engine/scene/widgets.h"

#include <limits>

#include "engine/base/numbers.h"
#include "engine/base/text.h"
#include "engine/geometry/flow/seeds.h"
#include "engine/scene/drawable.h"

namespace catena::scene {
namespace {

using widget::Kind;

// fractions of L
constexpr double kPlaneRadius = 0.12, kHandleRadius = 0.012, kSnap = 0.02, kRelease = 0.05, kPlaneNear = 0.02, kHandleNear = 0.03,
                 kStep = 0.02;

Result<double> length_of(Scene& scene, const Widget& widget) {
  CATENA_TRY(double longest, field_length(scene, widget.field, widget.where));
  for (const Drawable& kind : drawables())
    for (const auto& [e, where] : kind.items(scene.entities)) {
      CATENA_TRY(const double length, kind.domain_length(scene, e));
      longest = std::max(longest, length);
    }
  if (longest > 0) return longest;
  // without rendered objects the haptic objects are used
  std::vector<std::pair<Entity, json::Node>> fields;
  scene.entities.each<Link>([&](Entity, const Link& link) {
    if (const json::Node* field = link.node.find("field"); field != nullptr && field->kind == json::Kind::string)
      fields.emplace_back(find_field(scene, field->string), *field);
  });
  for (const auto& [field, where] : fields) {
    CATENA_TRY(const double length, field_length(scene, field, where));
    longest = std::max(longest, length);
  }
  return longest > 0 ? longest : 4;
}

/// Sets a size that is not given.
void fit(double& size, double fitted) {
  if (!(size > 0)) size = fitted;
}

void complete_sizes(widget::Spec& spec) {
  const double length = spec.length;
  const bool plane = spec.kind == Kind::cutting_plane;
  fit(spec.radius, (plane ? kPlaneRadius : kHandleRadius) * length);
  fit(spec.grab_distance, (plane ? kPlaneNear : kHandleNear) * length);
  fit(spec.step, kStep * length);
  if (!plane) return;
  // if only one of the two is given, the other follows from the default ratio
  const double snap = spec.snap, release = spec.release;
  fit(spec.snap, release > 0 ? kSnap / kRelease * release : kSnap * length);
  fit(spec.release, snap > 0 ? kRelease / kSnap * snap : kRelease * length);
}

Outcome load_isolevel(Scene& scene, Entity entity) {
  const json::Node where = scene.entities.get<Widget>(entity).where;
  const Entity field = scene.entities.get<Widget>(entity).field;
  CATENA_TRY(const field::AnyField any, resolve_field(scene, field, json::member_or_parent(where, "field")));
  if (!any.scalar)
    return json::error_at(json::member_or_parent(where, "field"), in_quotes(scene.entities.get<Name>(field).value) +
                                                                      " is a vector field; a scalar field was expected for an isolevel");
  Widget& widget = scene.entities.get<Widget>(entity);
  field::Cursor cursor;
  const field::ScalarSample initial = any.scalar->sample(widget.spec.pose.points[0], cursor);
  if (widget.spec.revision == 0 && (!initial.inside || !std::isfinite(initial.value)))
    return json::error_at(json::member_or_parent(where, "position"), "the isolevel's position is outside the domain of field " +
                                                                         in_quotes(scene.entities.get<Name>(field).value) +
                                                                         ", or in a hole; a position with a value was expected");
  const field::ScalarSample now = any.scalar->sample(widget.report.pose.points[0], cursor);
  if (std::isfinite(now.value)) widget.report.value = now.value;
  widget.spec.field = any.scalar;
  return Done{};
}

}  // namespace

Quat normalize_orientation(const Quat& q) {
  const double square = q.w * q.w + q.x * q.x + q.y * q.y + q.z * q.z;
  return std::fabs(square - 1) <= 8 * std::numeric_limits<double>::epsilon() ? q : normalized(q);
}

Result<widget::Spec> resolve_widget(Scene& scene, Entity entity) {
  if (!scene.entities.get<Widget>(entity).is_complete) {
    CATENA_TRY(const double length, length_of(scene, scene.entities.get<Widget>(entity)));
    if (scene.entities.get<Widget>(entity).spec.kind == Kind::isolevel) CATENA_CHECK(load_isolevel(scene, entity));
    Widget& widget = scene.entities.get<Widget>(entity);
    widget.spec.length = length;
    complete_sizes(widget.spec);
    widget.is_complete = true;
  }
  return scene.entities.get<Widget>(entity).spec;
}

Vec3 plane_normal(const widget::Pose& pose) { return rotate(pose.orientation, {0.0, 0.0, 1.0}); }

ClipPlane make_clip_plane(const widget::Pose& pose, const ClipPlane& like) {
  ClipPlane plane = like;
  if (like.box_face < 0) {
    plane.point = pose.points[0];
    plane.normal = like.keep_back_side ? -plane_normal(pose) : plane_normal(pose);
    return plane;
  }
  const int axis = like.box_face / 2;
  const bool high = like.box_face % 2 == 1;
  plane.point = pose.points[high ? 1 : 0];
  plane.normal = Vec3(0.0);
  plane.normal[axis] = high ? -1 : 1;
  return plane;
}

std::vector<Vec3> make_widget_seeds(Kind kind, const widget::Pose& pose, int count) {
  if (kind == Kind::rake) return flow::seeds_on_line(pose.points[0], pose.points[1], count);
  return {pose.points[0]};
}

Outcome set_widget_pose(Scene& scene, Entity entity, const widget::Pose& pose) {
  Widget& widget = scene.entities.get<Widget>(entity);
  widget::Spec& spec = widget.spec;
  const bool two = spec.kind == Kind::rake || spec.kind == Kind::box || spec.kind == Kind::ruler, plane = spec.kind == Kind::cutting_plane;
  if (!is_finite(pose.points[0]) || (two && !is_finite(pose.points[1])) || (plane && !is_finite(pose.orientation)))
    return Error{"a position or orientation is not finite; finite numbers were expected"};
  for (int i = 0; i < 3; ++i)
    if (spec.kind == Kind::box && !(pose.points[0][i] < pose.points[1][i]))
      return Error{"the box is empty; \"max\" above \"min\" on every axis was expected"};
  widget::Pose to = spec.pose;
  to.points[0] = pose.points[0];
  if (two) to.points[1] = pose.points[1];
  if (plane) to.orientation = normalize_orientation(pose.orientation);
  spec.pose = to;
  ++spec.revision;
  widget::Report state;
  state.pose = to;
  state.revision = spec.revision;
  state.value = widget.report.value;
  if (spec.field) {
    field::Cursor cursor;
    if (const double value = spec.field->sample(to.points[0], cursor).value; std::isfinite(value)) state.value = value;
  }
  widget.report = state;
  return Done{};
}

bool has_haptic_link(const Scene& scene, Entity widget) {
  const std::string& name = scene.entities.get<Name>(widget).value;
  bool found = false;
  scene.entities.each<Link>([&](Entity, const Link& link) {
    for (const auto& [key, value] : link.node.members)
      if (const json::Node* named = value.find("widget"); named != nullptr && named->string == name) found = true;
  });
  return found;
}

}  // namespace catena::scene
