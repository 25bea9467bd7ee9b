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
  if (a.file.has_value() != b.file.has_value() || a.label != b.label) return false;
  if (a.file) return a.grid_is_optional == b.grid_is_optional && same_request(*a.file, *b.file);
  return a.analytic == b.analytic && a.parameters == b.parameters;
}

/// Whether a label surface is unchanged: its label map is.
bool same_map(const Scene& old, const FieldSource& before, const Scene& fresh, const FieldSource& source) {
  if (!source.label) return true;
  const Entity was = find_field(old, source.label->label_map), is = find_field(fresh, source.label->label_map);
  if (!was || !is) return false;
  const FieldSource &map_was = old.entities.get<FieldSource>(was), &map_is = fresh.entities.get<FieldSource>(is);
  return before.label == source.label && same_source(map_was, map_is) && map_was.labels_table == map_is.labels_table;
}

bool same_drawing(const FieldSource& a, const FieldSource& b) { return a.file || (a.resolution == b.resolution && a.box == b.box); }

/// Whether both are the same step of the same file.
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

void carry_fields(Scene& old, Scene& fresh) {
  fresh.entities.each<FieldSource>([&](Entity e, FieldSource& source) {
    old.entities.each<FieldSource>([&](Entity f, const FieldSource& before) {
      if (before.loaded.get() == nullptr || !same_source(before, source) || !same_map(old, before, fresh, source)) return;
      if (source.loaded.get() == nullptr) source.loaded = before.loaded;
      source.has_changed_step = source.has_changed_step || before.has_changed_step;
      if (source.loaded.get() == before.loaded.get() && source.labels_table == before.labels_table) source.labels = before.labels;
      load_label_map(source);
      if (source.rendered.get() == nullptr && source.loaded.get() == before.loaded.get() && same_drawing(before, source))
        source.rendered = before.rendered;
      // keep a value sample that was already computed
      if (source.rendered.get() != nullptr && source.rendered.get() == before.rendered.get() && old.cache.has<ValueSample>(f) &&
          !fresh.cache.has<ValueSample>(e))
        fresh.cache.emplace<ValueSample>(e, old.cache.get<ValueSample>(f));
    });
  });
}

/// Transfers loaded meshes, curves or points.
template <class T, class Same>
void carry_shapes(Scene& old, Scene& fresh, const Same& is_same) {
  fresh.entities.each<T>([&](Entity, T& source) {
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

void carry_transfers(const Scene& old, Scene& fresh) {
  fresh.entities.each<Volume>([&](Entity, Volume& volume) {
    const void* grid = fresh.entities.get<FieldSource>(volume.field).rendered.get();
    TransferFunction& transfer = volume.transfer;
    old.entities.each<Volume>([&](Entity, const Volume& before) {
      const TransferFunction& made = before.transfer;
      if (fresh.entities.get<FieldSource>(volume.field).labels != old.entities.get<FieldSource>(before.field).labels) return;
      if (grid == nullptr || old.entities.get<FieldSource>(before.field).rendered.get() != grid || !made.file.empty() ||
          !transfer.file.empty())
        return;
      if (transfer.colors.empty() && !states_colors(before.where) && made.named == transfer.named) transfer.colors = made.colors;
      if (transfer.opacities.empty() && transfer.extinctions.empty() && !states(before.where, "opacity") &&
          !states(before.where, "extinction") && made.named.range == transfer.named.range && made.named.mapping == transfer.named.mapping)
        transfer.extinctions = made.extinctions;
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

/// Whether every T of the fresh scene equals the one of the same name in the old scene.
template <class T, class Same>
bool all_same(const Scene& old, const Scene& fresh, const Same& is_same) {
  bool same = true;
  fresh.entities.each<T>([&](Entity e, const T& source) {
    const Entity before = find_named<T>(old, fresh.entities.get<Name>(e).value);
    same = same && before && is_same(old.entities.get<T>(before), source);
  });
  return same;
}

/// Whether all sources are the same, so that equal descriptions mean the same data.
bool same_sources(const Scene& old, const Scene& fresh) {
  const auto same_field = [](const FieldSource& a, const FieldSource& b) {
    return same_source(a, b) && same_drawing(a, b) && a.labels_table == b.labels_table;
  };
  return all_same<FieldSource>(old, fresh, same_field) && all_same<MeshSource>(old, fresh, same_mesh) &&
         all_same<CurvesSource>(old, fresh, same_curves) && all_same<PointsSource>(old, fresh, same_table<PointsSource>);
}

void carry_cached(const Drawable& kind, Scene& old, Scene& fresh) {
  std::vector<DrawableItem> left = kind.items(old.entities);
  for (const auto& [e, where] : kind.items(fresh.entities)) {
    const auto same = [&, node = where](const DrawableItem& before) { return before.first && json::is_equal_value(*before.second, *node); };
    const auto it = names_a_file(*where) ? left.end() : std::find_if(left.begin(), left.end(), same);
    if (it == left.end()) continue;
    fresh.cache.move_missing_from(e, old.cache, it->first);
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

void carry_widgets(const Scene& old, Scene& fresh) {
  fresh.entities.each<Widget>([&](Entity e, Widget& widget) {
    old.entities.each<Widget>([&](Entity f, const Widget& before) {
      if (before.spec.kind != widget.spec.kind || old.entities.get<Name>(f).value != fresh.entities.get<Name>(e).value) return;
      if (same_place(before.where, widget.where)) {
        widget.spec.pose = before.spec.pose;
      } else if (!(widget.spec.pose == before.report.pose)) {
        // the scene file now places it elsewhere than the user moved it
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
void carry_steps(const Scene& old, Scene& fresh) {
  fresh.entities.each<FieldSource>([&](Entity, FieldSource& source) {
    old.entities.each<FieldSource>([&](Entity, const FieldSource& before) {
      if (before.pattern != source.pattern || before.has_own_step || source.has_own_step || !before.file || !source.file) return;
      if (source.pattern.empty() && before.file->path != source.file->path) return;
      source.series = before.series;
      source.follows = before.follows;
      source.known_times = before.known_times;
      assign_step(source, fresh.time.step);
    });
  });
  const auto carry = [&](auto& shape, const auto& before) {
    if (before.steps.pattern != shape.steps.pattern || before.steps.pattern.empty()) return;
    shape.steps.series = before.steps.series;
    shape.steps.follows = before.steps.follows;
    assign_step(shape, fresh.time.step);
  };
  fresh.entities.each<MeshSource>(
      [&](Entity, MeshSource& shape) { old.entities.each<MeshSource>([&](Entity, const MeshSource& before) { carry(shape, before); }); });
  fresh.entities.each<CurvesSource>([&](Entity, CurvesSource& shape) {
    old.entities.each<CurvesSource>([&](Entity, const CurvesSource& before) { carry(shape, before); });
  });
  fresh.entities.each<PointsSource>([&](Entity, PointsSource& shape) {
    old.entities.each<PointsSource>([&](Entity, const PointsSource& before) { carry(shape, before); });
  });
}

}  // namespace

void transfer_state(Scene& old, Scene& fresh) {
  carry_steps(old, fresh);
  set_step(fresh, old.time.step);
  carry_fields(old, fresh);
  carry_shapes<MeshSource>(old, fresh, same_mesh);
  carry_shapes<CurvesSource>(old, fresh, same_curves);
  carry_shapes<PointsSource>(old, fresh, same_table<PointsSource>);
  carry_transfers(old, fresh);
  // before the line sets, which refer to these curves
  for (auto& [key, curve] : old.traced_curves)
    if (curve.use_count() > 1) fresh.traced_curves.emplace(key, curve);
  if (same_sources(old, fresh))
    for (const Drawable& kind : drawables()) carry_cached(kind, old, fresh);
  transfer_lines(old, fresh);
  carry_widgets(old, fresh);
  fresh.animation_phase = old.animation_phase;
  Cursor& cursor = fresh.entities.get<Cursor>(fresh.cursor);
  const Cursor said = cursor;
  cursor = std::move(old.entities.get<Cursor>(old.cursor));
  cursor.size = said.size;
  cursor.show_occluded = said.show_occluded;
  cursor.drop_line = said.drop_line;
  cursor.crosshair = said.crosshair;
}

}  // namespace catena::scene
