/// What catena-write does once it is shut in: the grids that come as a stream of blocks (engine/io/volume/vdb_stream.h) become a .vdb file.
#pragma once
#include <functional>
#include <string>

#include "engine/base/result.h"

namespace catena::vdb {

/// Reads so many bytes from the stream; false at its end.
using ReadBytes = std::function<bool(void* to, std::size_t bytes)>;

/// Writes to the descriptor; `seekable`: it is a regular file. An error is a phrase.
Outcome write_grids(const ReadBytes& take, int fd, bool seekable);

}  // namespace catena::vdb
