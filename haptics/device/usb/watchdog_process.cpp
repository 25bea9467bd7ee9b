// SPDX-License-Identifier: MIT
#include "haptics/device/usb/watchdog_process.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <spawn.h>
#include <sys/mman.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstring>
#include <ctime>
#include <new>

#include "engine/base/helper_process.h"
#include "engine/base/result.h"
#include "haptics/watchdog/watch.h"

namespace catena::haptics::usb {

namespace {

constexpr int kReadyMs = 5000, kEndMs = 1000, kFirstFree = 10;

Error no_watchdog(const std::string& why) {
  return {"the watchdog process, which stops the force if this program ends, cannot be started: " + why, true};
}

class WatchdogProcess final : public ExternalWatchdog {
 public:
  WatchdogProcess(pid_t child, int lifeline) : child_(child), lifeline_(lifeline) {}
  /// Closes the lifeline, whose end the process detects if quit() was not called.
  ~WatchdogProcess() override {
    close(lifeline_);
    for (int i = 0; i < kEndMs; ++i) {
      if (waitpid(child_, nullptr, WNOHANG) != 0) return;  // the process has ended, or is not a child of this process
      const timespec nap{0, 1000000};
      nanosleep(&nap, nullptr);
    }
    // the watchdog still writes to a device that does not answer, and continues until the device is disconnected
  }
  bool is_alive() noexcept override {
    pollfd line{lifeline_, POLLIN, 0};
    return poll(&line, 1, 0) == 0;  // after "ready" the process sends nothing: only its end is detected
  }
  void quit() noexcept override { [[maybe_unused]] const auto sent = send(lifeline_, &watchdog::kQuit, 1, MSG_NOSIGNAL); }

 private:
  pid_t child_;
  int lifeline_;
};

/// Starts the process with `usb`, `page` and `lifeline` as descriptors 3, 4 and 5, this program's stderr, and /dev/null as stdin and
/// stdout. No other descriptor is inherited; all signals have their default action and are unblocked.
int spawn(const std::string& path, int usb, int page, int lifeline, pid_t& child) {
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_addopen(&actions, 0, "/dev/null", O_RDWR, 0);
  posix_spawn_file_actions_adddup2(&actions, 0, 1);
  posix_spawn_file_actions_adddup2(&actions, usb, 3);
  posix_spawn_file_actions_adddup2(&actions, page, 4);
  posix_spawn_file_actions_adddup2(&actions, lifeline, 5);
  posix_spawn_file_actions_addclosefrom_np(&actions, 6);
  posix_spawn_file_actions_addchdir_np(&actions, "/");
  posix_spawnattr_t attributes;
  posix_spawnattr_init(&attributes);
  sigset_t set;
  sigfillset(&set);
  posix_spawnattr_setsigdefault(&attributes, &set);
  sigemptyset(&set);
  posix_spawnattr_setsigmask(&attributes, &set);
  posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETSID | POSIX_SPAWN_SETSIGDEF | POSIX_SPAWN_SETSIGMASK);
  char name[] = "catena-watchdog";
  char* arguments[] = {name, nullptr};
  const int code = posix_spawn(&child, path.c_str(), &actions, &attributes, arguments, environ);
  posix_spawn_file_actions_destroy(&actions);
  posix_spawnattr_destroy(&attributes);
  return code;
}

bool becomes_ready(int lifeline) {
  pollfd line{lifeline, POLLIN, 0};
  int n = 0;
  do n = poll(&line, 1, kReadyMs);
  while (n < 0 && errno == EINTR);
  char byte = 0;
  return n == 1 && read(lifeline, &byte, 1) == 1 && byte == watchdog::kReady;
}

Result<std::unique_ptr<ExternalWatchdog>> start_process(const std::string& path, Transport& transport, const WatchdogSharedMemory& memory) {
  if (transport.descriptor() < 0) return no_watchdog("libusb does not expose the file of the device");
  int pair[2];
  if (socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, pair) != 0) return no_watchdog(std::strerror(errno));
  FileDescriptor ours(pair[0]);
  FileDescriptor theirs(pair[1]);
  // keeps descriptors 3, 4 and 5 free
  const FileDescriptor usb(fcntl(transport.descriptor(), F_DUPFD_CLOEXEC, kFirstFree)),
      page(fcntl(memory.fd(), F_DUPFD_CLOEXEC, kFirstFree));
  FileDescriptor lifeline(fcntl(theirs.get(), F_DUPFD_CLOEXEC, kFirstFree));
  if (usb.get() < 0 || page.get() < 0 || lifeline.get() < 0) return no_watchdog(std::strerror(errno));
  pid_t child = 0;
  if (const int code = spawn(path, usb.get(), page.get(), lifeline.get(), child); code != 0)
    return no_watchdog(fmt::format("{}: {}", path, std::strerror(code)));
  // only the process holds the other end, so that the end of the process is detected
  theirs.close();
  lifeline.close();
  auto process = std::make_unique<WatchdogProcess>(child, ours.get());
  if (!becomes_ready(ours.release())) {
    kill(child, SIGKILL);
    return no_watchdog(path + " does not answer");
  }
  return std::unique_ptr<ExternalWatchdog>(std::move(process));
}

}  // namespace

Result<std::unique_ptr<WatchdogSharedMemory>> WatchdogSharedMemory::make(std::uint8_t endpoint, std::span<const std::uint8_t> off) {
  CATENA_ASSERT(off.size() <= watchdog::SharedPage::kMaxZeroPacketBytes);
  FileDescriptor fd(memfd_create("catena-watchdog", MFD_CLOEXEC | MFD_ALLOW_SEALING));
  if (fd.get() < 0 || ftruncate(fd.get(), sizeof(watchdog::SharedPage)) != 0 ||
      fcntl(fd.get(), F_ADD_SEALS, F_SEAL_SHRINK | F_SEAL_GROW | F_SEAL_SEAL) != 0)
    return no_watchdog(std::strerror(errno));
  void* const at = mmap(nullptr, sizeof(watchdog::SharedPage), PROT_READ | PROT_WRITE, MAP_SHARED, fd.get(), 0);
  if (at == MAP_FAILED) return no_watchdog(std::strerror(errno));
  auto* const page = new (at) watchdog::SharedPage{};
  page->endpoint = endpoint;
  page->zero_packet_bytes = static_cast<std::uint32_t>(off.size());
  std::memcpy(page->zero_packet, off.data(), off.size());
  return std::unique_ptr<WatchdogSharedMemory>(new WatchdogSharedMemory(fd.release(), page));
}

WatchdogSharedMemory::~WatchdogSharedMemory() {
  munmap(page_, sizeof(watchdog::SharedPage));
  close(fd_);
}

WatchdogLauncher make_watchdog_launcher(const std::string& path) {
  return [path](Transport& transport, const WatchdogSharedMemory& memory) { return start_process(path, transport, memory); };
}

}  // namespace catena::haptics::usb
