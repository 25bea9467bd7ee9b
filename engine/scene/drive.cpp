/// Widgets: the tick's reports -> components -> what follows them.
#include <algorithm>

#include "engine/scene/systems.h"
#include "engine/scene/widgets.h"

namespace catena::scene {
namespace {

bool is_sound(const widget::Report& report) {
  const Quat& q = report.pose.orientation;
  return is_finite(report.pose.points[0]) && is_finite(report.pose.points[1]) && std::isfinite(report.value) && is_finite(q) &&
         std::fabs(q.w * q.w + q.x * q.x + q.y * q.y + q.z * q.z - 1) < 1e-6;
}

std::vector<Entity> all_widgets(const Scene& scene) {
  std::vector<Entity> all;
  scene.world.each<Widget>([&](Entity e, const Widget&) { all.push_back(e); });
  return all;
}

void drive_planes(Scene& scene, Entity entity, const widget::Pose& pose, WidgetChanges& changes) {
  scene.world.each<Slice>([&](Entity, Slice& slice) {
    if (slice.widget != entity) return;
    slice.point = pose.points[0];
    slice.normal = normal_of(pose);
    changes.slices = true;
  });
  for (ClipPlane& plane : scene.clip)
    if (plane.widget == entity) {
      plane = clip_of(pose, plane);
      changes.clip = true;
    }
}

void drive_seeds(Scene& scene, Entity entity, const Widget& widget, WidgetChanges& changes) {
  scene.world.each<StreamlineSet>([&](Entity, StreamlineSet& set) {
    if (set.seeds.widget != entity) return;
    set.seeds.points = seeds_of(widget.spec.kind, widget.state.pose, set.seeds.count);
    changes.seeds = true;
  });
}

Outcome drive_levels(Scene& scene, Entity entity, double value, WidgetChanges& changes) {
  std::vector<Entity> surfaces;
  scene.world.each<Isosurface>([&](Entity e, const Isosurface& surface) {
    if (surface.level_from == entity) surfaces.push_back(e);
  });
  for (const Entity e : surfaces) {
    const Isosurface& surface = scene.world.get<Isosurface>(e);
    CATENA_TRY(const field::AnyField drawn, use_drawn_field(scene, surface.field, surface.where));
    // a vector field is an error where the surface is extracted
    if (!drawn.scalar) continue;
    scene.world.get<Isosurface>(e).level = std::clamp(value, drawn.scalar->min_value(), drawn.scalar->max_value());
    changes.levels = true;
  }
  return Done{};
}

}  // namespace

bool update_widgets(Scene& scene, const exchange::HapticState& state) {
  const std::vector<Entity> widgets = all_widgets(scene);
  if (state.widget_count != static_cast<int>(widgets.size()) || state.widget_count > exchange::kMaxWidgets) return false;
  bool changed = false;
  for (std::size_t i = 0; i < widgets.size(); ++i) {
    Widget& widget = scene.world.get<Widget>(widgets[i]);
    const widget::Report& report = state.widgets[i];
    if (report.revision != widget.spec.revision || !is_sound(report)) continue;
    const double value = widget.spec.kind == widget::Kind::isolevel ? report.value : widget.state.value;
    changed = changed || report.pose != widget.state.pose || value != widget.state.value;
    widget.state = report;
    widget.state.value = value;
  }
  return changed;
}

Result<WidgetChanges> drive_widgets(Scene& scene) {
  WidgetChanges changes;
  for (const Entity entity : all_widgets(scene)) {
    CATENA_CHECK(use_widget(scene, entity));
    Widget& widget = scene.world.get<Widget>(entity);
    const widget::Pose pose = widget.state.pose;
    const bool moved = widget.followed != pose, other_value = widget.followed_value != widget.state.value;
    if (!moved && !other_value) continue;
    // the first time a program may have been made already: of the pose as stated
    if (widget.followed || pose != widget.spec.pose) changes.links = changes.links || is_felt(scene, entity);
    if (moved) drive_planes(scene, entity, pose, changes);
    if (moved) drive_seeds(scene, entity, widget, changes);
    CATENA_CHECK(drive_levels(scene, entity, widget.state.value, changes));
    widget.followed = pose;
    widget.followed_value = widget.state.value;
  }
  return changes;
}

}  // namespace catena::scene
