// SPDX-License-Identifier: MIT
#include "engine/scene/prepare.h"

#include <algorithm>

#include "engine/scene/drawable.h"
#include "engine/scene/streamlines.h"
#include "engine/scene/widgets.h"

namespace catena::scene {

Outcome prepare(Scene& scene, StreamlineTracing streamlines) {
  CATENA_CHECK(propagate_widgets(scene));
  for (const Drawable& kind : drawables())
    if (kind.load != nullptr) CATENA_CHECK(kind.load(scene));
  if (streamlines == StreamlineTracing::immediate)
    for (const Entity e : visible_entities<StreamlineSet>(scene.entities))
      if (lines_version(scene, e) == 0) CATENA_CHECK(resolve_lines(scene, e));
  for (const Entity e : visible_entities<Indicator>(scene.entities)) {
    const Indicator& indicator = scene.entities.get<Indicator>(e);
    CATENA_CHECK(resolve_field(scene, indicator.field, indicator.where));
  }
  if (scene.bounding_box && scene.bounding_box->field)
    CATENA_CHECK(resolve_rendered_field(scene, scene.bounding_box->field, scene.bounding_box->where));
  if (scene.axes && scene.axes->field) CATENA_CHECK(resolve_rendered_field(scene, scene.axes->field, scene.axes->where));
  return Done{};
}

Bounds scene_bounds(const Scene& scene) {
  Bounds bounds;
  scene.entities.each<FieldSource>([&](Entity, const FieldSource& source) {
    for (const field::AnyField* field : {&source.loaded, &source.rendered})
      if (field->get() != nullptr) bounds.extend(field->get()->world_bounds());
  });
  scene.entities.each<MeshSource>([&](Entity, const MeshSource& source) {
    if (!source.loaded) return;
    bounds.extend(source.loaded->min_corner());
    bounds.extend(source.loaded->max_corner());
  });
  const auto add_box = [&](Entity, const auto& source) {
    if (!source.loaded) return;
    bounds.extend(source.loaded->min_corner);
    bounds.extend(source.loaded->max_corner);
  };
  scene.entities.each<CurvesSource>(add_box);
  scene.entities.each<PointsSource>(add_box);
  for (const Entity e : visible_entities<StreamlineSet>(scene.entities)) bounds.extend(lines_bounds(scene, e));
  return bounds;
}

// Data flow of widgets: tick reports, components, then the objects bound to them.

namespace {

bool is_valid_report(const widget::Report& report) {
  const Quat& q = report.pose.orientation;
  return is_finite(report.pose.points[0]) && is_finite(report.pose.points[1]) && std::isfinite(report.value) && is_finite(q) &&
         std::fabs(q.w * q.w + q.x * q.x + q.y * q.y + q.z * q.z - 1) < 1e-6;
}

std::vector<Entity> all_widgets(const Scene& scene) {
  std::vector<Entity> all;
  scene.entities.each<Widget>([&](Entity e, const Widget&) { all.push_back(e); });
  return all;
}

void drive_planes(Scene& scene, Entity entity, const widget::Pose& pose, WidgetChanges& changes) {
  scene.entities.each<Slice>([&](Entity, Slice& slice) {
    if (slice.widget != entity) return;
    slice.point = pose.points[0];
    slice.normal = plane_normal(pose);
    changes.slices = true;
  });
  scene.entities.each<GlyphSet>([&](Entity, GlyphSet& set) {
    if (set.widget != entity) return;
    set.point = pose.points[0];
    set.normal = plane_normal(pose);
    changes.slices = true;
  });
  for (ClipPlane& plane : scene.clip_planes)
    if (plane.widget == entity) {
      plane = make_clip_plane(pose, plane);
      changes.clip = true;
    }
}

void drive_seeds(Scene& scene, Entity entity, const Widget& widget, WidgetChanges& changes) {
  scene.entities.each<StreamlineSet>([&](Entity, StreamlineSet& set) {
    if (set.seeds.widget != entity) return;
    set.seeds.points = make_widget_seeds(widget.spec.kind, widget.report.pose, set.seeds.count);
    changes.seeds = true;
  });
}

/// Returns whether a surface is visible, or a visible object lies on it.
bool is_shown(const Scene& scene, Entity surface) {
  bool visible = !is_hidden(scene.entities, surface);
  scene.entities.each<GlyphSet>(
      [&](Entity e, const GlyphSet& set) { visible = visible || (set.support_entity == surface && !is_hidden(scene.entities, e)); });
  return visible;
}

/// Sets the levels of isosurfaces bound to the widget. Invisible surfaces are skipped: their fields are not loaded for this.
Outcome drive_levels(Scene& scene, Entity entity, double value, WidgetChanges& changes) {
  std::vector<Entity> surfaces;
  scene.entities.each<Isosurface>([&](Entity e, const Isosurface& surface) {
    if (surface.level_widget == entity && is_shown(scene, e)) surfaces.push_back(e);
  });
  for (const Entity e : surfaces) {
    const Isosurface& surface = scene.entities.get<Isosurface>(e);
    CATENA_TRY(const field::AnyField any, resolve_rendered_field(scene, surface.field, surface.where));
    // a vector field causes an error when the surface is extracted
    if (!any.scalar) continue;
    scene.entities.get<Isosurface>(e).level = std::clamp(value, any.scalar->min_value(), any.scalar->max_value());
    changes.levels = true;
  }
  return Done{};
}

}  // namespace

bool update_widgets(Scene& scene, const HapticState& state) {
  const std::vector<Entity> widgets = all_widgets(scene);
  if (state.widget_count != static_cast<int>(widgets.size()) || state.widget_count > kMaxWidgets) return false;
  bool changed = false;
  for (std::size_t i = 0; i < widgets.size(); ++i) {
    Widget& widget = scene.entities.get<Widget>(widgets[i]);
    const widget::Report& report = state.widgets[i];
    if (report.revision != widget.spec.revision || !is_valid_report(report)) continue;
    const double value = widget.spec.kind == widget::Kind::isolevel ? report.value : widget.report.value;
    changed = changed || report.pose != widget.report.pose || value != widget.report.value;
    widget.report = report;
    widget.report.value = value;
  }
  return changed;
}

Result<WidgetChanges> propagate_widgets(Scene& scene) {
  WidgetChanges changes;
  for (const Entity entity : all_widgets(scene)) {
    CATENA_CHECK(resolve_widget(scene, entity));
    Widget& widget = scene.entities.get<Widget>(entity);
    const widget::Pose pose = widget.report.pose;
    const bool moved = widget.applied_pose != pose, other_value = widget.applied_value != widget.report.value;
    if (!moved && !other_value) continue;
    // at the first call the haptic program may already have been built from the pose in the scene file
    if (widget.applied_pose || pose != widget.spec.pose) changes.links = changes.links || has_haptic_link(scene, entity);
    if (moved) drive_planes(scene, entity, pose, changes);
    if (moved) drive_seeds(scene, entity, widget, changes);
    CATENA_CHECK(drive_levels(scene, entity, widget.report.value, changes));
    widget.applied_pose = pose;
    widget.applied_value = widget.report.value;
  }
  return changes;
}

void update_cursor(Scene& scene, const HapticState& state) {
  if (!is_finite(state.probe)) return;
  Cursor& cursor = scene.entities.get<Cursor>(scene.cursor);
  cursor.probe = state.probe;
  cursor.force_n = state.force_n;
  cursor.visible = true;
  const int links = std::clamp(state.link_count, 0, kMaxLinks);
  cursor.proxies.clear();
  cursor.active.clear();
  cursor.release_ratios.clear();
  cursor.statuses.clear();
  for (int i = 0; i < links; ++i) {
    const LinkReport& link = state.links[static_cast<std::size_t>(i)];
    cursor.proxies.push_back(link.proxy);
    cursor.active.push_back(link.active);
    cursor.statuses.push_back(link.status);
    cursor.release_ratios.push_back(link.released ? 1.0 : std::clamp(link.release_ratio, 0.0, 1.0));
  }
}

}  // namespace catena::scene
