// SPDX-License-Identifier: MIT
/// Loads plug-ins (haptics/plugin), and identifies them in recordings.
#pragma once
#include <string>
#include <vector>

#include "engine/base/result.h"
#include "engine/scene/scene.h"
#include "haptics/servo/log/contents.h"

namespace catena::app {

/// Loads, in this order: `named` (--plugin FILE); the absolute paths of CATENA_PLUGINS, separated by colons; and every *.so of
/// $XDG_DATA_HOME/catena/plugins (else ~/.local/share/catena/plugins), by name. Nothing else makes the program load code: no scene,
/// recording or data file. Error: a file of the first two groups cannot be loaded. A file of the folder that cannot be loaded gives only a
/// note: it may be left from another version, most commands do not need it, and a scene that does reports the unknown type. Call it at the
/// start of a process, before the command's action.
Outcome load_plugins(const std::vector<std::string>& named);

/// The loaded plug-ins, for the header of a recording.
std::vector<haptics::log::LogPlugin> plugins_for_log();

/// Error if the scene has a link whose type came from a plug-in of the recording, and that plug-in, with the same hash, is not loaded.
Outcome check_plugins(const std::vector<haptics::log::LogPlugin>& recorded, const scene::Scene& scene);

/// File name and hash for messages: "ring.so (0123456789abcdef)".
std::string plugin_label(const haptics::log::LogPlugin& plugin);

}  // namespace catena::app
