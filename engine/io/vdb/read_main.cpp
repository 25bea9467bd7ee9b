// SPDX-License-Identifier: MIT
// The program catena-read: reads one .vdb or .npy file for catena in a sandbox and writes the response into the shared memory file with
// descriptor 3 (engine/io/protocol.h).
#include <fcntl.h>
#include <fmt/format.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

#include "engine/base/text.h"
#include "engine/io/sandbox/npy.h"
#include "engine/io/sandbox/preinit.h"
#include "engine/io/sandbox/sandbox.h"
#include "engine/io/vdb/handle_request.h"

namespace {

/// Maps the file. If the file shrinks while it is mapped, only this process is killed.
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

CATENA_BEFORE_LIBRARIES(catena::sandbox::report_early_failures);

}  // namespace

int main() {
  catena::sandbox::ResponseFile out(catena::sandbox::kResponseFd);
  const auto request = out.read_request();
  if (!request) {
    static constexpr char kWho[] = "catena-read: reads files for catena, which starts this program\n";
    return ::write(STDERR_FILENO, kWho, sizeof kWho - 1) < 0 ? 1 : 2;
  }
  catena::field::ReadResponse reply;
  const auto file = map_file(request->load_request.path);
  const auto confined = catena::sandbox::enter_sandbox({request->memory_bytes, request->cpu_s, 0, true});
  if (!file)
    reply.error = file.error().message;
  else if (!confined)
    reply.error = request->load_request.path + ": cannot be read safely: " + confined.error().message;
  else
    reply = catena::has_extension(request->load_request.path, ".npy") ? catena::sandbox::handle_npy_request(*request, *file, out)
                                                                      : catena::vdb::handle_request(*request, *file, out);
  if (confined) reply.sandbox = *confined;
  ::_exit(out.finish(reply) ? 0 : 3);
}
