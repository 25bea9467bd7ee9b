// SPDX-License-Identifier: MIT
// The program catena-write: receives grids block by block on descriptor 3 and writes them as a .vdb file to descriptor 4.
#include <sys/socket.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <exception>
#include <new>
#include <string>
#include <vector>

#include "engine/base/system_failure.h"
#include "engine/base/threads.h"
#include "engine/io/sandbox/preinit.h"
#include "engine/io/sandbox/sandbox.h"
#include "engine/io/vdb/write_grids.h"

namespace {

constexpr int kLine = 3, kFile = 4;

/// The input stream, read in large buffers.
class Line {
 public:
  Line() : buffer_(1 << 20) {}
  bool take(void* to, std::size_t bytes) {
    char* at = static_cast<char*>(to);
    while (bytes > 0) {
      if (begin_ == end_ && !fill()) return false;
      const std::size_t count = std::min(bytes, end_ - begin_);
      std::copy_n(buffer_.data() + begin_, count, at);
      begin_ += count;
      at += count;
      bytes -= count;
    }
    return true;
  }

 private:
  bool fill() {
    ssize_t n = 0;
    do n = ::recv(kLine, buffer_.data(), buffer_.size(), 0);
    while (n < 0 && errno == EINTR);
    begin_ = 0;
    end_ = n > 0 ? static_cast<std::size_t>(n) : 0;
    return end_ > 0;
  }

  std::vector<char> buffer_;
  std::size_t begin_ = 0, end_ = 0;
};

void send_system_failure(const std::string& reason) {
  const std::string failure = "1" + reason;
  [[maybe_unused]] const auto sent = ::send(kLine, failure.data(), failure.size(), MSG_NOSIGNAL);
}

[[noreturn]] void on_no_memory() {
  char reason[256];
  std::snprintf(reason, sizeof reason, "1%s", catena::out_of_memory_message());
  [[maybe_unused]] const auto sent = ::send(kLine, reason, std::strlen(reason), MSG_NOSIGNAL);
  ::_exit(0);
}

/// Reports an exception that cannot be caught, as in a thread that a library started.
[[noreturn]] void on_terminate() {
  try {
    if (const std::exception_ptr thrown = std::current_exception()) std::rethrow_exception(thrown);
  } catch (const std::exception& error) {
    send_system_failure(catena::is_thread_start_failure(error)
                            ? "no other thread can be started: " + catena::describe_errno(catena::thread_start_errno())
                            : std::string(error.what()));
    ::_exit(0);
  } catch (...) {
  }
  std::abort();
}

void hear_failures() noexcept {
  std::set_terminate(on_terminate);
  std::set_new_handler(on_no_memory);
}
CATENA_BEFORE_LIBRARIES(hear_failures);

}  // namespace

int main() {
  int type = 0;
  socklen_t size = sizeof type;
  if (::getsockopt(kLine, SOL_SOCKET, SO_TYPE, &type, &size) != 0) {
    static constexpr char kWho[] = "catena-write: writes .vdb files for catena, which starts this program\n";
    return ::write(STDERR_FILENO, kWho, sizeof kWho - 1) < 0 ? 1 : 2;
  }
  hear_failures();
  ::signal(SIGXFSZ, SIG_IGN);  // a file that cannot grow then fails as a write
  struct stat status {};
  const bool seekable = ::fstat(kFile, &status) == 0 && S_ISREG(status.st_mode);
  catena::sandbox::ProcessLimits limits;
  limits.only_memory_files = false;
  const auto confined = catena::sandbox::enter_sandbox(limits);
  Line line;
  const catena::Outcome done =
      confined ? catena::vdb::write_grids([&](void* to, std::size_t bytes) { return line.take(to, bytes); }, kFile, seekable)
               : catena::Outcome(confined.error());
  // the response is '1' for a system failure or '0' for bad data, followed by the message
  const std::string failure = done ? std::string() : (done.error().system_failure ? "1" : "0") + done.error().message;
  if (!failure.empty() && ::send(kLine, failure.data(), failure.size(), MSG_NOSIGNAL) < 0) return 1;
  ::_exit(0);
}
