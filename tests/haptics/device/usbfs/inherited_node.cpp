// SPDX-License-Identifier: MIT
// A library to preload before umockdev's, for two features of the kernel's usbfs that umockdev does not emulate.
//   Inherited nodes: umockdev knows only nodes that the process itself has opened. The library reopens catena-watchdog's descriptor 3
//   and forwards its requests to the new descriptor.
//   Atomic requests: SIGSTOP never stops a process within a kernel request, but umockdev's requests are exchanged between user
//   programs, and its one thread would wait. Signal SIGRTMIN + 5 stops the program by SIGSTOP outside of all requests.
#include <dirent.h>
#include <dlfcn.h>
#include <fcntl.h>
#include <sched.h>
#include <semaphore.h>
#include <sys/types.h>
#include <unistd.h>

#include <atomic>
#include <climits>
#include <csignal>
#include <cstdarg>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <thread>

namespace {

constexpr int kInherited = 3;
int opened_again = -1;

// the test bed's node that links to the descriptor's file
bool find_node(const char* target, char (&node)[PATH_MAX]) {
  const char* root = std::getenv("UMOCKDEV_DIR");
  if (root == nullptr) return false;
  char folder[PATH_MAX], link[PATH_MAX];
  std::snprintf(folder, sizeof folder, "%s/dev/bus/usb/001", root);
  DIR* const dir = opendir(folder);
  if (dir == nullptr) return false;
  bool found = false;
  for (const dirent* entry = readdir(dir); entry != nullptr && !found; entry = readdir(dir)) {
    const int file = dirfd(dir);
    const ssize_t n = readlinkat(file, entry->d_name, link, sizeof link - 1);
    if (n <= 0) continue;
    link[n] = 0;
    found = std::strcmp(link, target) == 0;
    if (found) std::snprintf(node, sizeof node, "/dev/bus/usb/001/%s", entry->d_name);
  }
  closedir(dir);
  return found;
}

// ---- stop outside of requests ----

sem_t stop_asked;
std::atomic<bool> stopping{false};
std::atomic<int> within{0};

struct Request {
  Request() {
    while (true) {
      while (stopping) sched_yield();
      ++within;
      if (!stopping) return;
      --within;
    }
  }
  ~Request() { --within; }
};

void stop_when_asked() {
  sem_init(&stop_asked, 0, 0);
  std::signal(SIGRTMIN + 5, [](int) { sem_post(&stop_asked); });
  std::thread([] {
    while (true) {
      if (sem_wait(&stop_asked) != 0) continue;
      stopping = true;
      while (within != 0) sched_yield();
      kill(getpid(), SIGSTOP);
      stopping = false;
    }
  }).detach();
}

__attribute__((constructor)) void begin() {
  char self[PATH_MAX] = {}, target[PATH_MAX] = {}, node[PATH_MAX];
  if (readlink("/proc/self/exe", self, sizeof self - 1) <= 0) return;
  if (std::strstr(self, "/catena-watchdog") == nullptr) return stop_when_asked();
  if (readlink("/proc/self/fd/3", target, sizeof target - 1) <= 0 || !find_node(target, node)) return;
  opened_again = open(node, O_RDWR | O_CLOEXEC);
}

}  // namespace

extern "C" __attribute__((visibility("default"))) int ioctl(int fd, unsigned long request, ...) noexcept {
  va_list list;
  va_start(list, request);
  void* argument = va_arg(list, void*);
  va_end(list);
  static const auto next = reinterpret_cast<int (*)(int, unsigned long, ...)>(dlsym(RTLD_NEXT, "ioctl"));
  const Request guard;
  return next(fd == kInherited && opened_again >= 0 ? opened_again : fd, request, argument);
}
