// The program catena-read: reads one .vdb or .npy file for catena, shut in, into the file in memory that is its descriptor 3
// (engine/field/reader_exchange.h).
#include <fcntl.h>
#include <fmt/format.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

#include "engine/base/text.h"
#include "engine/reader/confine.h"
#include "engine/reader/early.h"
#include "engine/reader/npy.h"
#include "engine/vdb/read.h"

namespace {

/// The file's bytes, mapped: a file that shrinks meanwhile ends this process, and nothing else.
catena::Result<std::span<const std::byte>> map_file(const std::string& path) {
  const auto failed = [&] { return catena::Error{fmt::format("{}: cannot be opened ({})", path, std::strerror(errno))}; };
  const int fd = ::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NOCTTY | O_NONBLOCK);
  struct stat status {};
  if (fd < 0 || ::fstat(fd, &status) != 0) return failed();
  if (!S_ISREG(status.st_mode) || status.st_size <= 0) return catena::Error{path + ": this is not a regular file, or it is empty"};
  const auto bytes = static_cast<std::size_t>(status.st_size);
  void* start = ::mmap(nullptr, bytes, PROT_READ, MAP_PRIVATE, fd, 0);
  if (start == MAP_FAILED) return failed();
  ::close(fd);
  return std::span<const std::byte>(static_cast<const std::byte*>(start), bytes);
}

CATENA_BEFORE_LIBRARIES(catena::reader::note_early_failures);

}  // namespace

int main() {
  catena::reader::AnswerFile out(catena::reader::kAnswer);
  const auto request = out.request();
  if (!request) {
    static constexpr char kWho[] = "catena-read: a part of catena, which starts it\n";
    return ::write(STDERR_FILENO, kWho, sizeof kWho - 1) < 0 ? 1 : 2;
  }
  catena::field::ReadReply reply;
  const auto file = map_file(request->what.path);
  const auto confined = catena::reader::confine({request->memory_bytes, request->cpu_s, 0, true});
  if (!file)
    reply.error = file.error().message;
  else if (!confined)
    reply.error = request->what.path + ": cannot be read safely: " + confined.error().message;
  else
    reply = catena::has_ending(request->what.path, ".npy") ? catena::reader::answer_npy(*request, *file, out)
                                                           : catena::vdb::answer(*request, *file, out);
  if (confined) reply.confinement = *confined;
  ::_exit(out.finish(reply) ? 0 : 3);
}
