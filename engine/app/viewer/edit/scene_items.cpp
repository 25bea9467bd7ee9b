#include "engine/app/viewer/edit/scene_items.h"

#include <cmath>
#include <limits>

#include "engine/app/viewer/edit/chain_edit.h"
#include "engine/app/viewer/edit/pointers.h"
#include "engine/base/json_edit.h"
#include "engine/scene/hidden.h"
#include "engine/scene/link_feature.h"
#include "engine/scene/write_values.h"

namespace catena::app {

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

}  // namespace catena::app
