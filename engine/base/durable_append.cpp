// SPDX-License-Identifier: MIT
#include "engine/base/durable_append.h"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

#include "engine/base/input_files.h"
#include "engine/base/system_failure.h"

namespace catena {

Outcome append_durably(const std::string& path, std::string_view header, std::string_view text) {
  CATENA_CHECK(check_not_input(path));
  const auto cannot = [&] { return system_error(path + ": cannot write", errno); };
  const int file = ::open(path.c_str(), O_WRONLY | O_CREAT | O_APPEND | O_NONBLOCK | O_CLOEXEC, 0666);
  if (file < 0) return cannot();
  const off_t size = ::lseek(file, 0, SEEK_END);
  const std::string all = std::string(size == 0 ? header : "") + std::string(text);
  const bool written = ::write(file, all.data(), all.size()) == static_cast<ssize_t>(all.size()) && ::fdatasync(file) == 0;
  Outcome done = written ? Outcome(Done{}) : Outcome(cannot());
  if (!written && size >= 0) static_cast<void>(::ftruncate(file, size) == 0);
  ::close(file);
  return done;
}

}  // namespace catena
