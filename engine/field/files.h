/// Private to this room: the checks that every reader makes of a path.
#pragma once
#include <cstdint>
#include <string>

#include "engine/base/result.h"

namespace catena::field {

/// The size of a regular file that can be opened; else an error that names it.
Result<std::uint64_t> readable_file(const std::string& path);
/// The file's name without folder and extension.
std::string stem_of(const std::string& path);

}  // namespace catena::field
