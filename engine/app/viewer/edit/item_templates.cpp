// SPDX-License-Identifier: MIT
#include "engine/app/viewer/edit/item_templates.h"

#include <algorithm>
#include <cmath>

#include "engine/app/viewer/edit/chain_editing.h"
#include "engine/app/viewer/edit/histogram_cache.h"
#include "engine/app/viewer/edit/scene_items.h"
#include "engine/base/json.h"
#include "engine/base/json_edit.h"
#include "engine/base/text.h"
#include "engine/field/field_display_range.h"
#include "engine/io/volume/units.h"
#include "engine/scene/color_maps.h"
#include "engine/scene/default_visualization.h"
#include "engine/scene/labels.h"
#include "engine/scene/to_json.h"
#include "engine/scene/widgets.h"

namespace catena::app {

namespace {

constexpr double kBall = 0.35;  // radius as a fraction of the shortest edge of the domain
constexpr int kSeeds = 60;

struct Domain {
  Vec3 middle{0.0};
  double shortest = 0;
};

Domain domain_of(const field::Field& field) {
  const field::Box& box = field.index_box();
  Domain domain{field.mapping().world_from_index(0.5 * (box.lo + box.hi)), HUGE_VAL};
  for (int i = 0; i < 3; ++i) {
    Vec3 edge(0.0);
    edge[i] = box.hi[i] - box.lo[i];
    const double length = norm(field.mapping().world_from_index_linear * edge);
    if (length > 0) domain.shortest = std::min(domain.shortest, length);
  }
  if (!std::isfinite(domain.shortest)) domain.shortest = field.domain_length();
  return domain;
}

double default_level(const field::ScalarField& field, const std::vector<float>& sorted) {
  const DisplayRange range = field::display_range(field);
  double lo = range.lo, hi = range.hi;
  if (!sorted.empty()) lo = std::max(lo, quantile_of_sorted(sorted, 0.02)), hi = std::min(hi, quantile_of_sorted(sorted, 0.98));
  if (!(lo < hi)) lo = range.lo, hi = range.hi;
  if (!std::isfinite(lo) || !std::isfinite(hi)) return std::isfinite(lo) ? lo + 1 : std::isfinite(hi) ? hi - 1 : 0;
  const double middle = 0.5 * lo + 0.5 * hi, level = round_within(middle, lo, hi, 200);
  return level >= field.min_value() && level <= field.max_value() ? level : middle;
}

/// Returns the range of the values in the plane z = `height` from their 2 to their 98 percentile, if it is less than half of the field's
/// display range, over which the colors of the plane would hardly differ.
std::optional<std::array<double, 2>> narrow_range_in_plane(const field::ScalarField& field, double height) {
  constexpr int kSteps = 64;
  constexpr double kNarrow = 0.5, kTail = 0.02;
  const Bounds box = field.world_bounds();
  std::vector<float> values;
  field::Cursor cursor;
  for (int i = 0; i <= kSteps; ++i)
    for (int j = 0; j <= kSteps; ++j) {
      const Vec3 size = box.hi - box.lo;
      const field::ScalarSample sample = field.sample({box.lo.x + i * size.x / kSteps, box.lo.y + j * size.y / kSteps, height}, cursor);
      if (sample.inside && std::isfinite(sample.value)) values.push_back(static_cast<float>(sample.value));
    }
  if (values.empty()) return std::nullopt;
  std::ranges::sort(values);
  const DisplayRange all = field::display_range(field);
  const double from = quantile_of_sorted(values, kTail), to = quantile_of_sorted(values, 1 - kTail);
  const double lo = round_within(from, all.lo, all.hi), hi = round_within(to, all.lo, all.hi);
  if (!scene::is_color_range(lo, hi) || to - from > kNarrow * (all.hi - all.lo)) return std::nullopt;
  return std::array{lo, hi};
}

/// Takes the level at which a link of the chain lies on the field, so that the visible surface matches the haptic one. False: no such link.
bool take_felt_level(const scene::Scene& scene, scene::Entity field, scene::Isosurface& surface) {
  const auto level = json::parse(first_link_level(scene, entity_name(scene, field)), "level");
  if (!level) return false;
  if (const json::Node* widget = level->find("widget")) surface.level_widget = scene::find_widget(scene, widget->string);
  surface.level = level->number;
  return level->kind == json::Kind::number || surface.level_widget;
}

}  // namespace

const char* to_string(ShowAs as) {
  constexpr const char* words[] = {"volume", "isosurface", "slice", "streamlines", "glyphs"};
  return words[static_cast<int>(as)];
}

bool can_show(const field::AnyField& field, ShowAs as) {
  if (as == ShowAs::slice) return field.get() != nullptr;
  return as == ShowAs::streamlines || as == ShowAs::glyphs ? field.vector != nullptr : field.scalar != nullptr;
}

namespace {

/// Returns the colors in which the scene already shows the field; gray for an image of a patient; else `chosen`.
scene::NamedColors shown_colors(const scene::Scene& scene, scene::Entity field, const scene::NamedColors& chosen) {
  if (chosen.map.empty()) return chosen;  // labels
  std::optional<scene::NamedColors> shown;
  scene.entities.each<scene::Slice>([&](scene::Entity, const scene::Slice& slice) {
    if (!shown && slice.color_by.field == field && slice.color_by.colors.empty()) shown = slice.color_by.named;
  });
  scene.entities.each<scene::Volume>([&](scene::Entity, const scene::Volume& volume) {
    if (!shown && volume.field == field && !volume.transfer.named.map.empty()) shown = volume.transfer.named;
  });
  if (shown) return *shown;
  scene::NamedColors colors = chosen;
  const auto& file = scene.entities.get<scene::FieldSource>(field).file;
  if (file && field::read_units(file->path, file->grid).is_patient_space) colors.map = "grey";
  return colors;
}

/// Returns the streamlines that a file with this field alone would show; empty: none, or the field is a formula.
std::string default_streamlines(const std::string& name, const field::VectorField& field) {
  if (field.grid() == nullptr) return {};
  const auto shown = scene::choose_default_visualization(scene::to_json(name), *field.grid(), scene::NamedColors{});
  const auto members = json::parse("{" + shown.scene_members + "}", name);
  const json::Node* lines = members ? members->find("streamlines") : nullptr;
  return lines != nullptr && !lines->items.empty() ? json::serialize_node(lines->items.front()) : std::string();
}

std::string make_item_json(const scene::Scene& scene, scene::Entity field, const field::AnyField& values, ShowAs as,
                           const std::vector<float>& sorted) {
  const Domain domain = domain_of(*values.get());
  const auto rounded = [&](double value) { return round_within(value, 0, domain.shortest); };
  const Vec3 middle{rounded(domain.middle.x), rounded(domain.middle.y), rounded(domain.middle.z)};
  scene::ColorBy colors;
  if (scene::find_label_map(scene, field) == nullptr) colors.named.map = scene::kDefaultLineColorMap;
  switch (as) {
    case ShowAs::volume: {
      scene::Volume volume;
      volume.field = field;
      volume.shaded = true;
      return scene::to_json(scene, volume);
    }
    case ShowAs::isosurface: {
      scene::Isosurface surface;
      surface.field = field;
      if (!take_felt_level(scene, field, surface)) surface.level = default_level(*values.scalar, sorted);
      return scene::to_json(scene, surface);
    }
    case ShowAs::slice: {
      scene::Slice slice;
      slice.color_by = colors;
      slice.color_by.named = shown_colors(scene, field, colors.named);
      slice.color_by.field = field;
      slice.point = {0, 0, middle.z};
      if (values.scalar && !slice.color_by.named.map.empty() && !slice.color_by.named.range)
        slice.color_by.named.range = narrow_range_in_plane(*values.scalar, middle.z);
      return scene::to_json(scene, slice);
    }
    case ShowAs::glyphs: {
      scene::GlyphSet set;
      set.field = field;
      scene.entities.each<scene::Slice>([&](scene::Entity e, const scene::Slice&) {
        if (set.support_entity) return;
        set.support = scene::GlyphSet::Support::slice;
        set.support_entity = e;
      });
      set.color_by = colors;
      set.color_by->source = scene::ColorBy::Source::speed;
      return scene::to_json(scene, set);
    }
    case ShowAs::streamlines:
      if (std::string lines = default_streamlines(entity_name(scene, field), *values.vector); !lines.empty()) return lines;
      break;
  }
  scene::StreamlineSet set;
  set.field = field;
  set.seeds.pattern.emplace();
  set.seeds.pattern->kind = scene::SeedPattern::Kind::sphere;
  set.seeds.pattern->origin = middle;
  set.seeds.pattern->radius = rounded(kBall * domain.shortest);
  set.seeds.pattern->count = kSeeds;
  set.seeds.pattern->inside = true;
  set.color_by = colors;
  set.color_by->source = scene::ColorBy::Source::speed;
  return scene::to_json(scene, set);
}

/// Name of a field around all labels of the map; empty: there is none.
std::string find_label_surface(const scene::Scene& scene, const std::string& map) {
  std::string name;
  scene.entities.each<scene::FieldSource>([&](scene::Entity e, const scene::FieldSource& source) {
    if (source.label && source.label->label_map == map && source.label->all_labels) name = entity_name(scene, e);
  });
  return name;
}

}  // namespace

std::vector<scene::Document::Edit> make_item_edits(const scene::Scene& scene, scene::Entity field, const field::AnyField& values, ShowAs as,
                                                   const std::vector<float>& sorted) {
  constexpr const char* kPointers[] = {"/volumes/-", "/isosurfaces/-", "/slices/-", "/streamlines/-", "/glyphs/-"};
  const std::string pointer = kPointers[static_cast<int>(as)];
  if (as != ShowAs::isosurface || scene::find_label_map(scene, field) == nullptr)
    return {{pointer, make_item_json(scene, field, values, as, sorted)}};
  const std::string map = entity_name(scene, field);
  std::vector<scene::Document::Edit> edits;
  std::string surface = find_label_surface(scene, map);
  if (surface.empty()) {
    surface = make_unique_name(map + "_labels", [&](const std::string& n) { return bool(scene::find_field(scene, n)); });
    edits.push_back({"/fields/" + surface, "{\"label\": \"*\", \"of\": " + scene::to_json(map) + "}"});
  }
  edits.push_back({pointer, "{\"field\": " + scene::to_json(surface) + ", \"level\": " + scene::to_json(field::kLabelLevel) +
                                ", \"color_by\": {\"field\": " + scene::to_json(map) + "}}"});
  return edits;
}

namespace {

/// Field of a visible isosurface, or else the first scalar field.
scene::Entity field_of_isolevel(const scene::Scene& scene) {
  scene::Entity field;
  scene.entities.each<scene::Isosurface>([&](scene::Entity, const scene::Isosurface& surface) {
    if (!field) field = surface.field;
  });
  const auto fields = list_field_names(scene, false);
  return field || fields.empty() ? field : scene::find_field(scene, fields.front());
}

}  // namespace

std::vector<std::string> list_widget_types() {
  std::vector<std::string> words;
  for (const schema::Section& component : scene::scene_components())
    if (component.name == "widgets")
      for (const schema::Variant& type : component.variants) words.push_back(type.name);
  return words;
}

namespace {

using widget::Kind;

Kind kind_of(const std::string& type) {
  const std::vector<std::string> types = list_widget_types();
  return static_cast<Kind>(std::find(types.begin(), types.end(), type) - types.begin());
}

std::string new_widget_name(const scene::Scene& scene, const std::string& type) {
  return make_unique_name(kind_of(type) == Kind::cutting_plane ? "cut" : type,
                          [&](const std::string& n) { return bool(scene::find_widget(scene, n)); });
}

/// Rotation of z to the world axis nearest to the direction.
Quat facing(const Vec3& direction) {
  Vec3 axis(0.0);
  int k = 0;
  for (int i = 1; i < 3; ++i)
    if (std::abs(direction[i]) > std::abs(direction[k])) k = i;
  axis[k] = direction[k] < 0 ? -1 : 1;
  return shortest_arc({0.0, 0.0, 1.0}, axis);
}

}  // namespace

std::string make_clip_json(const scene::Scene& scene, const std::string& name, Kind kind) {
  const std::size_t planes = kind == Kind::cutting_plane ? 1 : kind == Kind::box ? 6 : 0;
  if (planes == 0 || scene.clip_planes.size() + planes > kMaxClipPlanes) return {};
  return "{\"widget\": " + scene::to_json(name) + (planes == 1 ? ", \"side\": \"behind\"}" : "}");
}

Result<std::vector<scene::Document::Edit>> make_add_widget_edits(const scene::Scene& scene, const std::string& type, const Bounds& bounds,
                                                                 const Vec3& to_camera) {
  CATENA_TRY(const std::string widget, make_widget_json(scene, type, bounds, to_camera));
  std::vector<scene::Document::Edit> edits{{"/widgets/-", widget}};
  const std::string clip = make_clip_json(scene, new_widget_name(scene, type), kind_of(type));
  if (!clip.empty()) edits.push_back({"/clip/-", clip});
  return edits;
}

Result<std::string> make_widget_json(const scene::Scene& scene, const std::string& type, const Bounds& bounds, const Vec3& to_camera) {
  const Kind kind = kind_of(type);
  const std::string name = new_widget_name(scene, type);

  const Vec3 middle = bounds.empty() ? Vec3(0.0) : bounds.center(), size = bounds.empty() ? Vec3(1.0) : bounds.hi - bounds.lo;
  int longest = 0;
  for (const int axis : {1, 2})
    if (size[axis] > size[longest]) longest = axis;
  Vec3 half(0.0);
  half[longest] = 0.25 * size[longest];
  if (kind == Kind::box) half = 0.25 * size;
  const bool two_ends = kind == Kind::rake || kind == Kind::ruler || kind == Kind::box;
  scene::Widget widget;
  widget.spec.kind = kind;
  widget.spec.pose.points = {two_ends ? middle - half : middle, middle + half};
  for (Vec3& point : widget.spec.pose.points)
    for (int i = 0; i < 3; ++i) point[i] = round_within(point[i], 0, max_abs(size) > 0 ? max_abs(size) : 1, 20000);
  if (kind == Kind::cutting_plane) widget.spec.pose.orientation = facing(to_camera);
  if (kind == Kind::isolevel && !(widget.field = field_of_isolevel(scene)))
    return Error{"an isolevel needs a scalar field, which the scene does not have"};
  return scene::to_json(scene, name, widget);
}

}  // namespace catena::app
