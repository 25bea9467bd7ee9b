// SPDX-License-Identifier: MIT
/// Handles a request in catena-read-vtk, inside the sandbox: one response per process.
#pragma once
#include "engine/io/sandbox/response_file.h"

namespace catena::vtk {

/// Handles a request. `path`: location of the file in this process (the root may have changed); `folder`: absolute path of its folder
/// outside. Does not throw: the `error` of the response is a complete message.
field::ReadResponse handle_request(const field::ReadRequest& request, const std::string& path, const std::string& folder,
                                   sandbox::ResponseFile& out);

}  // namespace catena::vtk
