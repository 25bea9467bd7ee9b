#include "engine/scene/widgets.h"

#include <limits>

#include "engine/base/numbers.h"
#include "engine/base/text.h"
#include "engine/flow/seeds.h"

namespace catena::scene {
namespace {

using widget::Kind;

// of L
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
      CATENA_TRY(const field::AnyField any, use_field(scene_, field, where));
      longest = std::max(longest, any.get()->length());
    }
    for (const Entity mesh : meshes_) {
      CATENA_TRY(const mesh::MeshPtr loaded, use_mesh(scene_, mesh));
      longest = std::max(longest, loaded->length());
    }
    for (const Entity curves : curves_) {
      CATENA_TRY(const auto loaded, use_curves(scene_, curves));
      longest = std::max(longest, max_abs(loaded->highest - loaded->lowest));
    }
    for (const Entity points : points_) {
      CATENA_TRY(const auto loaded, use_points(scene_, points));
      longest = std::max(longest, max_abs(loaded->highest - loaded->lowest));
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
  scene.world.each<Volume>([&](Entity, const Volume& volume) { drawn.add_field(volume.field, volume.where); });
  scene.world.each<Isosurface>([&](Entity, const Isosurface& surface) { drawn.add_field(surface.field, surface.where); });
  scene.world.each<Slice>([&](Entity, const Slice& slice) { drawn.add_field(slice.shown.field, slice.where); });
  scene.world.each<StreamlineSet>([&](Entity, const StreamlineSet& set) { drawn.add_field(set.field, set.where); });
  scene.world.each<GlyphSet>([&](Entity, const GlyphSet& set) { drawn.add_field(set.field, set.where); });
  scene.world.each<SurfaceMesh>([&](Entity, const SurfaceMesh& surface) { drawn.add_mesh(surface.mesh); });
  scene.world.each<DrawnCurves>([&](Entity e, const DrawnCurves&) { drawn.add_curves(e); });
  scene.world.each<DrawnPoints>([&](Entity e, const DrawnPoints&) { drawn.add_points(e); });
  CATENA_TRY(const double longest, drawn.length());
  if (longest > 0) return longest;
  // nothing is drawn: what is felt
  Longest felt(scene);
  scene.world.each<Link>([&](Entity, const Link& link) {
    if (const json::Node* field = link.node.find("field"); field != nullptr && field->kind == json::Kind::string)
      felt.add_field(find_field(scene, field->string), *field);
  });
  CATENA_TRY(const double of_links, felt.length());
  return of_links > 0 ? of_links : 4;
}

/// Of a size that is not stated.
void fit(double& size, double fitted) {
  if (!(size > 0)) size = fitted;
}

void complete_sizes(widget::Spec& spec) {
  const double length = spec.length;
  const bool plane = spec.kind == Kind::cutting_plane;
  fit(spec.radius, (plane ? kPlaneRadius : kHandleRadius) * length);
  fit(spec.near, (plane ? kPlaneNear : kHandleNear) * length);
  fit(spec.step, kStep * length);
  if (!plane) return;
  // where one is stated the other keeps its proportion
  const double snap = spec.snap, release = spec.release;
  fit(spec.snap, release > 0 ? kSnap / kRelease * release : kSnap * length);
  fit(spec.release, snap > 0 ? kRelease / kSnap * snap : kRelease * length);
}

Outcome load_isolevel(Scene& scene, Entity entity) {
  const json::Node where = scene.world.get<Widget>(entity).where;
  const Entity field = scene.world.get<Widget>(entity).field;
  CATENA_TRY(const field::AnyField any, use_field(scene, field, json::member_or(where, "field")));
  if (!any.scalar)
    return json::error_at(json::member_or(where, "field"), in_quotes(scene.world.get<Name>(field).value) +
                                                               " is a vector field; a scalar field was expected for an isolevel");
  Widget& widget = scene.world.get<Widget>(entity);
  field::Cursor cursor;
  const field::ScalarSample stated = any.scalar->sample(widget.spec.pose.points[0], cursor);
  if (widget.spec.revision == 0 && (!stated.inside || !std::isfinite(stated.value)))
    return json::error_at(json::member_or(where, "position"), "the isolevel's place lies outside the domain of field " +
                                                                  in_quotes(scene.world.get<Name>(field).value) +
                                                                  ", or has no value there; a place within it was expected");
  const field::ScalarSample now = any.scalar->sample(widget.state.pose.points[0], cursor);
  if (std::isfinite(now.value)) widget.state.value = now.value;
  widget.spec.field = any.scalar;
  return Done{};
}

}  // namespace

Quat unit_orientation(const Quat& q) {
  const double square = q.w * q.w + q.x * q.x + q.y * q.y + q.z * q.z;
  return std::fabs(square - 1) <= 8 * std::numeric_limits<double>::epsilon() ? q : normalised(q);
}

Result<widget::Spec> use_widget(Scene& scene, Entity entity) {
  if (!scene.world.get<Widget>(entity).complete) {
    CATENA_TRY(const double length, length_of(scene, scene.world.get<Widget>(entity)));
    if (scene.world.get<Widget>(entity).spec.kind == Kind::isolevel) CATENA_CHECK(load_isolevel(scene, entity));
    Widget& widget = scene.world.get<Widget>(entity);
    widget.spec.length = length;
    complete_sizes(widget.spec);
    widget.complete = true;
  }
  return scene.world.get<Widget>(entity).spec;
}

Vec3 normal_of(const widget::Pose& pose) { return rotate(pose.orientation, {0.0, 0.0, 1.0}); }

ClipPlane clip_of(const widget::Pose& pose, const ClipPlane& like) {
  ClipPlane plane = like;
  if (like.box_face < 0) {
    plane.point = pose.points[0];
    plane.normal = like.behind ? -normal_of(pose) : normal_of(pose);
    return plane;
  }
  const int axis = like.box_face / 2;
  const bool high = like.box_face % 2 == 1;
  plane.point = pose.points[high ? 1 : 0];
  plane.normal = Vec3(0.0);
  plane.normal[axis] = high ? -1 : 1;
  return plane;
}

std::vector<Vec3> seeds_of(Kind kind, const widget::Pose& pose, int count) {
  if (kind == Kind::rake) return flow::seeds_on_line(pose.points[0], pose.points[1], count);
  return {pose.points[0]};
}

Outcome set_widget_pose(Scene& scene, Entity entity, const widget::Pose& pose) {
  Widget& widget = scene.world.get<Widget>(entity);
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
  if (plane) to.orientation = unit_orientation(pose.orientation);
  spec.pose = to;
  ++spec.revision;
  widget::Report state;
  state.pose = to;
  state.revision = spec.revision;
  state.value = widget.state.value;
  if (spec.field) {
    field::Cursor cursor;
    if (const double value = spec.field->sample(to.points[0], cursor).value; std::isfinite(value)) state.value = value;
  }
  widget.state = state;
  return Done{};
}

bool is_felt(const Scene& scene, Entity widget) {
  const std::string& name = scene.world.get<Name>(widget).value;
  bool found = false;
  scene.world.each<Link>([&](Entity, const Link& link) {
    for (const auto& [key, value] : link.node.members)
      if (const json::Node* named = value.find("widget"); named != nullptr && named->string == name) found = true;
  });
  return found;
}

}  // namespace catena::scene
