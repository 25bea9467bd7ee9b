// SPDX-License-Identifier: MIT
#include "engine/scene/widgets.h"

#include <limits>

#include "engine/base/numbers.h"
#include "engine/base/text.h"
#include "engine/geometry/flow/seeds.h"

namespace catena::scene {
namespace {

using widget::Kind;

// fractions of L
constexpr double kPlaneRadius = 0.12, kHandleRadius = 0.012, kSnap = 0.02, kRelease = 0.05, kPlaneNear = 0.02, kHandleNear = 0.03,
                 kStep = 0.02;

/// The longest domain among the fields, meshes, curves and points; 0: none.
class Longest {
 public:
  explicit Longest(Scene& scene) : scene_(scene) {}
  void add_field(Entity field, const json::Node& where) {
    if (field) fields_.emplace_back(field, where);
  }
  void add_mesh(Entity mesh) { meshes_.push_back(mesh); }
  void add_curves(Entity curves) { curves_.push_back(curves); }
  void add_points(Entity points) { points_.push_back(points); }
  Result<double> length() const {
    double longest = 0;
    for (const auto& [field, where] : fields_) {
      CATENA_TRY(const field::AnyField any, resolve_field(scene_, field, where));
      longest = std::max(longest, any.get()->domain_length());
    }
    for (const Entity mesh : meshes_) {
      CATENA_TRY(const mesh::MeshPtr loaded, resolve_mesh(scene_, mesh));
      longest = std::max(longest, loaded->domain_length());
    }
    for (const Entity curves : curves_) {
      CATENA_TRY(const auto loaded, resolve_curves(scene_, curves));
      longest = std::max(longest, max_abs(loaded->max_corner - loaded->min_corner));
    }
    for (const Entity points : points_) {
      CATENA_TRY(const auto loaded, resolve_points(scene_, points));
      longest = std::max(longest, max_abs(loaded->max_corner - loaded->min_corner));
    }
    return longest;
  }

 private:
  Scene& scene_;
  std::vector<std::pair<Entity, json::Node>> fields_;
  std::vector<Entity> meshes_, curves_, points_;
};

Result<double> length_of(Scene& scene, const Widget& widget) {
  Longest drawn(scene);
  drawn.add_field(widget.field, widget.where);
  scene.entities.each<Volume>([&](Entity, const Volume& volume) { drawn.add_field(volume.field, volume.where); });
  scene.entities.each<Isosurface>([&](Entity, const Isosurface& surface) { drawn.add_field(surface.field, surface.where); });
  scene.entities.each<Slice>([&](Entity, const Slice& slice) { drawn.add_field(slice.color_by.field, slice.where); });
  scene.entities.each<StreamlineSet>([&](Entity, const StreamlineSet& set) { drawn.add_field(set.field, set.where); });
  scene.entities.each<GlyphSet>([&](Entity, const GlyphSet& set) { drawn.add_field(set.field, set.where); });
  scene.entities.each<SurfaceMesh>([&](Entity, const SurfaceMesh& surface) { drawn.add_mesh(surface.mesh); });
  scene.entities.each<CurvesSource>([&](Entity e, const CurvesSource&) { drawn.add_curves(e); });
  scene.entities.each<PointsSource>([&](Entity e, const PointsSource&) { drawn.add_points(e); });
  CATENA_TRY(const double longest, drawn.length());
  if (longest > 0) return longest;
  // nothing is visible: use the haptic objects
  Longest felt(scene);
  scene.entities.each<Link>([&](Entity, const Link& link) {
    if (const json::Node* field = link.node.find("field"); field != nullptr && field->kind == json::Kind::string)
      felt.add_field(find_field(scene, field->string), *field);
  });
  CATENA_TRY(const double of_links, felt.length());
  return of_links > 0 ? of_links : 4;
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
  // if one of the two is given, the other keeps the default ratio to it
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
  const field::ScalarSample stated = any.scalar->sample(widget.spec.pose.points[0], cursor);
  if (widget.spec.revision == 0 && (!stated.inside || !std::isfinite(stated.value)))
    return json::error_at(json::member_or_parent(where, "position"), "the isolevel's place lies outside the domain of field " +
                                                                         in_quotes(scene.entities.get<Name>(field).value) +
                                                                         ", or has no value there; a place within it was expected");
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
    return Error{"a place or orientation is not finite; finite numbers were expected"};
  for (int i = 0; i < 3; ++i)
    if (spec.kind == Kind::box && !(pose.points[0][i] < pose.points[1][i]))
      return Error{"the box has no inside; its high corner above the low one on every axis was expected"};
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
