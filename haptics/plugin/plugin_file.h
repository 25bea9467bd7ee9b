/// What a plug-in's file says of itself, read from its bytes: none of its code runs, and no byte is trusted.
#pragma once
#include <string_view>

#include "engine/base/result.h"
#include "haptics/plugin/plugin.h"

namespace catena::haptics::plugin {

/// Of a shared library (ELF).
struct PluginFile {
  AbiStamp abi_stamp;         ///< of the section .catena.plugin; its texts end with a zero
  bool links_catena = false;  ///< the system's loader would bring a libcatena.so with it
};

/// The error says what the bytes are not. Time: at most one step for each of the file's sections and dynamic entries.
Result<PluginFile> read_file(std::string_view bytes);

}  // namespace catena::haptics::plugin
