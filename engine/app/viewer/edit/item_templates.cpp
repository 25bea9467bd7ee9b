// SPDX-License-Identifier: MIT
#include "engine/app/viewer/edit/item_templates.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <set>

#include "engine/app/viewer/edit/chain_editing.h"
#include "engine/app/viewer/edit/histogram_cache.h"
#include "engine/app/viewer/edit/scene_items.h"
#include "engine/base/json.h"
#include "engine/base/json_edit.h"
#include "engine/base/text.h"
#include "engine/field/field_display_range.h"
#include "engine/scene/color_maps.h"
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

/// Takes the level at which a link of the chain lies on the field, so that the visible surface matches the haptic one. False: no such link.
bool take_felt_level(const scene::Scene& scene, scene::Entity field, scene::Isosurface& surface) {
  const auto level = json::parse(first_link_level(scene, entity_name(scene, field)), "level");
  if (!level) return false;
  if (const json::Node* widget = level->find("widget")) surface.level_widget = scene::find_widget(scene, widget->string);
  surface.level = level->number;
  return level->kind == json::Kind::number || surface.level_widget;
}

}  // namespace

std::string new_item_pointer(ShowAs as) {
  constexpr const char* pointers[] = {"/volumes/-", "/isosurfaces/-", "/slices/-", "/streamlines/-", "/glyphs/-"};
  return pointers[static_cast<int>(as)];
}

const char* to_string(ShowAs as) {
  constexpr const char* words[] = {"volume", "isosurface", "slice", "streamlines", "glyphs"};
  return words[static_cast<int>(as)];
}

bool can_show(const field::AnyField& field, ShowAs as) {
  if (as == ShowAs::slice) return field.get() != nullptr;
  return as == ShowAs::streamlines || as == ShowAs::glyphs ? field.vector != nullptr : field.scalar != nullptr;
}

std::string make_item_json(const scene::Scene& scene, scene::Entity field, const field::AnyField& values, ShowAs as,
                           const std::vector<float>& sorted) {
  const Domain domain = domain_of(*values.get());
  const auto rounded = [&](double value) { return round_within(value, 0, domain.shortest); };
  const Vec3 middle{rounded(domain.middle.x), rounded(domain.middle.y), rounded(domain.middle.z)};
  scene::ColorBy colors;
  colors.named.map = scene::kDefaultLineColorMap;
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
      slice.color_by.field = field;
      slice.point = {0, 0, middle.z};
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

Result<std::string> make_widget_json(const scene::Scene& scene, const std::string& type, const Bounds& bounds) {
  using widget::Kind;
  const std::vector<std::string> types = list_widget_types();
  const auto kind = static_cast<Kind>(std::find(types.begin(), types.end(), type) - types.begin());
  const std::string name = make_unique_name(kind == Kind::cutting_plane ? "cut" : type,
                                            [&](const std::string& n) { return bool(scene::find_widget(scene, n)); });

  const Vec3 middle = bounds.empty() ? Vec3(0.0) : bounds.center(), size = bounds.empty() ? Vec3(1.0) : bounds.hi - bounds.lo;
  const Vec3 half = kind == Kind::box ? size * 0.25 : Vec3(0.25 * max_abs(size), 0, 0);
  const bool two_ends = kind == Kind::rake || kind == Kind::ruler || kind == Kind::box;
  scene::Widget widget;
  widget.spec.kind = kind;
  widget.spec.pose.points = {two_ends ? middle - half : middle, middle + half};
  if (kind == Kind::isolevel && !(widget.field = field_of_isolevel(scene)))
    return Error{"an isolevel needs a scalar field, which the scene does not have"};
  return scene::to_json(scene, name, widget);
}

namespace fs = std::filesystem;

namespace {

json::Node* member_of(json::Node& object, std::string_view key) {
  const auto found = std::ranges::find_if(object.members, [&](const auto& member) { return member.first == key; });
  return found == object.members.end() ? nullptr : &found->second;
}

std::string free_among(std::set<std::string>& taken, const std::string& name) {
  std::string free = make_unique_name(name, [&](const std::string& n) { return taken.contains(n); });
  taken.insert(free);
  return free;
}

/// Rewrites a file name that is relative to folder `from` so that it is relative to folder `to`.
std::string named_from(const fs::path& from, const fs::path& to, const std::string& file) {
  // a scene path without a folder lies in the current one
  std::error_code code;
  const fs::path here = fs::current_path(code);
  const fs::path whole = (here / from / file).lexically_normal(), near = whole.lexically_relative((here / to).lexically_normal());
  return near.empty() || *near.begin() == ".." ? whole.string() : near.string();
}

}  // namespace

Result<MergedFile> make_merge_edits(const std::string& open_text, const std::string& open_path, const std::string& added_text,
                                    const std::string& added_path) {
  CATENA_TRY(const json::Node open, json::parse(open_text, open_path));
  CATENA_TRY(json::Node added, json::parse(added_text, added_path));
  MergedFile result;
  std::set<std::string> fields, things;
  if (const json::Node* there = open.find("fields"))
    for (const auto& [name, node] : there->members) fields.insert(name);
  for (const char* part : {"meshes", "curves", "points"})
    if (const json::Node* there = open.find(part))
      for (const json::Node& item : there->items)
        if (const json::Node* name = item.find("name")) things.insert(name->string);
  const fs::path from = fs::path(added_path).parent_path(), to = fs::path(open_path).parent_path();

  if (json::Node* own = member_of(added, "fields"))
    for (auto& [name, node] : own->members) {
      const std::string as = free_among(fields, name);
      if (json::Node* file = member_of(node, "file")) file->string = named_from(from, to, file->string);
      result.edits.push_back({"/fields/" + json::escape_pointer_token(as), json::serialize_node(node)});
      result.renames.emplace_back(name, as);
    }
  const auto renamed = [&](const std::string& name) {
    const auto found = std::ranges::find(result.renames, name, &std::pair<std::string, std::string>::first);
    return found == result.renames.end() ? name : found->second;
  };
  for (const char* part : {"meshes", "curves", "points", "volumes", "streamlines"}) {
    json::Node* items = member_of(added, part);
    if (items == nullptr) continue;
    for (json::Node& item : items->items) {
      if (json::Node* field = member_of(item, "field")) field->string = renamed(field->string);
      if (json::Node* file = member_of(item, "file")) file->string = named_from(from, to, file->string);
      if (json::Node* name = member_of(item, "name")) name->string = free_among(things, name->string);
      result.edits.push_back({std::string("/") + part + "/-", json::serialize_node(item)});
    }
  }
  return result;
}

}  // namespace catena::app
