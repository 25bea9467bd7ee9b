#include "engine/app/scene_schema.h"

#include "engine/scene/scene.h"
#include "engine/schema/documents.h"
#include "haptics/constraints/registry.h"
#include "haptics/device/settings.h"

namespace catena::app {

std::vector<schema::Component> scene_description() {
  std::vector<schema::Component> all = scene::scene_components();
  for (schema::Component& component : all) {
    if (component.name == "chain") component = haptics::chain_component();
    if (component.name == "device") component = haptics::device_component();
    // the switch of a mode is that of a link
    for (schema::Key& key : component.keys)
      if (component.name == "modes" && key.name == "on") key.inner = schema::find(haptics::common_keys(), "on")->inner;
  }
  return all;
}

std::string scene_schema() { return schema::json_schema(scene_description(), "a scene of Catena"); }

}  // namespace catena::app
