// SPDX-License-Identifier: MIT
#include "engine/app/viewer/edit/scene_items.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "engine/app/viewer/edit/chain_editing.h"
#include "engine/base/json_edit.h"
#include "engine/scene/ruler.h"
#include "engine/scene/to_json.h"
#include "engine/scene/visibility.h"
#include "engine/scene/widgets.h"

namespace catena::app {

std::string item_pointer(const json::Node& item) {
  const std::size_t open = item.label.find('[');
  if (item.line <= 0 || open == std::string::npos || open == 0 || !item.label.ends_with(']')) return {};
  const std::string index = item.label.substr(open + 1, item.label.size() - open - 2);
  if (index.empty() || !std::all_of(index.begin(), index.end(), [](char c) { return c >= '0' && c <= '9'; })) return {};
  return "/" + item.label.substr(0, open) + "/" + index;
}

std::string entity_name(const scene::Scene& scene, scene::Entity entity) {
  return scene.entities.has<scene::Name>(entity) ? scene.entities.get<scene::Name>(entity).value : std::string();
}

std::vector<std::string> field_names(const scene::Scene& scene) {
  std::vector<std::string> names;
  scene.entities.each<scene::FieldSource>([&](scene::Entity e, const scene::FieldSource&) { names.push_back(entity_name(scene, e)); });
  return names;
}

std::vector<std::string> find_link_levels(const scene::Scene& scene, const std::string& field, double level) {
  std::vector<std::string> pointers;
  scene.entities.each<scene::Link>([&](scene::Entity, const scene::Link& link) {
    if (scene::level_field_name(link.node) != field) return;
    const json::Node& stated = *link.node.find("level");
    const std::string at = item_pointer(link.node);
    if (stated.kind == json::Kind::number && stated.number == level && !at.empty()) pointers.push_back(at + "/level");
  });
  return pointers;
}

TextEdits make_level_edits(const scene::Scene& scene, const scene::Isosurface& surface, double level) {
  TextEdits edits{{item_pointer(surface.where) + "/level", scene::to_json(level)}};
  for (const std::string& pointer : find_link_levels(scene, entity_name(scene, surface.field), surface.level))
    edits.push_back({pointer, scene::to_json(level)});
  return edits;
}

std::vector<std::string> find_isosurface_levels(const scene::Scene& scene, const std::string& field, double level) {
  std::vector<std::string> pointers;
  scene.entities.each<scene::Isosurface>([&](scene::Entity, const scene::Isosurface& surface) {
    const json::Node* stated = surface.where.find("level");
    if (stated == nullptr || stated->kind != json::Kind::number || stated->number != level || entity_name(scene, surface.field) != field)
      return;
    if (const std::string at = item_pointer(surface.where); !at.empty()) pointers.push_back(at + "/level");
  });
  return pointers;
}

std::string visible_surface_level(const scene::Scene& scene, const std::string& field, double value) {
  std::string text;
  double nearest = std::numeric_limits<double>::infinity();
  scene.entities.each<scene::Isosurface>([&](scene::Entity e, const scene::Isosurface& surface) {
    if (scene::is_hidden(scene.entities, e) || entity_name(scene, surface.field) != field) return;
    const double away = std::abs(surface.level - value);
    if (!text.empty() && !(away < nearest)) return;
    nearest = away;
    text = surface.level_widget ? "{\"widget\": " + scene::to_json(entity_name(scene, surface.level_widget)) + "}"
                                : scene::to_json(surface.level);
  });
  return text;
}

std::string first_link_level(const scene::Scene& scene, const std::string& field) {
  std::string text;
  scene.entities.each<scene::Link>([&](scene::Entity, const scene::Link& link) {
    if (!text.empty() || scene::level_field_name(link.node) != field) return;
    text = json::serialize_node(*link.node.find("level"));
  });
  return text;
}

std::string visible_surface_field(const scene::Scene& scene) {
  std::string field;
  scene.entities.each<scene::Isosurface>([&](scene::Entity e, const scene::Isosurface& surface) {
    if (field.empty() && !scene::is_hidden(scene.entities, e)) field = entity_name(scene, surface.field);
  });
  return field;
}

namespace {

bool is_held(WidgetMode mode) {
  using Mode = WidgetMode;
  return mode == Mode::translate || mode == Mode::turn || mode == Mode::drag;
}

}  // namespace

TextEdits make_pose_edits(const scene::Widget& widget, const widget::Pose& pose) {
  TextEdits edits;
  for (auto& [key, value] : scene::pose_members(widget.spec.kind, pose))
    edits.push_back({item_pointer(widget.where) + "/" + key, std::move(value)});
  return edits;
}

std::vector<WidgetEdits::FinishedMove> WidgetEdits::take_finished(const scene::Scene& scene) {
  std::vector<FinishedMove> ended;
  std::map<std::string, bool> held;
  scene.entities.each<scene::Widget>([&](scene::Entity e, const scene::Widget& widget) {
    const std::string& place = widget.where.label;
    held[place] = is_held(widget.report.mode);
    const auto before = grabbed_.find(place);
    if (before == grabbed_.end() || !before->second || held[place]) return;
    ended.push_back({"move " + scene.entities.get<scene::Name>(e).value, make_pose_edits(widget, widget.report.pose)});
  });
  grabbed_ = std::move(held);
  return ended;
}

}  // namespace catena::app
