#include "engine/scene/prepare.h"

#include <algorithm>

#include "engine/scene/hidden.h"
#include "engine/scene/lines.h"
#include "engine/scene/widgets.h"

namespace catena::scene {

namespace {

/// The entities with a visible T; a copy, as components are added meanwhile.
template <class T>
std::vector<Entity> visible(const World& world) {
  std::vector<Entity> all;
  world.each<T>([&](Entity e, const T&) {
    if (!is_hidden(world, e)) all.push_back(e);
  });
  return all;
}

/// What rays meet: a field, and the field that colours it.
template <class T>
Outcome load_drawn(Scene& scene) {
  for (const Entity e : visible<T>(scene.world)) {
    const T& item = scene.world.get<T>(e);
    CATENA_CHECK(use_drawn_field(scene, item.field, item.where));
    if (item.color_by) CATENA_CHECK(use_drawn_field(scene, item.color_by->field, item.color_by->where));
  }
  return Done{};
}

Outcome load_meshes(Scene& scene) {
  for (const Entity e : visible<SurfaceMesh>(scene.world)) {
    const SurfaceMesh& surface = scene.world.get<SurfaceMesh>(e);
    CATENA_CHECK(use_mesh(scene, surface.mesh));
    if (surface.color_by) CATENA_CHECK(use_field(scene, surface.color_by->field, surface.where));
  }
  return Done{};
}

Outcome load_flows(Scene& scene, Streamlines streamlines) {
  for (const Entity e : visible<StreamlineSet>(scene.world)) {
    if (streamlines == Streamlines::traced && lines_version(scene, e) == 0) CATENA_CHECK(use_lines(scene, e));
    const StreamlineSet& set = scene.world.get<StreamlineSet>(e);
    if (set.color_by && set.color_by->what == ColorBy::What::field) CATENA_CHECK(use_field(scene, set.color_by->field, set.where));
  }
  for (const Entity e : visible<Indicator>(scene.world)) {
    const Indicator& indicator = scene.world.get<Indicator>(e);
    CATENA_CHECK(use_field(scene, indicator.field, indicator.where));
  }
  return Done{};
}

/// The vectors, what colours them, and what they lie on, drawn or not.
Outcome load_glyphs(Scene& scene) {
  for (const Entity e : visible<GlyphSet>(scene.world)) {
    const GlyphSet& set = scene.world.get<GlyphSet>(e);
    CATENA_CHECK(use_field(scene, set.field, set.where));
    if (set.color_by && set.color_by->what == ColorBy::What::field) CATENA_CHECK(use_field(scene, set.color_by->field, set.where));
    if (set.on == GlyphSet::On::mesh) CATENA_CHECK(use_mesh(scene, set.base));
    if (set.on == GlyphSet::On::slice) {
      const Slice& slice = scene.world.get<Slice>(set.base);
      CATENA_CHECK(use_drawn_field(scene, slice.shown.field, slice.where));
    }
    if (set.on == GlyphSet::On::isosurface) {
      const Isosurface& surface = scene.world.get<Isosurface>(set.base);
      CATENA_CHECK(use_drawn_field(scene, surface.field, surface.where));
    }
  }
  return Done{};
}

/// Of curves and points: what `use` loads of them, and the field that colours it.
template <class T, class Use>
Outcome load_files(Scene& scene, const Use& use) {
  for (const Entity e : visible<T>(scene.world)) {
    CATENA_CHECK(use(e));
    const std::optional<ColorBy>& by = scene.world.get<T>(e).color_by;
    if (by && by->what == ColorBy::What::field) CATENA_CHECK(use_field(scene, by->field, by->where));
  }
  return Done{};
}

}  // namespace

Outcome prepare(Scene& scene, Streamlines streamlines) {
  CATENA_CHECK(drive_widgets(scene));
  CATENA_CHECK(load_drawn<Volume>(scene));
  CATENA_CHECK(load_drawn<Isosurface>(scene));
  CATENA_CHECK(load_meshes(scene));
  for (const Entity e : visible<Slice>(scene.world)) {
    const Slice& slice = scene.world.get<Slice>(e);
    CATENA_CHECK(use_drawn_field(scene, slice.shown.field, slice.where));
  }
  CATENA_CHECK(load_flows(scene, streamlines));
  CATENA_CHECK(load_glyphs(scene));
  CATENA_CHECK(load_files<DrawnCurves>(scene, [&](Entity e) { return use_curves(scene, e); }));
  CATENA_CHECK(load_files<DrawnPoints>(scene, [&](Entity e) { return use_points(scene, e); }));
  if (scene.bounding_box && scene.bounding_box->field)
    CATENA_CHECK(use_drawn_field(scene, scene.bounding_box->field, scene.bounding_box->where));
  if (scene.axes && scene.axes->field) CATENA_CHECK(use_drawn_field(scene, scene.axes->field, scene.axes->where));
  return Done{};
}

Bounds prepared_bounds(const Scene& scene) {
  Bounds bounds;
  scene.world.each<FieldSource>([&](Entity, const FieldSource& source) {
    for (const field::AnyField* field : {&source.loaded, &source.drawn})
      if (field->get() != nullptr) bounds.add(field->get()->world_bounds());
  });
  scene.world.each<MeshSource>([&](Entity, const MeshSource& source) {
    if (!source.loaded) return;
    bounds.add(source.loaded->lowest());
    bounds.add(source.loaded->highest());
  });
  const auto add_box = [&](Entity, const auto& source) {
    if (!source.loaded) return;
    bounds.add(source.loaded->lowest);
    bounds.add(source.loaded->highest);
  };
  scene.world.each<DrawnCurves>(add_box);
  scene.world.each<DrawnPoints>(add_box);
  for (const Entity e : visible<StreamlineSet>(scene.world)) bounds.add(lines_bounds(scene, e));
  return bounds;
}

/// Widgets: the tick's reports -> components -> what follows them.

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
  scene.world.each<GlyphSet>([&](Entity, GlyphSet& set) {
    if (set.widget != entity) return;
    set.point = pose.points[0];
    set.normal = normal_of(pose);
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

/// It is drawn, or something that is drawn lies on it.
bool is_shown(const Scene& scene, Entity surface) {
  bool shown = !is_hidden(scene.world, surface);
  scene.world.each<GlyphSet>([&](Entity e, const GlyphSet& set) { shown = shown || (set.base == surface && !is_hidden(scene.world, e)); });
  return shown;
}

/// Levels of surfaces that nobody sees are left: their fields are not loaded for them.
Outcome drive_levels(Scene& scene, Entity entity, double value, WidgetChanges& changes) {
  std::vector<Entity> surfaces;
  scene.world.each<Isosurface>([&](Entity e, const Isosurface& surface) {
    if (surface.level_from == entity && is_shown(scene, e)) surfaces.push_back(e);
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

void update_cursor(Scene& scene, const exchange::HapticState& state) {
  if (!is_finite(state.probe)) return;
  Cursor& cursor = scene.world.get<Cursor>(scene.cursor);
  cursor.probe = state.probe;
  cursor.force_n = state.force_n;
  cursor.visible = true;
  const int links = std::clamp(state.link_count, 0, exchange::kMaxLinks);
  cursor.proxies.clear();
  cursor.active.clear();
  cursor.leaving.clear();
  cursor.statuses.clear();
  for (int i = 0; i < links; ++i) {
    const exchange::LinkReport& link = state.links[static_cast<std::size_t>(i)];
    cursor.proxies.push_back(link.proxy);
    cursor.active.push_back(link.active);
    cursor.statuses.push_back(link.status);
    cursor.leaving.push_back(link.left ? 1.0 : std::clamp(link.leaving, 0.0, 1.0));
  }
}

}  // namespace catena::scene
