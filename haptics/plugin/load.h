// SPDX-License-Identifier: MIT
/// Loads plug-ins: shared libraries with constraint types by users (haptics/plugin/plugin.h). The program decides which ones are loaded
/// (engine/app/cli/plugins.h). At start-up, in the main thread, before any scene is read.
#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "engine/base/result.h"

namespace catena::haptics::plugin {

/// Plug-in that has been loaded.
struct LoadedPlugin {
  std::string file;                ///< file name, without the folder
  std::uint64_t hash = 0;          ///< hash of the file (engine/base/hash.h): distinguishes builds, but is no protection against tampering
  std::vector<std::string> types;  ///< names of the constraint types that it added
};

/// Returns the loaded plug-ins, in the order of loading.
const std::vector<LoadedPlugin>& loaded_plugins();

/// Returns why this process may not load plug-ins, as a clause; empty: it may. Plug-ins are not loaded as root, nor by a program with
/// rights that its user lacks (set-id, file capabilities), since the user could then run code with these rights.
std::string refusal_reason();

/// Loads a plug-in and adds its types to the registry. It stays loaded until the program exits. A file with the same contents as a loaded
/// one is not loaded twice.
/// Else the Error is one sentence and no type is added: no regular file; a file or folder that others may write or that belongs to another
/// user; no plug-in; built for other headers or by another compiler; linked with libcatena.so; initialization that throws, crashes or
/// hangs (tried in a child process first); the name of a type or key is taken; types that the registry cannot use; an exception. None of
/// its code has run unless it is one of the last four.
Outcome load(const std::string& path);

}  // namespace catena::haptics::plugin
