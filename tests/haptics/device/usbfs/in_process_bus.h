// SPDX-License-Identifier: MIT
/// libusb on the emulated Falcon within one process, at microseconds per round trip: this program's ioctl, read and lseek
/// interpose the C library's for one file descriptor; all other calls pass through. The descriptor is the writing end of a pipe of
/// one slot: full = nothing to reap, empty = POLLOUT, the other end closed = POLLERR.
/// For libusb_wrap_sys_device with LIBUSB_OPTION_NO_DEVICE_DISCOVERY: no enumeration, no hotplug. One instance at a time.
#pragma once
#include <memory>

#include "tests/haptics/device/usbfs/emulated_usbfs.h"

namespace catena::haptics::tests {

class InProcessBus final : public EmulatedUsbfs::Node {
 public:
  explicit InProcessBus(const EmulatedFalconOptions& options = {});
  ~InProcessBus() override;

  int fd() const { return fds_[1]; }
  EmulatedPort& port() { return port_; }
  void unplug() { usbfs_->unplug(); }
  template <class F>
  auto with(F&& f) {
    struct Pump {
      EmulatedUsbfs& usbfs;
      ~Pump() { usbfs.pump(); }
    } pump{*usbfs_};
    const std::scoped_lock lock(port_.mutex);
    return f(port_.device);
  }

  /// True while the calling thread is within one of the system calls below: in a kernel, signals would not stop it there.
  static bool in_kernel();
  /// Sets the function that threads call on return from the system calls; nullptr: none.
  static void on_return(void (*hook)());

  // interposed system calls
  int on_ioctl(unsigned long request, void* argument);
  long on_read(void* to, std::size_t size);
  long on_lseek(long offset);

 private:
  void ready(bool something_to_reap) override;
  void gone() override;

  EmulatedPort port_;
  int fds_[2] = {-1, -1};
  bool full_ = false;
  std::vector<std::uint8_t> descriptors_ = EmulatedUsbfs::descriptors();
  std::size_t read_at_ = 0;
  std::unique_ptr<EmulatedUsbfs> usbfs_;
};

}  // namespace catena::haptics::tests
