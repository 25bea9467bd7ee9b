#include <algorithm>

#include "engine/base/output_file.h"
#include "engine/scene/document.h"
#include "engine/scene/labels.h"
#include "engine/scene/lines.h"
#include "engine/scene/steps.h"
#include "engine/scene/transfer.h"

namespace catena::scene {
namespace {

// ---- sources ----

bool same_request(const field::LoadRequest& a, const field::LoadRequest& b) {
  field::LoadRequest renamed = a;
  renamed.path = b.path;
  return renamed == b && (a.path == b.path || same_file(a.path, b.path));
}

bool same_source(const FieldSource& a, const FieldSource& b) {
  if (a.file.has_value() != b.file.has_value() || a.label != b.label) return false;
  if (a.file) return a.grid_is_a_wish == b.grid_is_a_wish && same_request(*a.file, *b.file);
  return a.analytic == b.analytic && a.parameters == b.parameters;
}

/// A surface of labels is what it was while its label map is.
bool same_map(const Scene& old, const FieldSource& before, const Scene& fresh, const FieldSource& source) {
  if (!source.label) return true;
  const Entity was = find_field(old, source.label->of), is = find_field(fresh, source.label->of);
  if (!was || !is) return false;
  const FieldSource &map_was = old.world.get<FieldSource>(was), &map_is = fresh.world.get<FieldSource>(is);
  return before.label == source.label && same_source(map_was, map_is) && map_was.labels_table == map_is.labels_table;
}

bool same_drawing(const FieldSource& a, const FieldSource& b) { return a.file || (a.resolution == b.resolution && a.box == b.box); }

/// Of one step of one file.
template <class T>
bool same_table(const T& a, const T& b) {
  const bool same_step = a.steps.step == b.steps.step || std::max(a.steps.times.size(), b.steps.times.size()) < 2;
  return same_step && (a.path == b.path || same_file(a.path, b.path));
}

bool same_curves(const DrawnCurves& a, const DrawnCurves& b) {
  if (!a.traced || !b.traced) return !a.traced && !b.traced && same_table(a, b);
  return a.traced->field == b.traced->field && a.traced->options == b.traced->options;
}

bool same_mesh(const MeshSource& a, const MeshSource& b) { return a.placement == b.placement && same_table(a, b); }

void carry_fields(Scene& old, Scene& fresh) {
  fresh.world.each<FieldSource>([&](Entity e, FieldSource& source) {
    old.world.each<FieldSource>([&](Entity f, const FieldSource& before) {
      if (before.loaded.get() == nullptr || !same_source(before, source) || !same_map(old, before, fresh, source)) return;
      if (source.loaded.get() == nullptr) source.loaded = before.loaded;
      source.stepped = source.stepped || before.stepped;
      if (source.loaded.get() == before.loaded.get() && source.labels_table == before.labels_table) source.labels = before.labels;
      find_labels(source);
      if (source.drawn.get() == nullptr && source.loaded.get() == before.loaded.get() && same_drawing(before, source))
        source.drawn = before.drawn;
      // of whose values someone asked before
      if (source.drawn.get() != nullptr && source.drawn.get() == before.drawn.get() && old.made.has<ValueSample>(f) &&
          !fresh.made.has<ValueSample>(e))
        fresh.made.emplace<ValueSample>(e, old.made.get<ValueSample>(f));
    });
  });
}

/// Meshes, curves or points.
template <class T, class Same>
void carry_shapes(Scene& old, Scene& fresh, const Same& is_same) {
  fresh.world.each<T>([&](Entity, T& source) {
    old.world.each<T>([&](Entity, const T& before) {
      if (source.loaded || !before.loaded || !is_same(before, source)) return;
      source.loaded = before.loaded;
      source.steps.times = before.steps.times;
      if constexpr (requires { source.traced; }) source.traced = before.traced;
    });
  });
}

// ---- automatic colours and opacities: functions of the drawn grid and of what is stated besides ----

bool states(const json::Node& where, const char* key) { return where.find(key) != nullptr; }
bool states_colors(const json::Node& where) {
  const json::Node* color = where.find("color");
  return color != nullptr && color->kind != json::Kind::string;
}

void carry_transfers(const Scene& old, Scene& fresh) {
  fresh.world.each<Volume>([&](Entity, Volume& volume) {
    const void* grid = fresh.world.get<FieldSource>(volume.field).drawn.get();
    TransferFunction& transfer = volume.transfer;
    old.world.each<Volume>([&](Entity, const Volume& before) {
      const TransferFunction& made = before.transfer;
      if (fresh.world.get<FieldSource>(volume.field).labels != old.world.get<FieldSource>(before.field).labels) return;
      if (grid == nullptr || old.world.get<FieldSource>(before.field).drawn.get() != grid || !made.file.empty() || !transfer.file.empty())
        return;
      if (transfer.colors.empty() && !states_colors(before.where) && made.named == transfer.named) transfer.colors = made.colors;
      if (transfer.opacities.empty() && transfer.extinctions.empty() && !states(before.where, "opacity") &&
          !states(before.where, "extinction") && made.named.range == transfer.named.range && made.named.mapping == transfer.named.mapping)
        transfer.extinctions = made.extinctions;
    });
  });
}

// ---- what the rooms keep beside the things ----

bool names_a_file(const json::Node& node) {
  for (const json::Node& item : node.items)
    if (names_a_file(item)) return true;
  for (const auto& [key, member] : node.members)
    if (key == "transfer" || names_a_file(member)) return true;
  return false;
}

/// Every T of the fresh scene is that of the same name before.
template <class T, class Same>
bool all_same(const Scene& old, const Scene& fresh, const Same& is_same) {
  bool same = true;
  fresh.world.each<T>([&](Entity e, const T& source) {
    const Entity before = find_named<T>(old, fresh.world.get<Name>(e).value);
    same = same && before && is_same(old.world.get<T>(before), source);
  });
  return same;
}

/// A description that is the same means the same.
bool same_sources(const Scene& old, const Scene& fresh) {
  const auto same_field = [](const FieldSource& a, const FieldSource& b) {
    return same_source(a, b) && same_drawing(a, b) && a.labels_table == b.labels_table;
  };
  return all_same<FieldSource>(old, fresh, same_field) && all_same<MeshSource>(old, fresh, same_mesh) &&
         all_same<DrawnCurves>(old, fresh, same_curves) && all_same<DrawnPoints>(old, fresh, same_table<DrawnPoints>);
}

template <class T>
void carry_made(Scene& old, Scene& fresh) {
  std::vector<Entity> left;
  old.world.each<T>([&](Entity e, const T&) { left.push_back(e); });
  fresh.world.each<T>([&](Entity e, const T& part) {
    const auto same = [&](Entity before) { return before && json::same_value(old.world.get<T>(before).where, part.where); };
    const auto it = names_a_file(part.where) ? left.end() : std::find_if(left.begin(), left.end(), same);
    if (it == left.end()) return;
    fresh.made.take_missing(e, old.made, *it);
    *it = Entity{};
  });
}

// ---- widgets ----

bool same_place(const json::Node& a, const json::Node& b) {
  for (const char* key : {"type", "center", "normal", "orientation", "position", "from", "to", "lo", "hi", "field"}) {
    const json::Node *x = a.find(key), *y = b.find(key);
    if ((x == nullptr) != (y == nullptr) || (x != nullptr && !json::same_value(*x, *y))) return false;
  }
  return true;
}

void carry_widgets(const Scene& old, Scene& fresh) {
  fresh.world.each<Widget>([&](Entity e, Widget& widget) {
    old.world.each<Widget>([&](Entity f, const Widget& before) {
      if (before.spec.kind != widget.spec.kind || old.world.get<Name>(f).value != fresh.world.get<Name>(e).value) return;
      if (same_place(before.where, widget.where)) {
        widget.spec.pose = before.spec.pose;
      } else if (!(widget.spec.pose == before.state.pose)) {
        // set elsewhere than the hand has it
        widget.spec.revision = before.spec.revision + 1;
        widget.state = {};
        widget.state.pose = widget.spec.pose;
        widget.state.revision = widget.spec.revision;
        return;
      }
      widget.spec.revision = before.spec.revision;
      widget.state = before.state;
    });
  });
}

/// The steps that are known of what is read from the same pattern or file: those that have come since stay, and no others come.
void carry_steps(const Scene& old, Scene& fresh) {
  fresh.world.each<FieldSource>([&](Entity, FieldSource& source) {
    old.world.each<FieldSource>([&](Entity, const FieldSource& before) {
      if (before.pattern != source.pattern || before.own_step || source.own_step || !before.file || !source.file) return;
      if (source.pattern.empty() && before.file->path != source.file->path) return;
      source.series = before.series;
      source.follows = before.follows;
      source.known_times = before.known_times;
      put_step(source, fresh.time.step);
    });
  });
  const auto carry = [&](auto& shape, const auto& before) {
    if (before.steps.pattern != shape.steps.pattern || before.steps.pattern.empty()) return;
    shape.steps.series = before.steps.series;
    shape.steps.follows = before.steps.follows;
    put_step(shape, fresh.time.step);
  };
  fresh.world.each<MeshSource>(
      [&](Entity, MeshSource& shape) { old.world.each<MeshSource>([&](Entity, const MeshSource& before) { carry(shape, before); }); });
  fresh.world.each<DrawnCurves>(
      [&](Entity, DrawnCurves& shape) { old.world.each<DrawnCurves>([&](Entity, const DrawnCurves& before) { carry(shape, before); }); });
  fresh.world.each<DrawnPoints>(
      [&](Entity, DrawnPoints& shape) { old.world.each<DrawnPoints>([&](Entity, const DrawnPoints& before) { carry(shape, before); }); });
}

}  // namespace

void carry_over(Scene& old, Scene& fresh) {
  carry_steps(old, fresh);
  set_step(fresh, old.time.step);
  carry_fields(old, fresh);
  carry_shapes<MeshSource>(old, fresh, same_mesh);
  carry_shapes<DrawnCurves>(old, fresh, same_curves);
  carry_shapes<DrawnPoints>(old, fresh, same_table<DrawnPoints>);
  carry_transfers(old, fresh);
  // before the lines, which hold their curves
  for (auto& [key, curve] : old.curves)
    if (curve.use_count() > 1) fresh.curves.emplace(key, curve);
  if (same_sources(old, fresh)) {
    carry_made<StreamlineSet>(old, fresh);
    carry_made<GlyphSet>(old, fresh);
    carry_made<Slice>(old, fresh);
    carry_made<DrawnCurves>(old, fresh);
    carry_made<DrawnPoints>(old, fresh);
    carry_made<SurfaceMesh>(old, fresh);
    carry_made<Volume>(old, fresh);
    carry_made<Isosurface>(old, fresh);
  }
  carry_lines(old, fresh);
  carry_widgets(old, fresh);
  fresh.phase = old.phase;
  Cursor& cursor = fresh.world.get<Cursor>(fresh.cursor);
  const Cursor said = cursor;
  cursor = std::move(old.world.get<Cursor>(old.cursor));
  cursor.size = said.size;
  cursor.ghost = said.ghost;
  cursor.drop_line = said.drop_line;
  cursor.crosshair = said.crosshair;
}

}  // namespace catena::scene
