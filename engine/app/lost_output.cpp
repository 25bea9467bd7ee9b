#include "engine/app/lost_output.h"

#include <fcntl.h>
#include <poll.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <string>

#include "engine/app/hand/interrupt.h"
#include "engine/base/tell.h"

namespace catena::app {
namespace {

bool reader_has_gone() {
  pollfd out{STDOUT_FILENO, POLLOUT, 0};
  return ::poll(&out, 1, 0) == 1 && (out.revents & POLLERR) != 0;
}

}  // namespace

void keep_standard_descriptors() {
  // the lowest free one is taken: 0 before 1 before 2
  for (const int fd : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO})
    if (::fcntl(fd, F_GETFD) < 0 && errno == EBADF && ::open("/dev/null", O_RDONLY) < 0) return;
}

int exit_code_after_output(int code) {
  const bool lost_before = std::ferror(stdout) != 0;
  errno = 0;
  if (std::fflush(stdout) == 0 && !lost_before) return code;
  const int why = errno;
  if (code != 0 || ended_by_broken_pipe()) return code;
  if (why == EPIPE || reader_has_gone()) return 1;
  const std::string reason = why != 0 ? " (" + std::string(std::strerror(why)) + ")" : "";
  tell_from_catena("standard output cannot be written" + reason + ": what was printed is lost, a place that takes it was expected");
  return 1;
}

}  // namespace catena::app
