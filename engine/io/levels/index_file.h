// SPDX-License-Identifier: MIT
/// File of a brick index: the identity of the data that it describes, the index, a hash of both. Any thread.
#pragma once
#include <optional>
#include <string>

#include "engine/base/result.h"
#include "engine/field/bricks/brick_index.h"

namespace catena::field {

/// Writes an index to a new or existing file, through a temporary file. The Error is a complete message, a system failure.
Outcome write_index(const std::string& path, const std::string& identity, const BrickIndex& index);

/// Reads the index of the data with that identity; nullopt: there is no file, it describes other data, or it is damaged.
std::optional<BrickIndex> read_index(const std::string& path, const std::string& identity);

}  // namespace catena::field
