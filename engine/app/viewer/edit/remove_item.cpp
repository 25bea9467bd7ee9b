// SPDX-License-Identifier: MIT
#include "engine/app/viewer/edit/remove_item.h"

#include <algorithm>
#include <functional>

#include "engine/app/viewer/edit/haptic_binding.h"
#include "engine/app/viewer/edit/histogram_cache.h"
#include "engine/base/json_edit.h"
#include "engine/scene/references.h"
#include "engine/scene/ruler.h"
#include "engine/scene/streamlines.h"
#include "engine/scene/to_json.h"
#include "engine/scene/visibility.h"
#include "engine/scene/widgets.h"

namespace catena::app {

namespace {

struct Place {
  std::string list;
  std::size_t index = 0;
  std::string pointer() const { return "/" + list + "/" + std::to_string(index); }
  bool operator==(const Place&) const = default;
};

constexpr const char* kPlaneKeys[] = {"point", "normal", "axis", "at", "widget"};

/// The plane of a slice, as JSON text for glyphs.
std::string plane_of(const json::Node& slice) {
  std::string text;
  for (const char* key : kPlaneKeys)
    if (const json::Node* value = slice.find(key))
      text += (text.empty() ? "" : ", ") + json::serialize_string(key) + ": " + json::serialize_node(*value);
  return "{\"plane\": {" + text + "}}";
}

/// Adds to `gone` all items that depend on those in it; glyphs that lose their slice but stay get its plane through `edits`.
void add_hangers(const json::Node& root, std::vector<Place>& gone, TextEdits& edits) {
  for (std::size_t g = 0; g < gone.size(); ++g) {
    const Place lost = gone[g];
    for (const scene::IndexReference& index : scene::kIndexReferences) {
      const json::Node* holders = index.list == lost.list ? root.find(index.holder) : nullptr;
      for (std::size_t k = 0; holders != nullptr && k < holders->items.size(); ++k) {
        const Place holder{index.holder, k};
        const json::Node* named = json::find_value(holders->items[k], "/" + std::string(index.key));
        if (named == nullptr || named->number != static_cast<double>(lost.index)) continue;
        if (std::string_view(index.key) == "on/slice")
          edits.push_back({holder.pointer() + "/on", plane_of(*json::find_value(root, lost.pointer()))});
        else if (std::ranges::find(gone, holder) == gone.end())
          gone.push_back(holder);
      }
    }
  }
}

/// Renumbers references by index: each is reduced by the number of removed items before it.
void add_renumbered(const json::Node& root, const std::vector<Place>& gone, TextEdits& edits) {
  for (const scene::IndexReference& index : scene::kIndexReferences) {
    const json::Node* holders = root.find(index.holder);
    for (std::size_t k = 0; holders != nullptr && k < holders->items.size(); ++k) {
      const json::Node* named = json::find_value(holders->items[k], "/" + std::string(index.key));
      if (named == nullptr || std::ranges::find(gone, Place{index.holder, k}) != gone.end()) continue;
      const auto before = std::ranges::count_if(
          gone, [&](const Place& place) { return place.list == index.list && static_cast<double>(place.index) < named->number; });
      const bool goes = std::ranges::any_of(
          gone, [&](const Place& place) { return place.list == index.list && static_cast<double>(place.index) == named->number; });
      if (before > 0 && !goes)
        edits.push_back({"/" + std::string(index.holder) + "/" + std::to_string(k) + "/" + index.key,
                         json::serialize_number(named->number - static_cast<double>(before))});
    }
  }
}

TextEdits edits_without(const std::string& text, std::vector<Place> gone) {
  TextEdits edits;
  const auto root = json::parse(text, {});
  if (!root) return edits;
  add_hangers(*root, gone, edits);
  add_renumbered(*root, gone, edits);
  // removed from the end, so that the remaining indices stay valid
  std::ranges::sort(gone, [](const Place& a, const Place& b) { return a.list != b.list ? a.list < b.list : a.index > b.index; });
  for (const Place& place : gone) edits.push_back({place.pointer(), std::nullopt});
  return edits;
}

/// List and index of an item such as "slices[1]".
std::vector<Place> place_of(const std::string& item) {
  const std::size_t open = item.find('[');
  if (open == std::string::npos) return {};
  return {{item.substr(0, open), std::stoul(item.substr(open + 1))}};
}

using Rule = std::function<bool(const json::Node& link)>;

const scene::LabelSource* label_of(const scene::Scene& scene, const std::string& field) {
  const scene::Entity entity = field.empty() ? scene::Entity{} : scene::find_field(scene, field);
  const auto* source = entity ? &scene.entities.get<scene::FieldSource>(entity) : nullptr;
  return source != nullptr && source->label ? &*source->label : nullptr;
}

bool is_at(const scene::Scene& scene, const scene::Isosurface& surface, const json::Node& link) {
  const json::Node& level = *link.find("level");
  if (level.kind == json::Kind::number) return !surface.level_widget && level.number == surface.level;
  const json::Node* widget = level.find("widget");
  return surface.level_widget && widget != nullptr && widget->string == entity_name(scene, surface.level_widget);
}

/// Returns whether a visible surface other than `item` is the surface of the link.
bool is_drawn_beside(const scene::Scene& scene, const std::string& item, const json::Node& link) {
  const std::string field = scene::level_field_name(link);
  bool found = false;
  scene.entities.each<scene::Isosurface>([&](scene::Entity, const scene::Isosurface& surface) {
    found = found || (surface.where.label != item && entity_name(scene, surface.field) == field && is_at(scene, surface, link));
  });
  return found;
}

Rule rule_of(const scene::Scene& scene, const std::string& item, const scene::Isosurface& surface) {
  const std::string field = entity_name(scene, surface.field);
  const scene::LabelSource* labels = label_of(scene, field);
  return [&scene, item, surface, field, labels](const json::Node& link) {
    const std::string field_name = scene::level_field_name(link);
    if (field_name.empty() || is_drawn_beside(scene, item, link)) return false;
    if (field_name == field) return is_at(scene, surface, link);
    const scene::LabelSource* label = label_of(scene, field_name);
    if (labels == nullptr || label == nullptr || label->label_map != labels->label_map || label->values.size() != 1) return false;
    return labels->all_labels || std::ranges::find(labels->values, label->values.front()) != labels->values.end();
  };
}

Rule rule_of(const scene::Scene& scene, const std::string& item, const scene::Volume& volume) {
  const std::string field = entity_name(scene, volume.field);
  return [&scene, item, field](const json::Node& link) {
    const std::string field_name = scene::level_field_name(link);
    const scene::LabelSource* label = label_of(scene, field_name);
    return (field_name == field || (label != nullptr && label->label_map == field)) && !is_drawn_beside(scene, item, link);
  };
}

Rule rule_of(scene::Scene& scene, scene::Entity entity, const scene::StreamlineSet& set) {
  const std::string field = entity_name(scene, set.field), widget = set.seeds.widget ? entity_name(scene, set.seeds.widget) : std::string();
  std::vector<Vec3> starts;
  if (const auto lines = scene::resolve_lines(scene, entity))
    for (const flow::CurvePtr& line : *lines) starts.push_back(line->position(0));
  return [field, widget, starts](const json::Node& link) {
    const json::Node *of = link.find("field"), *seed = link.find("seed");
    if (of == nullptr || of->string != field || seed == nullptr) return false;
    if (const json::Node* follows = seed->find("widget")) return !widget.empty() && follows->string == widget;
    const auto place = json::as_vec3(*seed, "seed");
    return place && std::ranges::find(starts, *place) != starts.end();
  };
}

Rule rule_of_named(const char* key, const std::string& name) {
  return [key, name](const json::Node& link) {
    const json::Node* named = link.find(key);
    return named != nullptr && named->string == name;
  };
}

/// Number of items of the kind that show the same data.
template <class T, class Same>
bool is_shown_twice(const scene::Scene& scene, const Same& same) {
  int count = 0;
  scene.entities.each<T>([&](scene::Entity, const T& other) { count += same(other); });
  return count > 1;
}

/// The rule that finds the links on the item; an empty rule if every such link also lies on something else.
Rule rule_of(scene::Scene& scene, const std::string& item) {
  if (const auto surface = find_item<scene::Isosurface>(scene, item)) return rule_of(scene, item, *surface);
  if (const auto volume = find_item<scene::Volume>(scene, item)) {
    if (is_shown_twice<scene::Volume>(scene, [&](const scene::Volume& other) { return other.field == volume->field; })) return {};
    return rule_of(scene, item, *volume);
  }
  scene::Entity entity;
  if (const auto set = find_item<scene::StreamlineSet>(scene, item, &entity)) return rule_of(scene, entity, *set);
  if (const auto slice = find_item<scene::Slice>(scene, item)) {
    const auto same = [&](const scene::Slice& other) { return other.point == slice->point && other.normal == slice->normal; };
    if (is_shown_twice<scene::Slice>(scene, same)) return {};
    const std::vector<std::string> planes = find_coplanar_links(scene, slice->point, slice->normal);
    return [planes](const json::Node& link) { return std::ranges::find(planes, item_pointer(link)) != planes.end(); };
  }
  if (const auto mesh = find_item<scene::SurfaceMesh>(scene, item)) return rule_of_named("mesh", entity_name(scene, mesh->mesh));
  if (find_item<scene::CurvesSource>(scene, item, &entity)) return rule_of_named("curves", entity_name(scene, entity));
  if (find_item<scene::PointsSource>(scene, item, &entity)) return rule_of_named("points", entity_name(scene, entity));
  return {};
}

/// Calls `visit` with the pointer, the key and the node of every object {"widget": name, ...} below `node`.
void each_follower(const json::Node& node, const std::string& pointer, const std::string& key, const std::string& name,
                   const std::function<void(const std::string&, const std::string&, const json::Node&)>& visit) {
  if (const json::Node* named = node.find("widget"); named != nullptr && named->string == name) visit(pointer, key, node);
  for (const auto& [member, value] : node.members)
    each_follower(value, pointer + "/" + json::escape_pointer_token(member), member, name, visit);
  for (std::size_t i = 0; i < node.items.size(); ++i) each_follower(node.items[i], pointer + "/" + std::to_string(i), key, name, visit);
}

}  // namespace

TextEdits make_remove_widget_edits(const scene::Scene& scene, const std::string& text, const std::string& name) {
  const auto root = json::parse(text, {});
  const scene::Entity entity = scene::find_widget(scene, name);
  if (!root || !entity) return {};
  const scene::Widget& widget = scene.entities.get<scene::Widget>(entity);
  const widget::Pose& pose = widget.report.pose;
  TextEdits edits;
  std::vector<Place> gone = place_of(widget.where.label);
  each_follower(*root, {}, {}, name, [&](const std::string& pointer, const std::string& key, const json::Node& node) {
    if (key == "clip") {
      gone.push_back({"clip", std::stoul(pointer.substr(pointer.rfind('/') + 1))});
    } else if (key == "level") {
      edits.push_back({pointer, scene::to_json(widget.report.value)});
    } else if (key == "seed") {
      edits.push_back({pointer, scene::to_json(pose.points[0])});
    } else if (key == "seeds") {
      const json::Node* count = node.find("count");
      const int seeds = count != nullptr ? static_cast<int>(count->number) : 1;
      edits.push_back({pointer, scene::to_json(scene::make_widget_seeds(widget.spec.kind, pose, seeds))});
    } else {
      edits.push_back({pointer + "/widget", std::nullopt});
      edits.push_back({pointer + "/point", scene::to_json(pose.points[0])});
      Vec3 normal = scene::plane_normal(pose);
      for (int i = 0; i < 3; ++i) normal[i] = round_within(normal[i], 0, 1, 1e12);  // no rounding errors of the rotation
      edits.push_back({pointer + "/normal", scene::to_json(normal)});
    }
  });
  for (scene::Document::Edit& edit : edits_without(text, gone)) edits.push_back(std::move(edit));
  return edits;
}

TextEdits make_remove_edits(const std::string& text, const std::string& item) { return edits_without(text, place_of(item)); }

std::vector<std::string> find_links_on(scene::Scene& scene, const std::string& item) {
  std::vector<std::string> pointers;
  const haptics::ConstraintType* type = find_constraint_type(item.substr(0, item.find('[')));
  const Rule lies_on = type != nullptr ? rule_of(scene, item) : Rule();
  if (!lies_on) return pointers;
  scene.entities.each<scene::Link>([&](scene::Entity, const scene::Link& link) {
    if (link.type != type->type || !lies_on(link.node)) return;
    if (const std::string pointer = item_pointer(link.node); !pointer.empty()) pointers.push_back(pointer);
  });
  return pointers;
}

TextEdits make_remove_edits_with_links(scene::Scene& scene, const std::string& text, const std::string& item) {
  std::vector<Place> gone = place_of(item);
  for (const std::string& link : find_links_on(scene, item)) gone.push_back({"chain", std::stoul(link.substr(link.rfind('/') + 1))});
  return edits_without(text, gone);
}

}  // namespace catena::app
