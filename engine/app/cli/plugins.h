/// Which plug-ins (haptics/plugin) the program loads, and what a recording says of them.
#pragma once
#include <string>
#include <vector>

#include "engine/base/result.h"
#include "engine/scene/scene.h"
#include "haptics/servo/log/contents.h"

namespace catena::app {

/// Loads, in this order: `named` (--plugin FILE); the absolute paths of CATENA_PLUGINS, with colons between them; and every *.so of
/// $XDG_DATA_HOME/catena/plugins (else ~/.local/share/catena/plugins), by name. Nothing else makes the program load code: no scene, no
/// recording, no data file. What does not fit of the first two is an error. In the folder it is a note, for there it is left from another
/// version, and most commands do not need it; a scene that does says which type is not known. Once, before the command's work.
Outcome load_plugins(const std::vector<std::string>& named);

/// Of those that are loaded, for the header of a recording.
std::vector<haptics::log::LogPlugin> plugins_for_log();

/// The error where a scene has links of a type that a plug-in gave when it was recorded, and that very plug-in is not loaded.
Outcome check_plugins(const std::vector<haptics::log::LogPlugin>& recorded, const scene::Scene& scene);

/// "ring.so (0123456789abcdef)"
std::string plugin_label(const haptics::log::LogPlugin& plugin);

}  // namespace catena::app
