/// What catena-read-vtk does once it is shut in: one answer to one request.
#pragma once
#include "engine/io/sandbox/response_file.h"

namespace catena::vtk {

/// `path`: where the file lies for this process; `folder`: where it lies for others, absolute. Nothing is thrown: what is wrong is the
/// reply's error, a whole sentence.
field::ReadResponse handle_request(const field::ReadRequest& request, const std::string& path, const std::string& folder,
                                   sandbox::ResponseFile& out);

}  // namespace catena::vtk
