// SPDX-License-Identifier: MIT
// Replaces the C library's functions that open files, for catena-read-vtk only: the format libraries link to these. Anything but a regular
// file or a folder is refused without blocking, and opened files are recorded (engine/io/sandbox/opened_files.h).
#include <fcntl.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <cerrno>
#include <cstdarg>
#include <cstdio>
#include <cstring>

#include "engine/io/sandbox/opened_files.h"

namespace {

int open_known(int folder, const char* path, int flags, unsigned mode) {
  const bool counts = catena::sandbox::is_tracking_opened_files();
  const int more = counts ? O_NONBLOCK | O_NOCTTY : 0;
  const auto descriptor = static_cast<int>(::syscall(SYS_openat, folder, path, flags | more, mode));
  struct stat about {};
  if (descriptor < 0 && counts && errno == ENXIO) catena::sandbox::record_refused(path);
  if (descriptor < 0 || !counts || ::fstat(descriptor, &about) != 0 || S_ISDIR(about.st_mode)) return descriptor;
  if (S_ISREG(about.st_mode)) {
    catena::sandbox::record_opened(descriptor, about);
    return descriptor;
  }
  catena::sandbox::record_refused(path);
  ::close(descriptor);
  errno = ENXIO;
  return -1;
}

std::FILE* open_stream(const char* path, const char* mode) {
  const bool updates = std::strchr(mode, '+') != nullptr;
  int flags = updates ? O_RDWR : mode[0] == 'r' ? O_RDONLY : O_WRONLY;
  if (mode[0] == 'w') flags |= O_CREAT | O_TRUNC;
  if (mode[0] == 'a') flags |= O_CREAT | O_APPEND;
  if (std::strchr(mode, 'e') != nullptr) flags |= O_CLOEXEC;
  if (std::strchr(mode, 'x') != nullptr) flags |= O_EXCL;
  const int descriptor = open_known(AT_FDCWD, path, flags, 0666);
  return descriptor < 0 ? nullptr : ::fdopen(descriptor, mode);
}

}  // namespace

// The functions have separate C++ names, because the headers define some of them as inline functions; the linker sees the C library's
// names.
#define CATENA_IN_FRONT_OF(name) __asm__(name) __attribute__((visibility("default"), used))
extern "C" {
int catena_open(const char* path, int flags, ...) CATENA_IN_FRONT_OF("open");
int catena_open64(const char* path, int flags, ...) CATENA_IN_FRONT_OF("open64");
int catena_open_2(const char* path, int flags) CATENA_IN_FRONT_OF("__open_2");
int catena_open64_2(const char* path, int flags) CATENA_IN_FRONT_OF("__open64_2");
int catena_openat(int folder, const char* path, int flags, ...) CATENA_IN_FRONT_OF("openat");
int catena_openat64(int folder, const char* path, int flags, ...) CATENA_IN_FRONT_OF("openat64");
int catena_openat_2(int folder, const char* path, int flags) CATENA_IN_FRONT_OF("__openat_2");
int catena_openat64_2(int folder, const char* path, int flags) CATENA_IN_FRONT_OF("__openat64_2");
std::FILE* catena_fopen(const char* path, const char* mode) CATENA_IN_FRONT_OF("fopen");
std::FILE* catena_fopen64(const char* path, const char* mode) CATENA_IN_FRONT_OF("fopen64");
}

#define CATENA_MODE(flags)                 \
  unsigned mode = 0;                       \
  if (((flags) & (O_CREAT | O_TMPFILE))) { \
    va_list rest;                          \
    va_start(rest, flags);                 \
    mode = va_arg(rest, unsigned);         \
    va_end(rest);                          \
  }

extern "C" int catena_open(const char* path, int flags, ...) {
  CATENA_MODE(flags)
  return open_known(AT_FDCWD, path, flags, mode);
}
extern "C" int catena_open64(const char* path, int flags, ...) {
  CATENA_MODE(flags)
  return open_known(AT_FDCWD, path, flags, mode);
}
extern "C" int catena_openat(int folder, const char* path, int flags, ...) {
  CATENA_MODE(flags)
  return open_known(folder, path, flags, mode);
}
extern "C" int catena_openat64(int folder, const char* path, int flags, ...) {
  CATENA_MODE(flags)
  return open_known(folder, path, flags, mode);
}
extern "C" int catena_open_2(const char* path, int flags) { return open_known(AT_FDCWD, path, flags, 0); }
extern "C" int catena_open64_2(const char* path, int flags) { return open_known(AT_FDCWD, path, flags, 0); }
extern "C" int catena_openat_2(int folder, const char* path, int flags) { return open_known(folder, path, flags, 0); }
extern "C" int catena_openat64_2(int folder, const char* path, int flags) { return open_known(folder, path, flags, 0); }
extern "C" std::FILE* catena_fopen(const char* path, const char* mode) { return open_stream(path, mode); }
extern "C" std::FILE* catena_fopen64(const char* path, const char* mode) { return open_stream(path, mode); }
