/// What catena-read does once it is shut in: one answer to one request.
#pragma once
#include <span>

#include "engine/io/sandbox/response_file.h"

namespace catena::vdb {

/// Nothing is thrown: what is wrong with the file is the reply's error, a whole sentence.
field::ReadResponse handle_request(const field::ReadRequest& request, std::span<const std::byte> file, sandbox::ResponseFile& out);

}  // namespace catena::vdb
