// SPDX-License-Identifier: MIT
#include "tests/haptics/device/usbfs/in_process_bus.h"

#include <dlfcn.h>
#include <fcntl.h>
#include <sys/types.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <cstdarg>
#include <cstring>

#include "engine/base/result.h"

namespace catena::haptics::tests {
namespace {

std::atomic<InProcessBus*> the_bus{nullptr};
std::atomic<int> the_fd{-1};

thread_local int kernel_depth = 0;
std::atomic<void (*)()> return_hook{nullptr};

/// Marks the calling thread as within the emulated kernel for its lifetime.
struct Kernel {
  Kernel() { ++kernel_depth; }
  ~Kernel() {
    if (--kernel_depth > 0) return;
    if (auto* hook = return_hook.load()) hook();
  }
};

InProcessBus* bus_of(int fd) { return fd >= 0 && fd == the_fd.load(std::memory_order_acquire) ? the_bus.load() : nullptr; }

template <class F>
F next(const char* name) {
  return reinterpret_cast<F>(dlsym(RTLD_NEXT, name));
}

}  // namespace

bool InProcessBus::in_kernel() { return kernel_depth > 0; }
void InProcessBus::on_return(void (*hook)()) { return_hook.store(hook); }

InProcessBus::InProcessBus(const EmulatedFalconOptions& options) : port_(options) {
  const int made = pipe2(fds_, O_CLOEXEC | O_NONBLOCK);
  CATENA_ASSERT(made == 0 && the_bus.load() == nullptr);
  const int size = fcntl(fds_[1], F_SETPIPE_SZ, 4096);
  CATENA_ASSERT(size == 4096);
  usbfs_ = std::make_unique<EmulatedUsbfs>(port_, *this);
  the_bus.store(this);
  the_fd.store(fds_[1], std::memory_order_release);
}

InProcessBus::~InProcessBus() {
  the_fd.store(-1);
  the_bus.store(nullptr);
  usbfs_.reset();
  for (const int fd : fds_)
    if (fd >= 0) close(fd);
}

void InProcessBus::ready(bool something_to_reap) {
  if (fds_[0] < 0 || full_ != something_to_reap) return;
  char byte = 0;
  const long moved = something_to_reap ? ::read(fds_[0], &byte, 1) : ::write(fds_[1], &byte, 1);
  CATENA_ASSERT(moved == 1);
  full_ = !something_to_reap;
}

void InProcessBus::gone() {
  close(fds_[0]);
  fds_[0] = -1;
}

int InProcessBus::on_ioctl(unsigned long request, void* argument) {
  const Kernel kernel;
  int error = 0;
  if (request == USBDEVFS_SUBMITURB) {
    auto* urb = static_cast<usbdevfs_urb*>(argument);
    error = usbfs_->submit({urb, static_cast<std::uint8_t*>(urb->buffer), reinterpret_cast<std::uintptr_t>(urb), nullptr});
  } else if (request == USBDEVFS_REAPURBNDELAY || request == USBDEVFS_REAPURB) {
    EmulatedUsbfs::Urb urb;
    error = usbfs_->reap(urb);
    if (error == 0) *static_cast<usbdevfs_urb**>(argument) = urb.urb;
  } else if (request == USBDEVFS_DISCARDURB) {
    error = usbfs_->discard(reinterpret_cast<std::uintptr_t>(argument));
  } else if (request == USBDEVFS_BULK) {
    auto* transfer = static_cast<usbdevfs_bulktransfer*>(argument);
    std::size_t moved = 0;
    error = usbfs_->bulk(transfer->ep, static_cast<std::uint8_t*>(transfer->data), transfer->len, moved);
    if (error == 0) return static_cast<int>(moved);
  } else {
    error = usbfs_->simple(request, argument);
  }
  if (error == 0) return 0;
  errno = error;
  return -1;
}

long InProcessBus::on_read(void* to, std::size_t size) {
  const std::size_t n = std::min(size, descriptors_.size() - read_at_);
  std::memcpy(to, descriptors_.data() + read_at_, n);
  read_at_ += n;
  return static_cast<long>(n);
}

long InProcessBus::on_lseek(long offset) {
  read_at_ = std::min(static_cast<std::size_t>(offset), descriptors_.size());
  return offset;
}

}  // namespace catena::haptics::tests

// interposed system calls, to which libusb's calls are bound
extern "C" {

__attribute__((visibility("default"))) int ioctl(int fd, unsigned long request, ...) noexcept {
  va_list list;
  va_start(list, request);
  void* argument = va_arg(list, void*);
  va_end(list);
  if (auto* bus = catena::haptics::tests::bus_of(fd)) return bus->on_ioctl(request, argument);
  static const auto original = catena::haptics::tests::next<int (*)(int, unsigned long, ...)>("ioctl");
  return original(fd, request, argument);
}

__attribute__((visibility("default"))) ssize_t read(int fd, void* to, size_t size) {
  if (auto* bus = catena::haptics::tests::bus_of(fd)) return bus->on_read(to, size);
  static const auto original = catena::haptics::tests::next<ssize_t (*)(int, void*, size_t)>("read");
  return original(fd, to, size);
}

__attribute__((visibility("default"))) off_t lseek(int fd, off_t offset, int whence) noexcept {
  if (auto* bus = catena::haptics::tests::bus_of(fd); bus != nullptr && whence == SEEK_SET) return bus->on_lseek(offset);
  static const auto original = catena::haptics::tests::next<off_t (*)(int, off_t, int)>("lseek");
  return original(fd, offset, whence);
}
}
