// SPDX-License-Identifier: MIT
/// Writes a .vdb file in catena-write, inside the sandbox, from a stream of leaves and tiles (engine/io/volume/vdb_stream.h).
#pragma once
#include <functional>
#include <string>

#include "engine/base/result.h"

namespace catena::vdb {

/// Reads exactly `bytes` bytes from the stream; returns false at its end.
using ReadBytes = std::function<bool(void* to, std::size_t bytes)>;

/// Writes the grids to the descriptor; `seekable`: it is a regular file. Returns an Error with a message fragment.
Outcome write_grids(const ReadBytes& read_bytes, int fd, bool seekable);

}  // namespace catena::vdb
