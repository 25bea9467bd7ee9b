// The program catena-read-vtk: reads one file, or one folder, for catena, by VTK, ITK and their kin, into the file in memory that is its
// descriptor 3 (engine/field/reader_exchange.h). It is shut in: of all files it can open those of the named one's folder alone.
#include <unistd.h>

#include <cstdlib>
#include <filesystem>

#include "engine/reader/confine.h"
#include "engine/vtk/read.h"

namespace {

constexpr int kAnswer = 3;

struct Place {
  std::filesystem::path folder, name;  ///< no name: the folder itself is meant
};

Place place_of(const std::string& path) {
  std::error_code code;
  const std::filesystem::path whole = std::filesystem::canonical(path, code);
  if (code) return {};
  if (std::filesystem::is_directory(whole, code)) return {whole, {}};
  return {whole.parent_path(), whole.filename()};
}

}  // namespace

int main() {
  catena::reader::AnswerFile out(kAnswer);
  const auto request = out.request();
  if (!request) {
    static constexpr char kWho[] = "catena-read-vtk: a part of catena, which starts it\n";
    return ::write(STDERR_FILENO, kWho, sizeof kWho - 1) < 0 ? 1 : 2;
  }
  ::setenv("HDF5_USE_FILE_LOCKING", "FALSE", 1);
  catena::field::ReadReply reply;
  const Place place = place_of(request->what.path);
  bool root_changed = false;
  const auto confined = catena::reader::confine({request->memory_bytes, request->cpu_s, true, place.folder.string()}, &root_changed);
  if (place.folder.empty()) {
    reply.error = request->what.path + ": cannot be opened";
  } else if (!confined) {
    reply.error = request->what.path + ": cannot be read safely: " + confined.error().message;
  } else {
    const std::filesystem::path folder = root_changed ? "/" : place.folder;
    reply = catena::vtk::answer(*request, (place.name.empty() ? folder : folder / place.name).string(), out);
  }
  if (confined) reply.confinement = *confined;
  ::_exit(out.finish(reply) ? 0 : 3);
}
