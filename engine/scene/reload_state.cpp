// SPDX-License-Identifier: MIT
#include <algorithm>

#include "engine/base/output_file.h"
#include "engine/scene/auto_transfer.h"
#include "engine/scene/document.h"
#include "engine/scene/drawable.h"
#include "engine/scene/labels.h"
#include "engine/scene/streamlines.h"
#include "engine/scene/time_steps.h"

namespace catena::scene {
namespace {

// ---- sources ----

bool same_request(const field::LoadRequest& a, const field::LoadRequest& b) {
  field::LoadRequest renamed = a;
  renamed.path = b.path;
  return renamed == b && (a.path == b.path || is_same_file(a.path, b.path));
}

bool same_source(const FieldSource& a, const FieldSource& b) {
  if (a.file.has_value() != b.file.has_value() || a.label != b.label || a.derived != b.derived) return false;
  if (a.file) return a.grid_is_optional == b.grid_is_optional && same_request(*a.file, *b.file);
  return a.analytic == b.analytic && a.parameters == b.parameters;
}

/// Returns whether everything that a field is derived from is unchanged, down to files and formulas.
bool same_sources_of(const Scene& old, const FieldSource& before, const Scene& reloaded, const FieldSource& source) {
  if (!same_source(before, source) || !source.derived) return same_source(before, source);
  std::vector<std::string> names = source.derived->sources;
  if (!source.derived->on.empty()) names.push_back(source.derived->on);
  return std::ranges::all_of(names, [&](const std::string& name) {
    const Entity was = find_field(old, name), is = find_field(reloaded, name);
    return was && is && same_sources_of(old, old.entities.get<FieldSource>(was), reloaded, reloaded.entities.get<FieldSource>(is));
  });
}

/// Returns whether the label map of a label surface is unchanged; the surface is then unchanged as well.
bool same_map(const Scene& old, const FieldSource& before, const Scene& reloaded, const FieldSource& source) {
  if (source.derived) return same_sources_of(old, before, reloaded, source);
  if (!source.label) return true;
  const Entity old_map = find_field(old, source.label->label_map), new_map = find_field(reloaded, source.label->label_map);
  if (!old_map || !new_map) return false;
  const FieldSource &map_was = old.entities.get<FieldSource>(old_map), &map_is = reloaded.entities.get<FieldSource>(new_map);
  return before.label == source.label && same_source(map_was, map_is) && map_was.labels_table == map_is.labels_table;
}

bool same_drawing(const FieldSource& a, const FieldSource& b) { return a.file || (a.resolution == b.resolution && a.box == b.box); }

/// Returns whether both are the same step of the same file.
template <class T>
bool same_table(const T& a, const T& b) {
  const bool same_step = a.steps.step == b.steps.step || std::max(a.steps.times.size(), b.steps.times.size()) < 2;
  return same_step && (a.path == b.path || is_same_file(a.path, b.path));
}

bool same_curves(const CurvesSource& a, const CurvesSource& b) {
  if (!a.vortex_cores || !b.vortex_cores) return !a.vortex_cores && !b.vortex_cores && same_table(a, b);
  return a.vortex_cores->field == b.vortex_cores->field && a.vortex_cores->options == b.vortex_cores->options;
}

bool same_mesh(const MeshSource& a, const MeshSource& b) { return a.placement == b.placement && same_table(a, b); }

void carry_fields(Scene& old, Scene& reloaded) {
  reloaded.entities.each<FieldSource>([&](Entity e, FieldSource& source) {
    old.entities.each<FieldSource>([&](Entity f, const FieldSource& before) {
      if (before.loaded.get() == nullptr || !same_source(before, source) || !same_map(old, before, reloaded, source)) return;
      if (source.loaded.get() == nullptr) source.loaded = before.loaded;
      source.has_changed_step = source.has_changed_step || before.has_changed_step;
      if (source.loaded.get() == before.loaded.get() && source.labels_table == before.labels_table) source.labels = before.labels;
      load_label_map(source);
      if (source.rendered.get() == nullptr && source.loaded.get() == before.loaded.get() && same_drawing(before, source))
        source.rendered = before.rendered;
      // keep a value sample that was already computed
      if (source.rendered.get() != nullptr && source.rendered.get() == before.rendered.get() && old.cache.has<SortedValues>(f) &&
          !reloaded.cache.has<SortedValues>(e))
        reloaded.cache.emplace<SortedValues>(e, old.cache.get<SortedValues>(f));
    });
  });
}

/// Transfers loaded meshes, curves or points.
template <class T, class Same>
void carry_shapes(Scene& old, Scene& reloaded, const Same& is_same) {
  reloaded.entities.each<T>([&](Entity, T& source) {
    old.entities.each<T>([&](Entity, const T& before) {
      if (source.loaded || !before.loaded || !is_same(before, source)) return;
      source.loaded = before.loaded;
      source.steps.times = before.steps.times;
      if constexpr (requires { source.vortex_cores; }) source.vortex_cores = before.vortex_cores;
    });
  });
}

// ---- automatic colors and opacities: functions of the rendered grid and of the explicit keys ----

bool states(const json::Node& where, const char* key) { return where.find(key) != nullptr; }
bool states_colors(const json::Node& where) {
  const json::Node* color = where.find("color");
  return color != nullptr && color->kind != json::Kind::string;
}

void carry_transfers(const Scene& old, Scene& reloaded) {
  reloaded.entities.each<Volume>([&](Entity, Volume& volume) {
    const void* grid = reloaded.entities.get<FieldSource>(volume.field).rendered.get();
    TransferFunction& transfer = volume.transfer;
    old.entities.each<Volume>([&](Entity, const Volume& before) {
      const TransferFunction& completed = before.transfer;
      if (reloaded.entities.get<FieldSource>(volume.field).labels != old.entities.get<FieldSource>(before.field).labels) return;
      if (grid == nullptr || old.entities.get<FieldSource>(before.field).rendered.get() != grid || !completed.file.empty() ||
          !transfer.file.empty())
        return;
      if (transfer.colors.empty() && !states_colors(before.where) && completed.named == transfer.named) transfer.colors = completed.colors;
      if (transfer.opacities.empty() && transfer.extinctions.empty() && !states(before.where, "opacity") &&
          !states(before.where, "extinction") && completed.named.range == transfer.named.range &&
          completed.named.mapping == transfer.named.mapping)
        transfer.extinctions = completed.extinctions;
    });
  });
}

// ---- cached data of the entities ----

bool names_a_file(const json::Node& node) {
  for (const json::Node& item : node.items)
    if (names_a_file(item)) return true;
  for (const auto& [key, member] : node.members)
    if (key == "transfer" || names_a_file(member)) return true;
  return false;
}

/// Returns whether every T of the reloaded scene equals the one of the same name in the old scene.
template <class T, class Same>
bool all_same(const Scene& old, const Scene& reloaded, const Same& is_same) {
  bool same = true;
  reloaded.entities.each<T>([&](Entity e, const T& source) {
    const Entity before = find_named<T>(old, reloaded.entities.get<Name>(e).value);
    same = same && before && is_same(old.entities.get<T>(before), source);
  });
  return same;
}

/// Returns whether all sources are the same, so that equal descriptions mean the same data.
bool same_sources(const Scene& old, const Scene& reloaded) {
  const auto same_field = [](const FieldSource& a, const FieldSource& b) {
    return same_source(a, b) && same_drawing(a, b) && a.labels_table == b.labels_table;
  };
  return all_same<FieldSource>(old, reloaded, same_field) && all_same<MeshSource>(old, reloaded, same_mesh) &&
         all_same<CurvesSource>(old, reloaded, same_curves) && all_same<PointsSource>(old, reloaded, same_table<PointsSource>);
}

void carry_cached(const Drawable& kind, Scene& old, Scene& reloaded) {
  std::vector<DrawableItem> unmatched = kind.items(old.entities);
  for (const auto& [e, where] : kind.items(reloaded.entities)) {
    const auto same = [&, node = where](const DrawableItem& before) { return before.first && json::is_equal_value(*before.second, *node); };
    const auto it = names_a_file(*where) ? unmatched.end() : std::find_if(unmatched.begin(), unmatched.end(), same);
    if (it == unmatched.end()) continue;
    reloaded.cache.move_missing_from(e, old.cache, it->first);
    it->first = Entity{};
  }
}

// ---- widgets ----

bool same_place(const json::Node& a, const json::Node& b) {
  for (const char* key : {"type", "center", "normal", "orientation", "position", "from", "to", "min", "max", "field"}) {
    const json::Node *x = a.find(key), *y = b.find(key);
    if ((x == nullptr) != (y == nullptr) || (x != nullptr && !json::is_equal_value(*x, *y))) return false;
  }
  return true;
}

void carry_widgets(const Scene& old, Scene& reloaded) {
  reloaded.entities.each<Widget>([&](Entity e, Widget& widget) {
    old.entities.each<Widget>([&](Entity f, const Widget& before) {
      if (before.spec.kind != widget.spec.kind || old.entities.get<Name>(f).value != reloaded.entities.get<Name>(e).value) return;
      if (same_place(before.where, widget.where)) {
        widget.spec.pose = before.spec.pose;
      } else if (!(widget.spec.pose == before.report.pose)) {
        // the pose in the scene file differs from the pose to which the user moved the widget
        widget.spec.revision = before.spec.revision + 1;
        widget.report = {};
        widget.report.pose = widget.spec.pose;
        widget.report.revision = widget.spec.revision;
        return;
      }
      widget.spec.revision = before.spec.revision;
      widget.report = before.report;
    });
  });
}

/// Transfers the known steps of sources with the same pattern or file: steps found since the first load are kept, none are added.
void carry_steps(const Scene& old, Scene& reloaded) {
  reloaded.entities.each<FieldSource>([&](Entity, FieldSource& source) {
    old.entities.each<FieldSource>([&](Entity, const FieldSource& before) {
      if (before.pattern != source.pattern || before.has_own_step || source.has_own_step || !before.file || !source.file) return;
      if (source.pattern.empty() && before.file->path != source.file->path) return;
      source.series = before.series;
      source.follows = before.follows;
      source.known_times = before.known_times;
      assign_step(source, reloaded.time.step);
    });
  });
  const auto carry = [&](auto& shape, const auto& before) {
    if (before.steps.pattern != shape.steps.pattern || before.steps.pattern.empty()) return;
    shape.steps.series = before.steps.series;
    shape.steps.follows = before.steps.follows;
    assign_step(shape, reloaded.time.step);
  };
  reloaded.entities.each<MeshSource>(
      [&](Entity, MeshSource& shape) { old.entities.each<MeshSource>([&](Entity, const MeshSource& before) { carry(shape, before); }); });
  reloaded.entities.each<CurvesSource>([&](Entity, CurvesSource& shape) {
    old.entities.each<CurvesSource>([&](Entity, const CurvesSource& before) { carry(shape, before); });
  });
  reloaded.entities.each<PointsSource>([&](Entity, PointsSource& shape) {
    old.entities.each<PointsSource>([&](Entity, const PointsSource& before) { carry(shape, before); });
  });
}

}  // namespace

void transfer_state(Scene& old, Scene& reloaded) {
  carry_steps(old, reloaded);
  set_step(reloaded, old.time.step);
  carry_fields(old, reloaded);
  carry_shapes<MeshSource>(old, reloaded, same_mesh);
  carry_shapes<CurvesSource>(old, reloaded, same_curves);
  carry_shapes<PointsSource>(old, reloaded, same_table<PointsSource>);
  carry_transfers(old, reloaded);
  // the curves come before the line sets, which refer to them
  for (auto& [key, curve] : old.traced_curves)
    if (curve.use_count() > 1) reloaded.traced_curves.emplace(key, curve);
  if (same_sources(old, reloaded))
    for (const Drawable& kind : drawables()) carry_cached(kind, old, reloaded);
  transfer_lines(old, reloaded);
  carry_widgets(old, reloaded);
  reloaded.animation_phase = old.animation_phase;
  Cursor& cursor = reloaded.entities.get<Cursor>(reloaded.cursor);
  const Cursor new_cursor = cursor;
  cursor = std::move(old.entities.get<Cursor>(old.cursor));
  cursor.size = new_cursor.size;
  cursor.show_occluded = new_cursor.show_occluded;
  cursor.drop_line = new_cursor.drop_line;
  cursor.crosshair = new_cursor.crosshair;
}

}  // namespace catena::scene
