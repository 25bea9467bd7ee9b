// SPDX-License-Identifier: MIT
// The program catena-read-vtk: reads one file, or one folder, for catena with VTK, ITK and similar libraries and writes the response into
// the shared memory file with descriptor 3 (engine/io/protocol.h). The sandbox restricts it to the folder of the named file.
#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>

#include "engine/base/text.h"
#include "engine/io/sandbox/opened_files.h"
#include "engine/io/sandbox/preinit.h"
#include "engine/io/sandbox/sandbox.h"
#include "engine/io/volume/data_files.h"
#include "engine/io/vtk/handle_request.h"

namespace {

struct Place {
  std::filesystem::path folder, name;  ///< no name: the folder itself is requested
};

Place place_of(const std::string& path) {
  std::error_code code;
  const std::filesystem::path full_path = std::filesystem::canonical(path, code);
  if (code) return {};
  if (std::filesystem::is_directory(full_path, code)) return {full_path, {}};
  return {full_path.parent_path(), full_path.filename()};
}

/// Returns a pipe, socket or device in a folder of images, at which GDCM's search would end silently; empty: none.
std::string find_special_file(const std::filesystem::path& folder) {
  std::error_code code;
  for (std::filesystem::directory_iterator at(folder, code), end; !code && at != end; at.increment(code)) {
    std::error_code ignored;
    const auto status = at->status(ignored);
    if (std::filesystem::exists(status) && std::filesystem::is_other(status)) return at->path().filename().string();
  }
  return {};
}

CATENA_BEFORE_LIBRARIES(catena::sandbox::report_early_failures);

}  // namespace

int main() {
  catena::sandbox::ResponseFile out(catena::sandbox::kResponseFd);
  const auto request = out.read_request();
  if (!request) {
    static constexpr char kWho[] = "catena-read-vtk: reads files for catena, which starts this program\n";
    return ::write(STDERR_FILENO, kWho, sizeof kWho - 1) < 0 ? 1 : 2;
  }
  ::setenv("HDF5_USE_FILE_LOCKING", "FALSE", 1);
  catena::field::ReadResponse reply;
  const Place place = place_of(request->load_request.path);
  const bool images = place.name.empty() && !catena::field::is_openfoam_case(place.folder.string());
  bool root_changed = false;
  const std::uint64_t first_s = std::min(request->cpu_s, catena::sandbox::cpu_limit_s(0));
  const auto confined =
      catena::sandbox::enter_sandbox({request->memory_bytes, first_s, request->cpu_s, true, place.folder.string()}, &root_changed);
  catena::sandbox::track_opened_files(request->cpu_s, images || catena::has_extension(place.name.string(), ".dcm"));
  if (place.folder.empty()) {
    reply.error = request->load_request.path + ": cannot be opened";
  } else if (!confined) {
    reply.error = request->load_request.path + ": cannot be read safely: " + confined.error().message;
  } else {
    const std::filesystem::path folder = root_changed ? "/" : place.folder;
    reply = catena::vtk::handle_request(*request, (place.name.empty() ? folder : folder / place.name).string(), place.folder.string(), out);
  }
  catena::sandbox::OpenedFiles opened = catena::sandbox::opened_files();
  if (images && confined && !place.folder.empty()) opened.refused_path = find_special_file(root_changed ? "/" : place.folder);
  if (!opened.refused_path.empty()) {
    reply = {};
    reply.error = request->load_request.path + ": cannot be read: " + catena::in_quotes(opened.refused_path) +
                  " is a pipe, a socket or a device; a regular file was expected";
  }
  reply.opened_files = opened.files;
  reply.newest_mtime_ns = opened.newest_mtime_ns;
  if (confined) reply.sandbox = *confined;
  ::_exit(out.finish(reply) ? 0 : 3);
}
