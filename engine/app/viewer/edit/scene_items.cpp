#include "engine/app/viewer/edit/scene_items.h"

#include "engine/app/viewer/edit/pointers.h"
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

std::vector<std::string> felt_levels(const scene::Scene& scene, const scene::Isosurface& surface) {
  std::vector<std::string> pointers;
  const std::string field = name_of(scene, surface.field);
  scene.world.each<scene::Link>([&](scene::Entity, const scene::Link& link) {
    if (link.type != "isosurface") return;
    const json::Node *of = link.node.find("field"), *level = link.node.find("level");
    const bool same =
        of != nullptr && of->string == field && level != nullptr && level->kind == json::Kind::number && level->number == surface.level;
    if (const std::string at = pointer_of(link.node); same && !at.empty()) pointers.push_back(at + "/level");
  });
  return pointers;
}

}  // namespace catena::app
