// SPDX-License-Identifier: MIT
/// Reads the properties of a plug-in from the bytes of its file: none of its code runs, and no byte is trusted.
#pragma once
#include <string_view>

#include "engine/base/result.h"
#include "haptics/plugin/plugin.h"

namespace catena::haptics::plugin {

/// Properties of a plug-in's shared library (ELF).
struct PluginFile {
  AbiStamp abi_stamp;         ///< from the section .catena.plugin; its texts are zero-terminated
  bool links_catena = false;  ///< the library depends on libcatena.so, which the dynamic linker would load
};

/// Parses a file. An Error if it is no shared library of this machine, truncated, or without an ABI stamp. Time: linear in the number of
/// sections and dynamic entries.
Result<PluginFile> read_file(std::string_view bytes);

}  // namespace catena::haptics::plugin
