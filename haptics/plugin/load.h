/// Loads plug-ins: shared libraries with constraints of a user's own (haptics/plugin/plugin.h). Which ones, the program decides
/// (engine/app/cli/plugins.h). At start-up, in the first thread, before anything reads a scene.
#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "engine/base/result.h"

namespace catena::haptics::plugin {

/// One that is loaded.
struct LoadedPlugin {
  std::string file;                ///< its name, without its folder
  std::uint64_t hash = 0;          ///< of the file (engine/base/hash.h): tells builds apart, and is no proof against intent
  std::vector<std::string> types;  ///< the words that it gave to scenes
};

/// Those that are loaded, in their order.
const std::vector<LoadedPlugin>& loaded_plugins();

/// Why this process may load none, as a clause; empty: it may. None is loaded as root, or by a program that has rights which its caller
/// lacks (set-id, file capabilities): its caller would run code with them.
std::string refusal_reason();

/// Loads a file, and adds its types to the registry. It stays loaded to the end. The same file again is not loaded twice.
/// One sentence otherwise, and no type is added: no regular file; a file, or its folder, that others may write or that is somebody else's;
/// no plug-in; built for other headers or by another compiler; libcatena.so with it; a word or a key that is taken; nothing that a registry
/// could use; an exception. None of its code has run unless the last three are what is wrong.
Outcome load(const std::string& path);

}  // namespace catena::haptics::plugin
