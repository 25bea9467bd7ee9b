#include "engine/app/viewer/edit/scene_items.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "engine/app/viewer/edit/chain_edit.h"
#include "engine/base/json_edit.h"
#include "engine/scene/hidden.h"
#include "engine/scene/ruler.h"
#include "engine/scene/widgets.h"
#include "engine/scene/write_values.h"

namespace catena::app {

std::string pointer_of(const json::Node& item) {
  const std::size_t open = item.label.find('[');
  if (item.line <= 0 || open == std::string::npos || open == 0 || !item.label.ends_with(']')) return {};
  const std::string index = item.label.substr(open + 1, item.label.size() - open - 2);
  if (index.empty() || !std::all_of(index.begin(), index.end(), [](char c) { return c >= '0' && c <= '9'; })) return {};
  return "/" + item.label.substr(0, open) + "/" + index;
}

std::string name_of(const scene::Scene& scene, scene::Entity entity) {
  return scene.world.has<scene::Name>(entity) ? scene.world.get<scene::Name>(entity).value : std::string();
}

std::vector<std::string> field_names(const scene::Scene& scene) {
  std::vector<std::string> names;
  scene.world.each<scene::FieldSource>([&](scene::Entity e, const scene::FieldSource&) { names.push_back(name_of(scene, e)); });
  return names;
}

std::vector<std::string> felt_levels(const scene::Scene& scene, const std::string& field, double level) {
  std::vector<std::string> pointers;
  scene.world.each<scene::Link>([&](scene::Entity, const scene::Link& link) {
    if (scene::field_of_level(link.node) != field) return;
    const json::Node& stated = *link.node.find("level");
    const std::string at = pointer_of(link.node);
    if (stated.kind == json::Kind::number && stated.number == level && !at.empty()) pointers.push_back(at + "/level");
  });
  return pointers;
}

TextEdits level_edits(const scene::Scene& scene, const scene::Isosurface& surface, double level) {
  TextEdits edits{{pointer_of(surface.where) + "/level", scene::text_of(level)}};
  for (const std::string& pointer : felt_levels(scene, name_of(scene, surface.field), surface.level))
    edits.push_back({pointer, scene::text_of(level)});
  return edits;
}

std::vector<std::string> seen_levels(const scene::Scene& scene, const std::string& field, double level) {
  std::vector<std::string> pointers;
  scene.world.each<scene::Isosurface>([&](scene::Entity, const scene::Isosurface& surface) {
    const json::Node* stated = surface.where.find("level");
    if (stated == nullptr || stated->kind != json::Kind::number || stated->number != level || name_of(scene, surface.field) != field)
      return;
    if (const std::string at = pointer_of(surface.where); !at.empty()) pointers.push_back(at + "/level");
  });
  return pointers;
}

std::string drawn_level(const scene::Scene& scene, const std::string& field, double value) {
  std::string text;
  double nearest = std::numeric_limits<double>::infinity();
  scene.world.each<scene::Isosurface>([&](scene::Entity e, const scene::Isosurface& surface) {
    if (scene::is_hidden(scene.world, e) || name_of(scene, surface.field) != field) return;
    const double away = std::abs(surface.level - value);
    if (!text.empty() && !(away < nearest)) return;
    nearest = away;
    text = surface.level_from ? "{\"widget\": " + scene::text_of(name_of(scene, surface.level_from)) + "}" : scene::text_of(surface.level);
  });
  return text;
}

std::string felt_level(const scene::Scene& scene, const std::string& field) {
  std::string text;
  scene.world.each<scene::Link>([&](scene::Entity, const scene::Link& link) {
    if (!text.empty() || scene::field_of_level(link.node) != field) return;
    text = json::node_text(*link.node.find("level"));
  });
  return text;
}

std::string drawn_field(const scene::Scene& scene) {
  std::string field;
  scene.world.each<scene::Isosurface>([&](scene::Entity e, const scene::Isosurface& surface) {
    if (field.empty() && !scene::is_hidden(scene.world, e)) field = name_of(scene, surface.field);
  });
  return field;
}

namespace {

bool is_held(exchange::WidgetMode mode) {
  using Mode = exchange::WidgetMode;
  return mode == Mode::translate || mode == Mode::turn || mode == Mode::drag;
}

}  // namespace

std::vector<WidgetEdits::Ended> WidgetEdits::take(const scene::Scene& scene) {
  std::vector<Ended> ended;
  std::map<std::string, bool> held;
  scene.world.each<scene::Widget>([&](scene::Entity e, const scene::Widget& widget) {
    const std::string& place = widget.where.label;
    held[place] = is_held(widget.state.mode);
    const auto before = held_.find(place);
    if (before == held_.end() || !before->second || held[place]) return;
    Ended end{"move " + scene.world.get<scene::Name>(e).value, {}};
    for (auto& [key, value] : scene::pose_members(widget.spec.kind, widget.state.pose))
      end.edits.push_back({pointer_of(widget.where) + "/" + key, std::move(value)});
    ended.push_back(std::move(end));
  });
  held_ = std::move(held);
  return ended;
}

}  // namespace catena::app
