// SPDX-License-Identifier: MIT
/// Preloaded into the program `catena`: injects one fault, counted from the beginning of main.
///   CATENA_FAULT=alloc:N    the N-th allocation (malloc and its family, operator new) fails. Allocations by graphics drivers, the
///                           dynamic linker and their libraries are not counted, because they end the process on a failure
///   CATENA_FAULT=space:N    the N-th write to a file and all later ones fail with ENOSPC (except standard output and error)
///   CATENA_FAULT=thread:N   the N-th creation of a thread fails (EAGAIN)
///   CATENA_FAULT=signal:US  every US microseconds a signal interrupts waiting system calls (no SA_RESTART: EINTR)
/// N = 0: nothing fails. CATENA_FAULT_COUNT=PATH: file for the number of possible failures, written at the end.
#include <dlfcn.h>
#include <fcntl.h>
#include <pthread.h>
#include <signal.h>
#include <sys/stat.h>
#include <sys/time.h>
#include <sys/uio.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <new>

extern "C" {
void* __libc_malloc(std::size_t);
void* __libc_calloc(std::size_t, std::size_t);
void* __libc_realloc(void*, std::size_t);
void* __libc_memalign(std::size_t, std::size_t);
}

namespace {

enum class Kind { none, alloc, space, thread, signal };
Kind kind = Kind::none;
long which = 0;
std::atomic<long> count{0};
std::atomic<bool> armed{false};

template <class F>
F next(const char* name) {
  return reinterpret_cast<F>(dlsym(RTLD_NEXT, name));
}

// True for callers outside of this project.
bool is_foreign(const void* caller) {
  Dl_info info{};
  if (dladdr(caller, &info) == 0 || info.dli_fname == nullptr) return true;
  const char* slash = std::strrchr(info.dli_fname, '/');
  const char* file = slash != nullptr ? slash + 1 : info.dli_fname;
  for (const char* part : {"LLVM", "vulkan", "lvp", "libX", "libxcb", "gallium", "swrast", "drm", "ld-linux", "libelf", "libedit",
                           "libglfw", "wayland", "libsensors", "VkLayer", "libcatena_faults"})
    if (std::strstr(file, part) != nullptr) return true;
  return false;
}

// True for the call that fails, counted from 1; `lasting`: also for all later calls.
bool fails(bool lasting = false) {
  const long now = count.fetch_add(1) + 1;
  return which > 0 && (lasting ? now >= which : now == which);
}

bool allocation_fails(const void* caller) {
  if (kind != Kind::alloc || !armed.load(std::memory_order_relaxed) || is_foreign(caller)) return false;
  if (!fails()) return false;
  errno = ENOMEM;
  return true;
}

bool write_fails(int file) {
  if (kind != Kind::space || !armed.load(std::memory_order_relaxed) || file <= 2) return false;
  struct stat status {};
  if (fstat(file, &status) != 0 || !S_ISREG(status.st_mode)) return false;
  if (!fails(true)) return false;
  errno = ENOSPC;
  return true;
}

void on_signal(int) { count.fetch_add(1); }

void arm() {
  const char* wanted = std::getenv("CATENA_FAULT");
  if (wanted == nullptr) return;
  const char* colon = std::strchr(wanted, ':');
  if (colon == nullptr) return;
  const std::size_t length = static_cast<std::size_t>(colon - wanted);
  const auto is = [&](const char* word) { return std::strlen(word) == length && std::strncmp(wanted, word, length) == 0; };
  which = std::strtol(colon + 1, nullptr, 10);
  kind = is("alloc") ? Kind::alloc : is("space") ? Kind::space : is("thread") ? Kind::thread : is("signal") ? Kind::signal : Kind::none;
  if (kind == Kind::signal && which > 0) {
    struct sigaction action {};
    action.sa_handler = on_signal;
    sigaction(SIGALRM, &action, nullptr);
    itimerval every{};
    every.it_interval.tv_usec = every.it_value.tv_usec = which;
    setitimer(ITIMER_REAL, &every, nullptr);
  }
  armed = true;
}

[[gnu::destructor]] void tell() {
  armed = false;
  const char* path = std::getenv("CATENA_FAULT_COUNT");
  if (path == nullptr || kind == Kind::none) return;
  char text[32];
  const int length = std::snprintf(text, sizeof text, "%ld\n", count.load());
  const int file = open(path, O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0600);
  if (file < 0) return;
  [[maybe_unused]] const auto written =
      next<ssize_t (*)(int, const void*, std::size_t)>("write")(file, text, static_cast<std::size_t>(length));
  close(file);
}

int (*real_main)(int, char**, char**) = nullptr;
int armed_main(int argc, char** argv, char** environment) {
  arm();
  const int code = real_main(argc, argv, environment);
  armed = false;
  return code;
}

using StartMain = int (*)(int (*)(int, char**, char**), int, char**, void (*)(), void (*)(), void (*)(), void*);

}  // namespace

extern "C" {

int __libc_start_main(int (*main)(int, char**, char**), int argc, char** argv, void (*init)(), void (*fini)(), void (*linker)(),
                      void* end) {
  real_main = main;
  return next<StartMain>("__libc_start_main")(armed_main, argc, argv, init, fini, linker, end);
}

void* malloc(std::size_t size) { return allocation_fails(__builtin_return_address(0)) ? nullptr : __libc_malloc(size); }
void* calloc(std::size_t n, std::size_t size) { return allocation_fails(__builtin_return_address(0)) ? nullptr : __libc_calloc(n, size); }
void* realloc(void* at, std::size_t size) { return allocation_fails(__builtin_return_address(0)) ? nullptr : __libc_realloc(at, size); }
void* memalign(std::size_t a, std::size_t size) {
  return allocation_fails(__builtin_return_address(0)) ? nullptr : __libc_memalign(a, size);
}
void* aligned_alloc(std::size_t a, std::size_t size) {
  return allocation_fails(__builtin_return_address(0)) ? nullptr : __libc_memalign(a, size);
}
int posix_memalign(void** out, std::size_t a, std::size_t size) {
  if (allocation_fails(__builtin_return_address(0))) return ENOMEM;
  *out = __libc_memalign(a, size);
  return *out != nullptr ? 0 : ENOMEM;
}

ssize_t write(int file, const void* data, std::size_t size) {
  static const auto real = next<ssize_t (*)(int, const void*, std::size_t)>("write");
  return write_fails(file) ? -1 : real(file, data, size);
}
ssize_t writev(int file, const iovec* parts, int n) {
  static const auto real = next<ssize_t (*)(int, const iovec*, int)>("writev");
  return write_fails(file) ? -1 : real(file, parts, n);
}
ssize_t pwrite(int file, const void* data, std::size_t size, off_t at) {
  static const auto real = next<ssize_t (*)(int, const void*, std::size_t, off_t)>("pwrite");
  return write_fails(file) ? -1 : real(file, data, size, at);
}
std::size_t fwrite(const void* data, std::size_t size, std::size_t n, FILE* file) {
  static const auto real = next<std::size_t (*)(const void*, std::size_t, std::size_t, FILE*)>("fwrite");
  return write_fails(fileno(file)) ? 0 : real(data, size, n, file);
}

int pthread_create(pthread_t* thread, const pthread_attr_t* attributes, void* (*body)(void*), void* argument) {
  static const auto real = next<int (*)(pthread_t*, const pthread_attr_t*, void* (*)(void*), void*)>("pthread_create");
  const bool counted = kind == Kind::thread && armed.load(std::memory_order_relaxed) && !is_foreign(__builtin_return_address(0));
  return counted && fails() ? EAGAIN : real(thread, attributes, body, argument);
}

}  // extern "C"

// Operators new of the program, so that the caller is the requesting code and not the C++ library.
void* operator new(std::size_t size) {
  void* const at = allocation_fails(__builtin_return_address(0)) ? nullptr : __libc_malloc(size > 0 ? size : 1);
  if (at == nullptr) throw std::bad_alloc();
  return at;
}
void* operator new[](std::size_t size) {
  void* const at = allocation_fails(__builtin_return_address(0)) ? nullptr : __libc_malloc(size > 0 ? size : 1);
  if (at == nullptr) throw std::bad_alloc();
  return at;
}
