// SPDX-License-Identifier: MIT
/// Handles a request in catena-read, inside the sandbox: one response per process.
#pragma once
#include <span>

#include "engine/io/sandbox/response_file.h"

namespace catena::vdb {

/// Handles a request for the .vdb file in `file`. Does not throw: the `error` of the response is a complete message.
field::ReadResponse handle_request(const field::ReadRequest& request, std::span<const std::byte> file, sandbox::ResponseFile& out);

}  // namespace catena::vdb
