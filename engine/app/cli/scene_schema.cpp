// SPDX-License-Identifier: MIT
#include "engine/app/cli/scene_schema.h"

#include "engine/scene/scene.h"
#include "engine/schema/documents.h"
#include "haptics/constraints/registry.h"
#include "haptics/device/device_settings.h"

namespace catena::app {

std::vector<schema::Section> scene_file_components() {
  std::vector<schema::Section> all = scene::scene_components();
  for (schema::Section& component : all) {
    if (component.name == "chain") component = haptics::chain_component();
    if (component.name == "device") component = haptics::device_component();
    // "active_when" of a mode has the same keys as that of a link
    for (schema::Key& key : component.keys)
      if (component.name == "modes" && key.name == "active_when")
        key.members = schema::find(haptics::common_keys(), "active_when")->members;
  }
  return all;
}

std::string scene_json_schema() { return schema::json_schema(scene_file_components(), "a scene of Catena"); }

}  // namespace catena::app
